// XML VTK (base/vtk_file.hpp): NAME.pvd over NAME_NNNNNN.pvtu with one .vtu a rank, or over NAME_NNNNNN.vtp.
// Source: VTK file formats, https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
#include "base/words.hpp"
#include "parallel/session.hpp"
#include "simulation/writers/field_writer.hpp"

namespace snag {
namespace {

class PiecesSeries final : public FieldSeries {
 public:
  PiecesSeries(const SeriesPlace& place, MPI_Comm comm)
      : place_(place), comm_(comm), collection_(place.folder / (place.name + ".pvd"), place.resume, place.from_time) {}

  void add(double time, std::int64_t time_step, const VtkPiece& piece) override {
    const int rank = rank_of(comm_), size = size_of(comm_);
    const std::string stem = numbered(place_.name, time_step);
    std::vector<std::string> pieces;
    for (int r = 0; r < size; ++r) pieces.push_back(stem + "_" + std::to_string(r) + ".vtu");
    on_all_ranks(comm_, [&] {
      write_vtk(place_.folder / pieces[static_cast<std::size_t>(rank)], place_.kind, piece);
      if (rank != 0) return;
      write_parallel_vtk(place_.folder / (stem + ".pvtu"), place_.kind, piece, pieces);
      collection_.add(time, stem + ".pvtu");
    });
  }

 private:
  SeriesPlace place_;
  MPI_Comm comm_;
  VtkCollection collection_;
};

class FilesSeries final : public FieldSeries {
 public:
  explicit FilesSeries(const SeriesPlace& place)
      : place_(place), collection_(place.folder / (place.name + ".pvd"), place.resume, place.from_time) {}

  void add(double time, std::int64_t time_step, const VtkPiece& piece) override {
    const std::string file = numbered(place_.name, time_step) + ".vtp";
    write_vtk(place_.folder / file, place_.kind, piece);
    collection_.add(time, file);
  }

 private:
  SeriesPlace place_;
  VtkCollection collection_;
};

struct Vtk final : FieldWriter {
  static constexpr const char* name = "vtk";

  std::string meaning() const override { return "XML VTK for ParaView, which `snag report` and `snag observe` read, too."; }
  std::unique_ptr<FieldSeries> series_of_pieces(const SeriesPlace& place, MPI_Comm comm) const override {
    return std::make_unique<PiecesSeries>(place, comm);
  }
  std::unique_ptr<FieldSeries> series(const SeriesPlace& place) const override { return std::make_unique<FilesSeries>(place); }
  void write(const std::filesystem::path& folder, const std::string& stem, VtkKind kind, const VtkPiece& piece) const override {
    write_vtk(folder / (stem + ".vtp"), kind, piece);
  }
};
const bool registered = field_writers().add<Vtk>();

}  // namespace
}  // namespace snag
