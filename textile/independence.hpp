#pragma once
// What ought not to matter: particle radius, time step, dashpots and friction of the bonds (Jensen 2018, Appendix 1).
//
// Bonds at another radius R' are those of its own elongation and bending tests; the tangential stiffness keeps the shear of the cloth,
//   S_t' R'^2 = S_t R^2.
#include "textile/calibration.hpp"

namespace snag {

/// Elongation and bending at one particle radius.
struct RadiusPoint {
  double radius = 0;  // m
  std::array<BondProperties, 2> bond{};
  std::array<GrabTest, 2> grab;
  std::array<StripShape, 2> strip;
  std::array<double, 2> height{};  // of the tip above the plane, m
};

/// The tests lengthwise at one time step, both by the motion of the particles.
struct StepPoint {
  double share = 0;  // of the stable step
  GrabTest grab;
  StripShape strip;
};

/// The drape by the motion of the cloth from one laying.
struct DampingPoint {
  double bond_damping = 0, rotation_friction = 0;
  Outline outline;
};

inline constexpr double drape_duration = 2.5;  // s, as published

struct Independence {
  std::vector<RadiusPoint> radii;                 // 1/3, 2/3, 1, 4/3, 5/3 of the calibrated one
  std::vector<StepPoint> steps;                   // rising
  std::vector<DampingPoint> dampings, frictions;  // one of the two varied

  double strain_spread(
      int direction) const;  // of the strains at the largest force over the radii: largest over smallest - 1, to the 0.25 % of a look
  double force_spread(int direction) const;  // of the largest forces
  double tip_spread() const;                 // greatest distance between two tips over the steps, over that from the edge
};

/// Radii and steps only, without drapes: a second at 6 mm.
Independence independence_of_size_and_step(const TextileTests& tests, const Calibration& calibration);

/// Some minutes at 1.5 mm, most of it for the drapes, which are shared out over the ranks. Collective. Throws Error(usage, diverged).
Independence independence(MPI_Comm comm, const TextileTests& tests, const Calibration& calibration);

}  // namespace snag
