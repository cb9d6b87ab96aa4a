// XML VTK: a header of XML, then all arrays as "appended raw" bytes.
//
//   <AppendedData encoding="raw">_ array_0 array_1 ... </AppendedData>      each array at its `offset`, counted from behind the underscore
//   array = UInt64 n_blocks, block_size, size of the last block if it is shorter (else 0), compressed size of each block;
//           then the blocks (zlib)
//
// Source: "VTK File Formats" of the VTK manual, section XML; numbers in the byte order of this machine, named in the file.
#include "base/vtk_file.hpp"

#include <zlib.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/series.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

constexpr std::uint64_t block_size = 1 << 18;  // bytes: large enough to compress well, small enough for a reader's cache

const char* byte_order() { return std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian"; }

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw Error(ExitCode::io, file.string() + ": " + what);
}

std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> codes[] = {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}};
  for (const auto& [code, plain] : codes)
    for (std::size_t at = 0; (at = text.find(code, at)) != std::string::npos; at += 1) text.replace(at, std::strlen(code), plain);
  return text;
}

/// The bytes behind the underscore.
class Appended {
 public:
  /// Adds an array; returns its offset.
  template <class T>
  std::uint64_t add(std::span<const T> values) {
    const std::uint64_t offset = bytes_.size(), size = values.size_bytes(), n_blocks = (size + block_size - 1) / block_size;
    std::vector<std::uint64_t> header = {n_blocks, block_size, size % block_size};
    header.resize(3 + n_blocks);
    bytes_.resize(offset + header.size() * sizeof header[0]);
    const auto* source = reinterpret_cast<const Bytef*>(values.data());
    for (std::uint64_t block = 0; block < n_blocks; ++block) {
      const std::uint64_t begin = block * block_size, length = std::min(block_size, size - begin), at = bytes_.size();
      uLongf compressed = compressBound(length);
      bytes_.resize(at + compressed);
      if (compress2(reinterpret_cast<Bytef*>(&bytes_[at]), &compressed, source + begin, length, Z_BEST_SPEED) != Z_OK)
        throw Error(ExitCode::io, "zlib: a block of " + std::to_string(length) + " bytes could not be compressed; is memory exhausted?");
      bytes_.resize(at + compressed);
      header[3 + block] = compressed;
    }
    std::memcpy(&bytes_[offset], header.data(), header.size() * sizeof header[0]);
    return offset;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

const char* type_name(const VtkArray& array) { return array.single ? "Float32" : "Float64"; }

std::string opening(const char* type, bool with_appended) {
  return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"") + type + "\" version=\"1.0\" byte_order=\"" + byte_order() +
         "\" header_type=\"UInt64\"" + (with_appended ? " compressor=\"vtkZLibDataCompressor\">\n" : ">\n");
}

struct Writer {
  std::ostringstream xml;
  Appended appended;

