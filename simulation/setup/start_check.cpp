#include "simulation/setup/start_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "coupling/kernel.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/particles/tile_particles.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

// Hertz contacts of this depth are far outside their law, and throw the particles apart.
constexpr double largest_overlap_over_radius = 0.5;

std::vector<Vec3> centres_of_particles(const RagSystem& rags, int rag) {
  std::vector<Vec3> centres;
  for (const Tile& tile : rags.tiles())
    if (tile.rag == rag) for_particles(tile, [&](int k, int, int) { centres.push_back(tile.vector(Tile::x, k)); });
  return centres;
}

Error refused(const Rag& rag, const std::string& found, const std::string& rule) {
  return {ExitCode::usage, "start of " + rag.name + ": " + found + ", " + rule};
}

void check_in_water(const RagSystem& rags, const std::vector<int>& which, const Mesh& mesh) {
  const auto shape = kernel_shapes().make("cell", "start of the run");
  Kernel cells(*shape, 1, mesh);
  for (const int r : which) {
    const Rag& rag = rags.rags()[static_cast<std::size_t>(r)];
    cells.locate(centres_of_particles(rags, r));
    if (cells.n_outside() > 0)
      throw refused(rag, std::to_string(cells.n_outside()) + " of " + std::to_string(rag.n_particles) + " particles are outside the mesh",
                    "all must start in the water; correct its place or size, or [mesh] scale");
  }
}

void check_overlap(const Rag& rag, double overlap_over_radius, const char* with) {
  if (overlap_over_radius <= largest_overlap_over_radius) return;
  throw refused(rag, std::string("overlaps ") + with + " by " + number_text(overlap_over_radius) + " of a particle's radius",
                "must not exceed " + number_text(largest_overlap_over_radius) + "; give the pieces other places");
}

void check_contacts(RagSystem& rags, const std::vector<int>& which, double crowding) {
  rags.evaluate_contacts();
  const ContactMeasures& here = rags.contacts()->measures();
  const double between = maximum(rags.comm(), here.max_overlap_over_radius);
  for (const int index : which) {
    const auto r = static_cast<std::size_t>(index);
    const Rag& rag = rags.rags()[r];
    const std::int64_t beyond = sum(rags.comm(), r < here.beyond_walls.size() ? here.beyond_walls[r] : std::int64_t{0});
    if (beyond > 0)
      throw refused(rag, std::to_string(beyond) + " of " + std::to_string(rag.n_particles) + " particles are beyond a wall",
                    "all must start on its fluid side; correct the place of the piece, or the wall's normals");
    check_overlap(rag, maximum(rags.comm(), r < here.max_wall_overlap_over_radius.size() ? here.max_wall_overlap_over_radius[r] : 0.0),
                  "a wall");
  }
  if (between > crowding) check_overlap(rags.rags()[static_cast<std::size_t>(which.front())], between, "itself or another piece");
  rags.contacts()->reset_measures();
}

