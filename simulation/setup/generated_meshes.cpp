#include "simulation/setup/generated_meshes.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/mesh_generator.hpp"

namespace snag {

GeneratedMeshes::~GeneratedMeshes() {
  std::error_code ignored;
  for (Made& made : made_) {
    std::filesystem::remove(made.file, ignored);
    std::filesystem::remove(made.file.replace_extension(".resolved.toml"), ignored);  // which the generator writes as well
  }
}

std::filesystem::path GeneratedMeshes::file(MPI_Comm comm, const std::string& geometry, const std::filesystem::path& parameters,
                                            const std::vector<std::string>& set) {
  Made wanted{.geometry = geometry, .parameters = {}, .set = set, .file = {}};
  int from_rank_0[] = {static_cast<int>(getpid()), static_cast<int>(made_.size())};  // process, number of the mesh
  if (rank_of(comm) == 0) {
    // A file that cannot be read is like no other: the generator says why.
    const auto text = parameters.empty() ? std::optional<std::string>("") : file_text(parameters);
    if (text) wanted.parameters = *text;
    const auto same = std::find_if(made_.begin(), made_.end(), [&](const Made& one) {
      return text && one.geometry == wanted.geometry && one.parameters == wanted.parameters && one.set == wanted.set &&
             std::filesystem::exists(one.file);
    });
    from_rank_0[1] = static_cast<int>(same - made_.begin());
  }
  MPI_Bcast(from_rank_0, 2, MPI_INT, 0, comm);
  const auto [process, number] = from_rank_0;
  if (number < static_cast<int>(made_.size())) return made_[number].file;

  wanted.file = std::filesystem::temp_directory_path() / ("snag-" + std::to_string(process) + "-" + std::to_string(number) + ".msh");
  std::vector<std::string> arguments{geometry};
  if (!parameters.empty()) arguments.push_back(parameters.string());
  arguments.insert(arguments.end(), {"--out", wanted.file.string()});
  for (const std::string& value : set) arguments.insert(arguments.end(), {"--set", value});
  made_.push_back(std::move(wanted));
  const ExitCode code = generate_mesh(comm, arguments);
  if (code == ExitCode::ok) return made_.back().file;
  made_.pop_back();
  throw Error(code, "[mesh] geometry = \"" + geometry + "\": no mesh was made; try snag mesh " + geometry + " by itself");
}

}  // namespace snag
