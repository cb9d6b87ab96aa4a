// Walls as STL, text and bytes.
#include <cstring>

#include "mesh/wall_surface.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

const std::string ascii =
    "solid box\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid box\n";

std::string binary() {
  std::string content(80, ' ');
  const auto add = [&content](const auto& value) { content.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(std::uint32_t{2});
  for (const float shift : {0.0F, 1.0F}) {
    for (const float x : {0.0F, 0.0F, 1.0F, shift, 0.0F, 0.0F, 1.0F, shift, 0.0F, 0.0F, 1.0F, 0.0F}) add(x);
    add(std::uint16_t{0});
  }
  return content;
}

const fuzz::Registration stl({"stl", ".stl",
                              [] {
                                return std::vector<std::string>{ascii, binary()};
                              },
                              [](const std::filesystem::path& file) { read_stl(file, "walls"); }});

}  // namespace
