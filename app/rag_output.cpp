#include "app/rag_output.hpp"

#include "parallel/session.hpp"

namespace snag {

namespace {

VtkArray scalars(const std::string& name, const std::vector<double>& values) { return {name, 1, values, true}; }

VtkArray vectors(const std::string& name, const std::vector<Vec3>& values) {
  VtkArray array{name, 3, {}, true};
  array.values.reserve(3 * values.size());
  for (const Vec3& v : values) array.values.insert(array.values.end(), {v.x, v.y, v.z});
  return array;
}

std::vector<VtkArray> point_arrays(const RagSheet& sheet, const std::vector<Rag>& rags) {
  std::vector<double> radius;
  for (const int rag : sheet.rag) radius.push_back(rags[rag].radius);
  return {scalars("id [1]", {sheet.id.begin(), sheet.id.end()}),
          scalars("rag [1]", {sheet.rag.begin(), sheet.rag.end()}),
          vectors("velocity [m/s]", sheet.velocity),
          scalars("tension [N]", sheet.tension),
          scalars("strain [1]", sheet.strain),
          scalars("radius [m]", radius)};
}

std::string numbered(const std::string& stem, std::int64_t number) {
  const std::string digits = std::to_string(number);
  return stem + "_" + std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".vtp";
}

}  // namespace

RagOutput::RagOutput(std::filesystem::path folder, bool resume, double from_time)
    : folder_(std::move(folder)),
      sheets_(folder_ / "rags.pvd", resume, from_time),
      particles_(folder_ / "particles.pvd", resume, from_time) {}

void RagOutput::write(const RagSystem& rags, std::int64_t time_step, double time) {
  const RagSheet sheet = gather_sheet(rags);
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
    write_vtk(folder_ / numbered("rags", time_step), VtkKind::polygons, piece);
    write_vtk(folder_ / numbered("particles", time_step), VtkKind::vertices, dots);
    sheets_.add(time, numbered("rags", time_step));
    particles_.add(time, numbered("particles", time_step));

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

}  // namespace snag
