#include "base/vtk_reader.hpp"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/words.hpp"

namespace snag {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw Error(ExitCode::io, file.string() + ": " + what);
}

std::string content_of(const std::filesystem::path& file) {
  const auto text = file_text(file);
  if (!text) fail(file, "cannot be read; is it there, and of a finished run?");
  return *text;
}

/// Value of key="..." in an element; empty if there is none.
std::string attribute(std::string_view element, const std::string& key) {
  const auto at = element.find(" " + key + "=\"");
  if (at == std::string_view::npos) return "";
  const auto begin = at + key.size() + 3;
  return std::string(element.substr(begin, element.find('"', begin) - begin));
}

template <class Number>
Number number(const std::string& text, const std::filesystem::path& file) {
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) fail(file, "\"" + shortened(text) + "\" is not a number");
  return value;
}

/// The elements <NAME ...> of a part of the header.
std::vector<std::string_view> elements(std::string_view part, const std::string& name) {
  std::vector<std::string_view> found;
  for (std::size_t at = 0; (at = part.find("<" + name + " ", at)) != std::string_view::npos;) {
    const auto end = part.find('>', at);
    if (end == std::string_view::npos) break;
    found.push_back(part.substr(at, end - at));
    at = end;
  }
  return found;
}

constexpr std::uint64_t largest_ratio = 1032;  // of sizes before and after compression, https://www.zlib.net/zlib_tech.html

class Reader {
 public:
  explicit Reader(std::filesystem::path file) : file_(std::move(file)), content_(content_of(file_)) {
    const std::string mark = "<AppendedData encoding=\"raw\">";
    const auto at = content_.find(mark), underscore = content_.find('_', at == std::string::npos ? 0 : at + mark.size());
    if (at == std::string::npos || underscore == std::string::npos || content_.find("vtkZLibDataCompressor") > at)
      fail(file_, "is not a file with appended, compressed arrays as Snag writes it");
    header_ = std::string_view(content_).substr(0, at);
    bytes_ = std::string_view(content_).substr(underscore + 1);
  }

  std::string_view part(const std::string& name) const {
    const auto begin = header_.find("<" + name + ">"), end = header_.find("</" + name + ">");
    if (begin == std::string_view::npos || end == std::string_view::npos) fail(file_, "has no <" + name + ">");
    return header_.substr(begin, end - begin);
  }

  VtkArray array(std::string_view element) const {
    VtkArray array;
    array.name = attribute(element, "Name");
    array.components = number<int>(attribute(element, "NumberOfComponents"), file_);
    const std::string type = attribute(element, "type");
    const std::string raw = inflated(number<std::uint64_t>(attribute(element, "offset"), file_));
    array.single = type == "Float32";
    if (type == "Float32")
      append<float>(raw, array.values);
    else if (type == "Float64")
      append<double>(raw, array.values);
    else if (type == "Int64")
      append<std::int64_t>(raw, array.values);
    else
      fail(file_, "array \"" + shortened(array.name) + "\" is of type \"" + shortened(type) + "\", which Snag does not write");
    return array;
  }

  std::vector<VtkArray> arrays(const std::string& name) const {
    std::vector<VtkArray> all;
    for (const std::string_view element : elements(part(name), "DataArray")) all.push_back(array(element));
    return all;
  }

