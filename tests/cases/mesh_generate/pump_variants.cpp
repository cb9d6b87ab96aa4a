// labels: long
// timeout: 3600
// Far corners of the parameter space, one at a time: each has to give a sound mesh.
#include <gtest/gtest.h>

#include "tests/cases/mesh_generate/reader/program.hpp"

using namespace mesh_generate;

namespace {
struct PumpVariant : testing::TestWithParam<const char*> {};
}  // namespace

// A pump with a dimension far from its default passes all checks of the generator.
TEST_P(PumpVariant, IsSound) {
  const auto made = snag_mesh("pump --out variant.msh --set " + std::string(GetParam()));
  EXPECT_EQ(made.code, 0) << made.output;
}

INSTANTIATE_TEST_SUITE_P(Pump, PumpVariant,
                         testing::Values("'impeller_diameter=170 mm'", "'impeller_diameter=240 mm'", "'wrap_angle=270 deg'",
                                         "'wrap_angle=400 deg'", "tongue_gap=0.06 'trailing_edge_thickness=6 mm'", "tongue_gap=0.2",
                                         "'tongue_radius=1.5 mm'", "'tongue_radius=8 mm'", "'tongue_angle=15 deg'", "'tongue_angle=45 deg'",
                                         "'side_gap=0 mm'", "'trailing_edge_thickness=2 mm' 'leading_edge_thickness=2 mm'",
                                         "'trailing_edge_thickness=12 mm'", "'rotor_angle=-58 deg'", "'rotor_angle=180 deg'",
                                         "'eye_length=1 mm'", "volute_factor=0.6", "volute_factor=1", "'impeller_width=40 mm'",
                                         "'outlet_diameter=100 mm'", "'inlet_diameter=80 mm'", "inlet=tank 'bell_radius=0 mm'",
                                         "inlet=tank 'inlet_length=24 mm' 'bell_radius=5 mm' 'cover_thickness=10 mm'"));
