"""Case files of a few seconds that several tests run."""
import re

# Bonds of a cloth whose particles may have any radius.
STIFFNESS = """properties = "custom"
normal_stiffness_lengthwise_N_m3 = 1.22e8
normal_stiffness_crosswise_N_m3 = 6.78e7
bending_stiffness_lengthwise_N_m3 = 1.55e6
bending_stiffness_crosswise_N_m3 = 1.40e5
tangential_stiffness_lengthwise_N_m3 = 2.92e5
tangential_stiffness_crosswise_N_m3 = 2.92e5
"""
# Two sheets of several tiles each: the lower one strikes the ground on its edge and buckles, the upper one falls on it.
TWO_SHEETS = """
[case]
name = "two-sheets"
[time]
end_s = 0.02
step_s = 4e-4
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[dem]
step_s = 8e-6
[[wall]]
kind = "plane"
point_m = [0, 0, 0]
normal = [0, 0, 1]
[[rag]]
length_mm = 120
width_mm = 80
radius_mm = 1
centre_m = [0, 0, 0.0535]
lengthwise = [0.5, 0, 0.8]
velocity_m_s = [0, 0, -2]
[[rag]]
length_mm = 80
width_mm = 80
radius_mm = 1
centre_m = [-0.008, 0.01, 0.055]
lengthwise = [0.5, 0.1, 0.8]
velocity_m_s = [2, 0, -3]
[output]
report = false
"""
# The same with smaller sheets in free fall: 20 steps of a few milliseconds each.
SMALL_SHEETS = re.sub(r"_mm = (120|80)\n", "_mm = 20\n", TWO_SHEETS).replace("end_s = 0.02", "end_s = 0.008")

# Patches of `snag mesh channel` but for its inlet.
CHANNEL_OUTLET_AND_WALLS = """
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = ["bottom", "top", "side_z0", "side_z1"]
kind = "wall"
"""

# A small rag across a slow channel of thick water, held back by its walls; {mesh} and {kernel} are filled in.
CHANNEL = """
[case]
name = "coupled-channel"
[mesh]
file = "{mesh}"
[time]
end_s = 0.05
step_s = 1e-3
[flow]
density_kg_m3 = 998.2
dynamic_viscosity_Pa_s = 0.05
initial_velocity_m_s = [0.5, 0, 0]
pressure_tolerance = 1e-11
pressure_tolerance_intermediate = 1e-11
momentum_tolerance = 1e-11
[[boundary]]
patch = "inlet"
kind = "velocity_inlet"
velocity_m_s = [0.5, 0, 0]
""" + CHANNEL_OUTLET_AND_WALLS + """
[[wall]]
kind = "patches"
patches = ["bottom", "top", "side_z0", "side_z1"]
[[rag]]
length_mm = 60
width_mm = 40
radius_mm = 2
centre_m = [0.08, 0.05, 0.05]
lengthwise = [0.3, 0.2, 0.9]
[coupling]
mode = "two_way"
kernel = "{kernel}"
kernel_width_mm = 8
forces = ["free_stream_drag"]
[output]
report = false
single_precision = false
"""
CHANNEL_MESH = ("channel", "length_mm=300", "height_mm=100", "width_mm=100", 'cells="tetrahedra"', "size_mm=16", "wall_ratio=1")
COARSE_CHANNEL_MESH = tuple(setting.replace("size_mm=16", "size_mm=25") for setting in CHANNEL_MESH)

# Water in a pump: flow rate at the inlet, pressure at the outlet. What differs between the cases that use it is filled in.
PUMP = """
[case]
name = "{name}"
[mesh]
file = "{mesh}"
[rotating_zone]
zone = "rotor"
{rotor}
[time]
{time}
[flow]
{flow}
[pump]
{pump}
[[boundary]]
patch = "inlet"
kind = "flow_rate_inlet"
flow_rate_L_s = {flow_rate_L_s}
[[boundary]]
patch = "outlet"
kind = "pressure_outlet"
[[boundary]]
patches = {walls}
kind = "wall"
{more}
[output]
report = false
{output}
"""
FLANGES = "inlet_diameter_mm = 100\noutlet_diameter_mm = 80"  # of cases/meshes/pump_coarse.msh
K_EPSILON = '[turbulence]\nmodel = "k_epsilon"\n'
CASING = '["impeller_walls", "casing_walls"]'


def tight_flow(tolerance):
    """Keys of [flow] for water that is solved to this tolerance."""
    return f"pressure_tolerance = {tolerance}\npressure_tolerance_intermediate = {tolerance}\nmomentum_tolerance = {tolerance}"


def pump_case(name, mesh, *, rotor, time, flow="", pump="", flow_rate_L_s=26.8, walls=CASING, more=K_EPSILON, output=""):
    """Text of a case; `more`: whole tables, `output`: further keys of [output], then whole tables."""
    return PUMP.format(name=name, mesh=mesh, rotor=rotor, time=time, flow=flow, pump=pump, flow_rate_L_s=flow_rate_L_s, walls=walls, more=more,
                       output=output)