 private:
  template <class Number>
  static void append(const std::string& raw, std::vector<double>& values) {
    const std::size_t n = raw.size() / sizeof(Number);
    values.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      Number value;
      std::memcpy(&value, raw.data() + i * sizeof(Number), sizeof value);
      values[i] = static_cast<double>(value);
    }
  }

  std::uint64_t word(std::uint64_t at) const {
    if (at > bytes_.size() || bytes_.size() - at < sizeof(std::uint64_t))
      fail(file_, "ends within an array; was the run cut while it wrote?");
    std::uint64_t value;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }

  std::string inflated(std::uint64_t offset) const {
    const std::uint64_t n_blocks = word(offset), size = word(offset + 8), last = word(offset + 16);
    if (n_blocks > bytes_.size() / 8) fail(file_, "an array of " + std::to_string(n_blocks) + " blocks does not fit into the file");
    std::string raw;
    std::uint64_t at = offset + 8 * (3 + n_blocks);
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      const std::uint64_t compressed = word(offset + 8 * (3 + b));
      uLongf length = b + 1 == n_blocks && last > 0 ? last : size;
      const auto begin = raw.size();
      const bool fits = at <= bytes_.size() && compressed <= bytes_.size() - at && length / largest_ratio <= compressed;
      if (fits) raw.resize(begin + length);
      if (!fits || uncompress(reinterpret_cast<Bytef*>(&raw[begin]), &length, reinterpret_cast<const Bytef*>(bytes_.data() + at),
                              compressed) != Z_OK)
        fail(file_, "block " + std::to_string(b) + " of an array cannot be unpacked");
      at += compressed;
    }
    return raw;
  }

  std::filesystem::path file_;
  std::string content_;
  std::string_view header_, bytes_;
};

std::vector<std::int64_t> whole(const std::vector<double>& values, const std::filesystem::path& file) {
  constexpr double largest = 9007199254740992;  // 2^53, up to which a double counts
  for (const double value : values)
    if (!(std::abs(value) <= largest))
      fail(file, "a polygon refers to point " + number_text(value) + ", which is not the number of a point");
  return {values.begin(), values.end()};
}

/// Polygon i ends behind offsets[i] of the connectivity.
void require_offsets(const VtkPiece& piece, const std::filesystem::path& file) {
  std::int64_t before = 0;
  for (const std::int64_t offset : piece.offsets) {
    if (offset < before || offset > static_cast<std::int64_t>(piece.connectivity.size()))
      fail(file, "polygon offset " + std::to_string(offset) + " is not between the one before and the number of corners, " +
                     std::to_string(piece.connectivity.size()));
    before = offset;
  }
}

void require_sizes(const VtkPiece& piece, const std::filesystem::path& file) {
  for (const VtkArray& array : piece.point_arrays)
    if (array.components < 1 || array.values.size() != piece.points.size() * static_cast<std::size_t>(array.components))
      fail(file, "array \"" + shortened(array.name) + "\" has " + std::to_string(array.values.size()) + " values of " +
                     std::to_string(array.components) + " components for " + std::to_string(piece.points.size()) + " points");
}

}  // namespace

VtkPiece read_polygons(const std::filesystem::path& file) {
  const Reader reader(file);
  VtkPiece piece;
  const std::vector<VtkArray> points = reader.arrays("Points"), polygons = reader.arrays("Polys");
  if (points.size() != 1 || polygons.size() != 2) fail(file, "has no points and polygons");
  const std::vector<double>& x = points[0].values;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) piece.points.push_back({x[i], x[i + 1], x[i + 2]});
  piece.connectivity = whole(polygons[0].values, file), piece.offsets = whole(polygons[1].values, file);
  piece.point_arrays = reader.arrays("PointData");
  require_offsets(piece, file);
  require_sizes(piece, file);
  for (const std::int64_t node : piece.connectivity)
    if (node < 0 || node >= static_cast<std::int64_t>(piece.points.size()))
      fail(file, "a polygon names point " + std::to_string(node) + " of " + std::to_string(piece.points.size()));
  return piece;
}

const std::vector<double>& array_named(const std::vector<VtkArray>& arrays, const std::string& name, const std::filesystem::path& file) {
  for (const VtkArray& array : arrays)
    if (array.name == name || array.name.starts_with(name + " [")) return array.values;
  fail(file, "has no array \"" + name + "\"");
}

std::vector<VtkInstant> read_collection(const std::filesystem::path& file) {
  const std::string content = content_of(file);
  std::vector<VtkInstant> instants;
  for (const std::string_view element : elements(content, "DataSet"))
    instants.push_back({number<double>(attribute(element, "timestep"), file), file.parent_path() / attribute(element, "file")});
  std::stable_sort(instants.begin(), instants.end(), [](const VtkInstant& a, const VtkInstant& b) { return a.time < b.time; });
  return instants;
}

}  // namespace snag
