#include "simulation/output/rag_output.hpp"

#include "base/words.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

std::vector<VtkArray> point_arrays(const RagSheet& sheet, const std::vector<Rag>& rags) {
  std::vector<double> radius;
  for (const int index : sheet.rag) radius.push_back(rags[index].radius);
  const std::vector<double> id(sheet.id.begin(), sheet.id.end()), rag(sheet.rag.begin(), sheet.rag.end());
  return {vtk_array("id [1]", id),
          vtk_array("rag [1]", rag),
          vtk_array("velocity [m/s]", sheet.velocity),
          vtk_array("tension [N]", sheet.tension),
          vtk_array("strain [1]", sheet.strain),
          vtk_array("radius [m]", radius),
          vtk_array("fluid_force [N]", sheet.more[0]),
          vtk_array("contact_force [N]", sheet.more[1])};
}

}  // namespace

RagOutput::RagOutput(std::filesystem::path folder, bool resume, double from_time)
    : folder_(std::move(folder)),
      sheets_(folder_ / "rags.pvd", resume, from_time),
      particles_(folder_ / "particles.pvd", resume, from_time) {}

void RagOutput::write(const RagSystem& rags, const RagForces& forces, std::int64_t time_step, double time) {
  const RagSheet sheet = gather_sheet(rags, {&forces.fluid, &forces.contact});
  together(rags.comm(), [&] {
    if (rank_of(rags.comm()) != 0) return;
    VtkPiece piece;
    piece.points = sheet.position;
    piece.point_arrays = point_arrays(sheet, rags.rags());
    piece.field_arrays = {{"TimeValue", 1, {time}, false}};
    VtkPiece dots = piece;
    for (const auto& triangle : sheet.triangles) {
      piece.connectivity.insert(piece.connectivity.end(), triangle.begin(), triangle.end());
      piece.offsets.push_back(static_cast<std::int64_t>(piece.connectivity.size()));
    }
    for (std::size_t i = 0; i < sheet.position.size(); ++i) {
      dots.connectivity.push_back(static_cast<std::int64_t>(i));
      dots.offsets.push_back(static_cast<std::int64_t>(i) + 1);
    }
    const std::string rags_file = numbered("rags", time_step) + ".vtp", particles_file = numbered("particles", time_step) + ".vtp";
    write_vtk(folder_ / rags_file, VtkKind::polygons, piece);
    write_vtk(folder_ / particles_file, VtkKind::vertices, dots);
    sheets_.add(time, rags_file);
    particles_.add(time, particles_file);

    silhouettes_.clear();
    for (std::size_t rag = 0; rag < rags.rags().size(); ++rag) {
      std::vector<std::array<int, 3>> own;
      for (const auto& triangle : sheet.triangles) {
        if (sheet.rag[triangle[0]] == static_cast<int>(rag)) own.push_back(triangle);
      }
      silhouettes_.push_back(silhouette(sheet.position, own, {}, 0.5 * rags.rags()[rag].radius));
    }
  });
}

/// [rag][5]
std::vector<double> RagOutput::state() const {
  std::vector<double> state;
  for (const Silhouette& s : silhouettes_) state.insert(state.end(), {s.area, s.x, s.y, s.elongation_ratio, s.orientation});
  return state;
}

void RagOutput::restore(const std::vector<double>& state) {
  silhouettes_.clear();
  for (std::size_t i = 0; i + 4 < state.size(); i += 5)
    silhouettes_.push_back({state[i], state[i + 1], state[i + 2], state[i + 3], state[i + 4]});
}

}  // namespace snag