  void element(const std::string& type, const std::string& name, const std::string& shape, std::uint64_t offset) {
    xml << "        <DataArray type=\"" << type << "\" Name=\"" << escaped(name) << "\" " << shape << " format=\"appended\" offset=\""
        << offset << "\"/>\n";
  }
  void array(const VtkArray& array, const std::string& shape) {
    if (array.single) {
      const std::vector<float> values(array.values.begin(), array.values.end());
      element(type_name(array), array.name, shape, appended.add(std::span<const float>(values)));
    } else {
      element(type_name(array), array.name, shape, appended.add(std::span<const double>(array.values)));
    }
  }
  void arrays(const char* group, const std::vector<VtkArray>& list) {
    xml << "      <" << group << ">\n";
    for (const auto& each : list) array(each, "NumberOfComponents=\"" + std::to_string(each.components) + "\"");
    xml << "      </" << group << ">\n";
  }
  void integers(const char* name, std::span<const std::int64_t> values) {
    element("Int64", name, "NumberOfComponents=\"1\"", appended.add(values));
  }
};

/// Sizes that do not fit each other would make a file that readers refuse or, worse, read past its arrays.
void check_piece(const std::filesystem::path& file, VtkKind kind, const VtkPiece& piece) {
  const auto n_points = piece.points.size(), n_cells = piece.offsets.size();
  std::int64_t before = 0;
  for (const auto end : piece.offsets) {
    if (end < before) fail(file, "offset " + std::to_string(end) + " follows " + std::to_string(before) + ", offsets must not fall");
    before = end;
  }
  if (before != static_cast<std::int64_t>(piece.connectivity.size()))
    fail(file,
         "last offset " + std::to_string(before) + ", must equal the length of connectivity " + std::to_string(piece.connectivity.size()));
  for (const auto point : piece.connectivity)
    if (point < 0 || point >= static_cast<std::int64_t>(n_points))
      fail(file, "connectivity names point " + std::to_string(point) + ", there are " + std::to_string(n_points));
  if (kind == VtkKind::unstructured_grid && piece.types.size() != n_cells)
    fail(file, std::to_string(piece.types.size()) + " cell types for " + std::to_string(n_cells) + " cells, one each is needed");
  const auto check = [&](const std::vector<VtkArray>& arrays, std::size_t n, const char* where) {
    for (const auto& array : arrays)
      if (array.components < 1 || array.values.size() != n * array.components)
        fail(file, "array \"" + array.name + "\" holds " + std::to_string(array.values.size()) + " values, " + std::to_string(n) + " " +
                       where + " of " + std::to_string(array.components) + " components need " + std::to_string(n * array.components));
  };
  check(piece.point_arrays, n_points, "points");
  check(piece.cell_arrays, n_cells, "cells");
}

void write_cells(Writer& writer, VtkKind kind, const VtkPiece& piece) {
  const char* group = kind == VtkKind::unstructured_grid ? "Cells"
                      : kind == VtkKind::polygons        ? "Polys"
                      : kind == VtkKind::lines           ? "Lines"
                                                         : "Verts";
  writer.xml << "      <" << group << ">\n";
  writer.integers("connectivity", piece.connectivity);
  writer.integers("offsets", piece.offsets);
  if (kind == VtkKind::unstructured_grid)
    writer.element("UInt8", "types", "NumberOfComponents=\"1\"", writer.appended.add(std::span<const std::uint8_t>(piece.types)));
  writer.xml << "      </" << group << ">\n";
}

std::string piece_opening(VtkKind kind, const VtkPiece& piece) {
  const auto n = std::to_string(piece.offsets.size());
  std::string line = "    <Piece NumberOfPoints=\"" + std::to_string(piece.points.size()) + "\"";
  if (kind == VtkKind::unstructured_grid) return line + " NumberOfCells=\"" + n + "\">\n";
  line += " NumberOfVerts=\"" + (kind == VtkKind::vertices ? n : "0") + "\" NumberOfLines=\"" + (kind == VtkKind::lines ? n : "0");
  return line + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + (kind == VtkKind::polygons ? n : "0") + "\">\n";
}

const char* kind_name(VtkKind kind) { return kind == VtkKind::unstructured_grid ? "UnstructuredGrid" : "PolyData"; }

}  // namespace

VtkArray vtk_array(const std::string& name, std::span<const double> values, bool single) {
  return {name, 1, {values.begin(), values.end()}, single};
}

VtkArray vtk_array(const std::string& name, std::span<const Vec3> values, bool single) {
  VtkArray array{name, 3, {}, single};
  array.values.reserve(3 * values.size());
  for (const Vec3& v : values) array.values.insert(array.values.end(), {v.x, v.y, v.z});
  return array;
}

