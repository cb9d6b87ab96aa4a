#pragma once
// A parametric geometry: one file each, registered by name, with its parameters declared once.
#include <string>
#include <utility>
#include <vector>

#include "base/parameter.hpp"
#include "base/registry.hpp"
#include "base/vec3.hpp"

namespace snag::generate {

/// A cell below this makes the mesh of most geometries fail, and be made again with slightly smaller sizes.
inline constexpr double poor_quality = 0.05;

/// What a finished mesh has to fulfil beyond being watertight and of good quality.
struct Expectation {
  struct Volume {
    std::string name;
    int n_components;         // parts that share no face
    double exact_volume = 0;  // m3, of the curved geometry; the mesh falls short of it by its flat faces
  };
  struct Match {
    std::string first, second;
    Vec3 translation;  // m, first -> second: every node of one surface has a partner on the other
  };
  std::vector<Volume> volumes;
  std::vector<std::pair<std::string, std::string>> equal_areas;  // surfaces that have to tile the same area without sharing nodes
  std::vector<Match> periodic;
  double minimum_quality = poor_quality;  // of each cell, see cells.hpp
  std::vector<std::string> remarks;       // what the user should know of how his parameters were met
};

struct Geometry {
  virtual ~Geometry() = default;
  virtual std::string meaning() const = 0;
  /// Read into this object; declared with the defaults of the members.
  virtual std::vector<Parameter> parameters() = 0;
  /// Fill the current, empty model of gmsh: shape, named surfaces and volumes, sizes times `size_factor`.
  /// Throws Error(usage) where parameters contradict each other.
  virtual Expectation build(double size_factor) = 0;
};

/// All geometries of this program.
Registry<Geometry>& geometries();

}  // namespace snag::generate
