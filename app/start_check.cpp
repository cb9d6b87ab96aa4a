#include "app/start_check.hpp"

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/words.hpp"
#include "coupling/kernel.hpp"
#include "dem/contacts/contact_solver.hpp"
#include "dem/tile_particles.hpp"
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
  throw refused(rag, std::string("overlaps ") + with + " by " + words(overlap_over_radius) + " of a particle's radius",
                "must not exceed " + words(largest_overlap_over_radius) + "; give the pieces other places");
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

}  // namespace

void check_waiting(const Simulation& simulation, int rag) {
  const RagPiece& piece = simulation.rags->pieces()[static_cast<std::size_t>(rag)];
  const Rag& properties = simulation.rags->rags()[static_cast<std::size_t>(rag)];
  if (piece.insert_time >= simulation.time_settings.end)
    throw refused(properties, "insert_time is " + words(piece.insert_time) + " s",
                  "must be before the end of the run at " + words(simulation.time_settings.end) + " s; correct one of them");
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
  log::warning("start of " + properties.name + ": " + found + " as it stands at the start; it is refused if that is so at " +
               words(piece.insert_time) + " s");
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
  check_contacts(*simulation.rags, which, crowding);
}

}  // namespace snag