/// True if every edge of the triangles is one of two of them, in opposite senses.
bool is_closed(const WallBody& body) {
  std::map<std::pair<int, int>, int> sense;  // by edge: triangles that run it forward less those that run it back
  for (const WallTriangle& triangle : body.triangles)
    for (int i = 0; i < 3; ++i) {
      const int from = triangle.node_index[i], to = triangle.node_index[(i + 1) % 3];
      sense[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  return !sense.empty() && std::all_of(sense.begin(), sense.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Times that a closed surface winds about a point: 1 inside of one whose normals point outwards. Source: solid angle of a triangle, Van
/// Oosterom and Strackee (1983), IEEE Trans. Biomed. Eng. 30, 125-126.
double winding(const WallBody& body, const Vec3& x) {
  double angle = 0;
  for (const WallTriangle& triangle : body.triangles) {
    const Vec3 a = triangle.node[0] - x, b = triangle.node[1] - x, c = triangle.node[2] - x;
    const double A = norm(a), B = norm(b), C = norm(c);
    angle += 2 * std::atan2(dot(a, cross(b, c)), A * B * C + dot(a, b) * C + dot(b, c) * A + dot(c, a) * B);
  }
  return angle / (4 * std::numbers::pi);
}

double enclosed_volume(const WallBody& body) {
  double volume = 0;
  for (const WallTriangle& triangle : body.triangles) volume += dot(triangle.node[0], cross(triangle.node[1], triangle.node[2])) / 6;
  return volume;
}

/// Contacts act on one side of a triangle only: a rag on the other side of a closed wall would not feel it.
void check_sides(const Simulation& simulation, const std::vector<int>& which) {
  for (const WallBody& body : simulation.walls.bodies()) {
    if (!is_closed(body)) continue;
    const bool water_inside = enclosed_volume(body) > 0;
    const WallPose pose = wall_pose(body.motion, simulation.time());
    for (const int r : which) {
      const Rag& rag = simulation.rags->rags()[static_cast<std::size_t>(r)];
      on_all_ranks(simulation.rags->comm(), [&] {
        const std::vector<Vec3> centres = centres_of_particles(*simulation.rags, r);
        if (centres.empty()) return;
        const bool is_inside = std::abs(winding(body, pose.in_wall(centres.front()))) > 0.5;
        if (is_inside != water_inside)
          throw refused(rag,
                        std::string("it lies ") + (is_inside ? "inside" : "outside") + " of the closed [[wall]] \"" + body.name +
                            "\", whose normals say that the water is " + (water_inside ? "inside" : "outside"),
                        "must be on the side of the water; correct the place of the piece, or normals_into_fluid of the wall");
      });
    }
  }
}

}  // namespace

void check_waiting(const Simulation& simulation, int rag) {
  const RagPiece& piece = simulation.rags->pieces()[static_cast<std::size_t>(rag)];
  const Rag& properties = simulation.rags->rags()[static_cast<std::size_t>(rag)];
  if (piece.insert_time >= simulation.time_settings.end)
    throw refused(properties, "insert_time is " + number_text(piece.insert_time) + " s",
                  "must be before the end of the run at " + number_text(simulation.time_settings.end) + " s; correct one of them");
  if (!simulation.mesh) return;
  const MPI_Comm comm = simulation.mesh->comm;
  std::vector<Vec3> centres;
  for (int row = 0; row < properties.n_rows && rank_of(comm) == 0; ++row)
    for (int column = 0; column < properties.n_columns; ++column)
      if (piece.exists(column, row)) centres.push_back(piece.pose(column, row).position);
  const auto shape = kernel_shapes().make("cell", "start of the run");
  Kernel cells(*shape, 1, *simulation.mesh);
  cells.locate(centres);
  if (cells.n_outside() == 0) return;
  const std::string found =
      std::to_string(cells.n_outside()) + " of " + std::to_string(properties.n_particles) + " particles are outside the mesh";
  if (simulation.mesh->turning.zone < 0)
    throw refused(properties, found, "all must start in the water; correct its place or size, or [mesh] scale");
  log::warning("start of " + properties.name + ": " + found +
               " at the angle of the rotor at the start; the run stops with an error if this is still true at t = " +
               number_text(piece.insert_time) + " s");
}

double overlap_of_particles(RagSystem& rags) {
  rags.contacts()->reset_measures();
  rags.evaluate_contacts();
  const double overlap = maximum(rags.comm(), rags.contacts()->measures().max_overlap_over_radius);
  rags.contacts()->reset_measures();
  return overlap;
}

void check_start(const Simulation& simulation, const std::vector<int>& which, double crowding) {
  if (which.empty()) return;
  if (simulation.mesh) check_in_water(*simulation.rags, which, *simulation.mesh);
  check_sides(simulation, which);
  check_contacts(*simulation.rags, which, crowding);
}

}  // namespace snag
