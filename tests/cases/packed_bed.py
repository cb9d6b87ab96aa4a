# cost: 10
"""Requirement: water that the flow solver drives through a bed of held spheres loses the pressure of Ergun's equation, with the velocity of the whole area."""
import graded_box
import harness
import numpy

SPACING, DIAMETER, LAYERS, ROWS = 0.0025, 0.002, 16, 4  # m; the bed fills the whole channel
LENGTH, SIDE = LAYERS * SPACING, ROWS * SPACING
DENSITY, VISCOSITY = 1000.0, 0.01  # kg/m3, Pa s
SOLID_FRACTION = numpy.pi / 6 * (DIAMETER / SPACING) ** 3

CASE = """
[mesh]
file = "{mesh}"
[time]
end_s = 0.1
step_s = 0.005
[flow]
initial_velocity_m_s = [{speed}, 0, 0]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = 0.01
[turbulence]
model = "laminar"
[contact]
mutual_contact = false
[coupling]
mode = "two_way"
kernel_width_mm = 3
forces = ["{law}"]
[output]
report = false
[[hold]]
particles = [0]
"""
ROW = """
[[particle]]
diameter_m = {diameter}
density_kg_m3 = 1000
position_m = [{x}, {y}, {z}]
copies = {n}
copy_step_m = [{spacing}, 0, 0]
"""


def ergun(speed):
    """Pressure drop of the bed, Pa."""
    void = 1 - SOLID_FRACTION
    return LENGTH * SOLID_FRACTION / void**3 * (150 * VISCOSITY * SOLID_FRACTION * speed / DIAMETER**2 + 1.75 * DENSITY * speed**2 / DIAMETER)


class PackedBed(harness.CaseTest):
    def pressure_drop(self, law, speed):
        mesh = self.shared / "bed.msh"
        if not mesh.exists():
            across = numpy.linspace(0, SIDE, 6)
            graded_box.write(mesh, (numpy.linspace(0, LENGTH, 21), across, across))
        text = CASE.format(mesh=mesh, speed=speed, law=law) + graded_box.free_stream(speed)
        places = [(i + 0.5) * SPACING for i in range(ROWS)]
        text += "".join(ROW.format(diameter=DIAMETER, spacing=SPACING, x=SPACING / 2, y=y, z=z, n=LAYERS) for y in places for z in places)
        patches = self.run_case(self.case(text, f"{law}_{speed}"), 1, out=f"{law}_{speed}").monitor("patches")
        return patches.column("x0_pressure")[-1] - patches.column("x1_pressure")[-1]

    def test_the_pressure_drop_is_that_of_ergun(self):
        """In slow flow and where half of the drop is that of inertia."""
        for law, speed, tolerance in (("ergun_wen_yu", 0.001, 0.01), ("ergun_wen_yu", 0.1, 0.01), ("gidaspow", 0.1, 0.02)):
            found, exact = self.pressure_drop(law, speed), ergun(speed)
            print(f"  {law}, {speed} m/s: {found:.4g} Pa, Ergun {exact:.4g} Pa")
            self.assertLess(abs(found / exact - 1), tolerance)


if __name__ == "__main__":
    harness.main()
