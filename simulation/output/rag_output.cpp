#include "simulation/output/rag_output.hpp"

#include "parallel/session.hpp"
#include "simulation/output/outline_moments.hpp"

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

RagOutput::RagOutput(const FieldWriter& writer, SeriesPlace place, const View& view) : view_(view) {
  place.name = "rags", place.kind = VtkKind::polygons;
  sheets_ = writer.series(place);
  place.name = "particles", place.kind = VtkKind::vertices;
  particles_ = writer.series(place);
}

void RagOutput::write(const RagSystem& rags, const RagForces& forces, std::int64_t time_step, double time) {
  const RagSheet sheet = gather_sheet(rags, {&forces.fluid, &forces.contact});
  on_all_ranks(rags.comm(), [&] {
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
    sheets_->add(time, time_step, piece);
    particles_->add(time, time_step, dots);

    silhouettes_ = outlines_of_pieces(sheet, rags.rags(), view_);
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
