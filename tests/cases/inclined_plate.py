# timeout: 900
# cost: 20
"""Requirement: a nearly closed sheet across and oblique to a stream takes the normal force that is measured on a plate, in the measured direction; along the stream it has the friction of the boundary layers on
both sides, whatever kernel and particles.

Plate of the sides c and 2 c at Re = U c/nu = 100, towed in oil: Taira, Dickson, Colonius, Dickinson and Rowley (2007), Unsteadiness in flow over a flat plate at angle-of-attack at low Reynolds numbers, AIAA paper
2007-710; points of its figures of drag and lift as digitised with PetIBM (examples/data, taira_et_al_2007_flatPlateRe100AR2_*.dat), interpolated."""
import math

import graded_box
import harness
import numpy

CHORD, SPEED, DENSITY = 0.1, 1.0, 1000.0  # m, m/s, kg/m3
MEASURED = {15: (0.448, 0.542), 30: (0.639, 0.758), 45: (0.902, 0.726), 60: (1.145, 0.588), 90: (1.527, 0)}  # degrees: drag, lift coefficient

CASE = """
[case]
name = "inclined-plate"
[mesh]
file = "{mesh}"
[time]
end_s = 1.2
step_ms = {step}
[flow]
density_kg_m3 = 1000
dynamic_viscosity_Pa_s = {viscosity:.9g}
initial_velocity_m_s = {stream}
[turbulence]
model = "laminar"
[[boundary]]
patches = ["x0", "y0"]
kind = "velocity_inlet"
velocity_m_s = {stream}
[[boundary]]
patches = ["x1", "y1"]
kind = "pressure_outlet"
[[boundary]]
patches = ["z0", "z1"]
kind = "symmetry"
[output]
report = false
"""
SHEET = """
[[rag]]
length_mm = 100
width_mm = 100
radius_mm = {radius_mm}
centre_m = [0, -0.0025, 0.05]
lengthwise = [0, 0, 1]
crosswise = [1, 0, 0]
mass_per_area_kg_m2 = 1
[[hold]]
columns = [0, {last}]
[coupling]
mode = "two_way"
kernel = "gaussian"
kernel_width_m = {delta}
forces = ["sheet_drag"]
[coupling.sheet_drag]
normal_coefficient = 1000
form = "viscous"
{layers}
"""


class InclinedPlate(harness.CaseTest):
    """Half of the plate, from the plane of symmetry z = 0 on. Its normal is y."""

    size, thickness = 0.0125, 0.005  # of the cells along the plate and across it, m

    def coefficients(self, degrees, delta=None, step=6, Re=100, radius_mm=2, layers=""):
        """Normal and tangential force over the dynamic pressure and the plate's area, of a sheet with the kernel width `delta` (m) or of a rigid plate."""
        along = graded_box.axis(-0.8, 1.3, (-0.075, 0.1), self.size, 1.25)
        across = graded_box.axis(-0.8, 1.0, (-6 * self.thickness, 6 * self.thickness), self.thickness, 1.25)
        span = numpy.unique(graded_box.axis(0, 0.6, (0, 0.125), self.size, 1.25))
        mesh = self.shared / f"{'sheet' if delta else 'plate'}.msh"
        if not mesh.exists():
            graded_box.write(mesh, (along, across, span), None if delta else ((-CHORD / 2, CHORD / 2), (-self.thickness, 0), (-CHORD, CHORD)))
        angle = math.radians(degrees)
        stream = f"[{SPEED * math.cos(angle):.9g}, {SPEED * math.sin(angle):.9g}, 0]"
        text = CASE.format(mesh=mesh, step=step, stream=stream, viscosity=DENSITY * SPEED * CHORD / Re)
        text += SHEET.format(delta=delta, radius_mm=radius_mm, last=round(500 * CHORD / radius_mm) - 1, layers=layers) if delta else graded_box.PLATE
        run = self.run_once(self.case(text, f"{degrees}-{delta}-{step}-{Re}-{radius_mm}-{len(layers)}"), 1)
        monitor, name = (run.monitor("coupling"), "force_on_rags") if delta else (run.monitor("patches"), "plate_force")
        late = monitor.column("time [s]") > 0.9
        normal, tangential = (monitor.column(f"{name}_{axis} [N]")[late].mean() / (0.5 * DENSITY * SPEED**2 * CHORD**2) for axis in "yx")
        return normal, tangential

    def compare(self, degrees, delta, bound, step=6):
        """With the measurement: the normal force, and the angle between force and normal in degrees."""
        angle = math.radians(degrees)
        drag, lift = MEASURED[degrees]
        normal, tangential = lift * math.cos(angle) + drag * math.sin(angle), drag * math.cos(angle) - lift * math.sin(angle)
        found_normal, found_tangential = self.coefficients(degrees, delta, step)
        off = math.degrees(math.atan2(found_tangential, found_normal) - math.atan2(tangential, normal))
        what = f"{degrees} degrees, {f'kernel {1e3 * delta:g} mm' if delta else 'rigid plate'}"
        print(f"  {what}: normal force {found_normal:.3f}, measured {normal:.3f} ({100 * (found_normal / normal - 1):+.1f} %), direction {off:+.1f} degrees", flush=True)
        with self.subTest(what):
            self.assertLess(abs(found_normal / normal - 1), bound)
            self.assertLess(abs(off), 4)
        return found_normal

    def along(self, Re, delta, bound, turbulent=False, **keys):
        """Friction of both sides: Blasius (1908) with the term of the trailing edge, Messiter (1970); or 0.074 Re^(-1/5), Prandtl."""
        law = 2 * (0.074 * Re**-0.2 if turbulent else 1.328 * Re**-0.5 + 2.67 * Re**-0.875)
        friction = self.coefficients(0, delta, Re=Re, layers="transition_reynolds = 0" if turbulent else "", **keys)[1]
        what = f"along the stream, Re {Re:g}, kernel {1e3 * delta:g} mm{', turbulent' if turbulent else ''} {keys}"
        print(f"  {what}: friction {friction:.4f}, law {law:.4f} ({100 * (friction / law - 1):+.1f} %)", flush=True)
        with self.subTest(what):
            self.assertLess(abs(friction / law - 1), bound)
        return friction


class InclinedPlateShort(InclinedPlate):
    def test_oblique(self):
        self.compare(30, 0.012, 0.15, step=12)

    def test_along(self):
        self.along(1e3, 0.012, 0.10, step=24)


if __name__ == "__main__":
    harness.main()
