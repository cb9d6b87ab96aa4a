#pragma once
// Pieces of cloth as a case file gives them: [[rag]], [[disc]], [[fibre]], [[particle]], and [dem].
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/case_file.hpp"
#include "base/parameter.hpp"
#include "dem/bonds/bond_law.hpp"
#include "dem/templates/lattice.hpp"
#include "dem/templates/pose_plan.hpp"
#include "dem/templates/rag_copies.hpp"

namespace snag {

/// Calibrated bonds of the thesis's wet non-woven cloth, Jensen (2018) Tables 3.3 and 3.4, at radius r_p: as printed at 1.0, 1.5 and 2.0
/// mm, between them interpolated linearly in the logarithms (S_n goes as r^-2). Shear strength 0: none is published. `direction`: 0
/// lengthwise, 1 crosswise. Throws Error(usage) outside 1.0 .. 2.0 mm, where the properties must be given.
BondProperties published_bond(double radius, int direction);

/// [[rag.cut]], [[disc.cut]].
struct CutSettings {
  std::vector<double> from, to;  // m
  Section section();
};

struct RagSettings {
  enum class Shape { rag, disc, fibre, particle };
  explicit RagSettings(Shape piece_shape = Shape::rag);

  Shape shape;
  std::string name;

  // lattice
  double length = 0.300, width = 0.220;  // m; of a disc: diameter in `diameter`
  double diameter = 0;                   // of a disc, a fibre (hydrodynamic) or a particle, m
  double radius = 1e-3;                  // r_p, m
  int n_points = 0;                      // fibre: particles; 0: from length and radius
  std::vector<CutSettings> cuts;         // of a rag or a disc
  // mass
  double thickness = 0.77e-3;                                // m
  std::optional<double> contact_thickness, layer_thickness;  // m; none: 2 r_p
  std::optional<double> wall_friction, cloth_friction;       // none: those of [contact]
  double mass_per_area = 0.785;                              // kg/m2
  double density = 1380;                                     // fibre, particle; kg/m3
  enum class DensityModel { mass_per_area, jensen_2018 };    // the latter: spheres of 538 (1 mm/r_p) kg/m3
  Choice<DensityModel> density_model{DensityModel::mass_per_area, {"mass_per_area", "jensen_2018"}};
  // pose
  Vec3 position, velocity, spin;  // centre, m; m/s; rad/s
  Vec3 lengthwise{1, 0, 0}, crosswise{0, 1, 0};
  PosePlan plan;
  std::string pose_file;
  double insert_time = 0;            // s
  bool match_flow_velocity = false;  // the water's mean velocity is added to `velocity`
  RagCopies copies;
  // bonds
  std::string bond_law = default_bond_law;
  std::shared_ptr<const BondLaw> law;  // with its own parameters; none: `bond_law` with their defaults
  std::string passport;                // file of a calibration; "": as `properties` says
  enum class Properties { published, custom, beam };
  Choice<Properties> properties{Properties::published, {"published", "custom", "beam"}};
  double youngs_modulus = 1e9;   // beam, Pa
  BondProperties along, across;  // custom
  double bond_damping = 0.5, rotation_friction = 0.001, contact_radius_ratio = 2.2;
  bool breakage = false;
  std::optional<double> shear_modulus;  // Pa, of contacts
  double poisson_ratio = 0.25;

  bool has_published_density() const { return density_model == DensityModel::jensen_2018; }
  /// Name of the table and its records, which refer to this object.
  Section section();
};

/// Of one table: beyond it the counts of a lattice no longer fit, nor does its memory.
double most_particles();

/// The piece that settings describe. `where` stands in messages ("case.toml: [[rag]] 1"), `folder` is that of the case file, for the pose
/// file. A pose that takes a run of its own is still to be made (make_poses, dem/poses/crumpled.hpp). Throws Error(usage, io).
RagPiece make_piece(const RagSettings& settings, const std::string& where, const std::filesystem::path& folder = {});

/// All pieces of a case: [[rag]], then [[disc]], [[fibre]], [[particle]], each in order of the file with its copies. Throws Error(usage,
/// io).
std::vector<RagPiece> read_pieces(const CaseFile& file);

struct DemSettings {
  std::optional<double> step;  // s
  double safety = 0.8;         // of the stable step
  Section section();
};

}  // namespace snag
