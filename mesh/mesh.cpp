#include "mesh/mesh.hpp"

#include "base/error.hpp"

namespace snag {

int Mesh::patch_index(const std::string& name) const {
  std::string known;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i].name == name) return static_cast<int>(i);
    known.append(known.empty() ? "" : ", ").append(patches[i].name);
  }
  throw Error(ExitCode::mesh, "patch \"" + name + "\" is not in the mesh; its patches are " + (known.empty() ? "none" : known));
}

}  // namespace snag