void write_vtk(const std::filesystem::path& file, VtkKind kind, const VtkPiece& given) {
  if (kind == VtkKind::vertices && given.offsets.empty() && !given.points.empty()) {  // plain points: each its own vertex
    VtkPiece piece = given;
    piece.connectivity.resize(piece.points.size());
    piece.offsets.resize(piece.points.size());
    std::iota(piece.connectivity.begin(), piece.connectivity.end(), 0);
    std::iota(piece.offsets.begin(), piece.offsets.end(), 1);
    return write_vtk(file, kind, piece);
  }
  check_piece(file, kind, given);
  Writer writer;
  writer.xml << opening(kind_name(kind), true) << "  <" << kind_name(kind) << ">\n";
  if (!given.field_arrays.empty()) {
    writer.xml << "    <FieldData>\n";
    for (const auto& array : given.field_arrays)
      writer.array(array, "NumberOfComponents=\"" + std::to_string(array.components) + "\" NumberOfTuples=\"" +
                              std::to_string(array.values.size() / array.components) + "\"");
    writer.xml << "    </FieldData>\n";
  }
  writer.xml << piece_opening(kind, given);
  writer.arrays("PointData", given.point_arrays);
  writer.arrays("CellData", given.cell_arrays);
  writer.xml << "      <Points>\n";
  const auto* coordinates = given.points.empty() ? nullptr : &given.points[0].x;
  writer.element("Float64", "Points", "NumberOfComponents=\"3\"",
                 writer.appended.add(std::span<const double>(coordinates, 3 * given.points.size())));
  writer.xml << "      </Points>\n";
  write_cells(writer, kind, given);
  writer.xml << "    </Piece>\n  </" << kind_name(kind) << ">\n  <AppendedData encoding=\"raw\">\n   _";
  std::string content = std::move(writer.xml).str();
  content += writer.appended.bytes();
  content += "\n  </AppendedData>\n</VTKFile>\n";
  write_atomically(file, content);
}

void write_parallel_vtk(const std::filesystem::path& file, VtkKind kind, const VtkPiece& example,
                        const std::vector<std::string>& piece_files) {
  const std::string type = std::string("P") + kind_name(kind);
  std::ostringstream xml;
  xml << opening(type.c_str(), false) << "  <" << type << " GhostLevel=\"0\">\n";
  const auto arrays = [&](const char* group, const std::vector<VtkArray>& list) {
    xml << "    <" << group << ">\n";
    for (const auto& array : list)
      xml << "      <PDataArray type=\"" << type_name(array) << "\" Name=\"" << escaped(array.name) << "\" NumberOfComponents=\""
          << array.components << "\"/>\n";
    xml << "    </" << group << ">\n";
  };
  arrays("PPointData", example.point_arrays);
  arrays("PCellData", example.cell_arrays);
  xml << "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n";
  for (const auto& piece : piece_files) xml << "    <Piece Source=\"" << escaped(piece) << "\"/>\n";
  xml << "  </" << type << ">\n</VTKFile>\n";
  write_atomically(file, xml.str());
}

VtkCollection::VtkCollection(std::filesystem::path file, bool resume, double from_time) : file_(std::move(file)) {
  if (!resume) return;
  std::ifstream in(file_);  // absent: an output that the first part of the run did not have
  const auto value = [](const std::string& line, const std::string& key) -> std::string {
    const auto at = line.find(key + "=\"");
    if (at == std::string::npos) return "";
    const auto begin = at + key.size() + 2;
    return unescaped(line.substr(begin, line.find('"', begin) - begin));
  };
  for (std::string line; std::getline(in, line);) {
    if (line.find("<DataSet") == std::string::npos) continue;
    const std::string time = value(line, "timestep"), name = value(line, "file");
    double seconds = 0;
    const auto [end, failure] = std::from_chars(time.data(), time.data() + time.size(), seconds);
    if (failure != std::errc() || end != time.data() + time.size() || name.empty())
      fail(file_, "line \"" + line + "\" is not an entry of a series; delete the file to start a new one");
    if (!is_later(seconds, from_time)) entries_.emplace_back(seconds, name);
  }
}

void VtkCollection::add(double time, const std::string& relative_file) {
  std::erase_if(entries_, [time](const auto& entry) { return !is_later(time, entry.first); });
  entries_.emplace_back(time, relative_file);
  std::ostringstream xml;
  xml.precision(17);
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"" << byte_order() << "\">\n  <Collection>\n";
  for (const auto& [seconds, name] : entries_)
    xml << "    <DataSet timestep=\"" << seconds << "\" part=\"0\" file=\"" << escaped(name) << "\"/>\n";
  xml << "  </Collection>\n</VTKFile>\n";
  write_atomically(file_, xml.str());
}

}  // namespace snag
