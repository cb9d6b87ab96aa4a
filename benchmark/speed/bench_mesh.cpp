#include "benchmark/speed/bench_mesh.hpp"

#include <mpi.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"
#include "simulation/setup/mesh_generator.hpp"

namespace snag {

std::filesystem::path bench_mesh(const std::filesystem::path& out, const std::string& name, const std::vector<std::string>& arguments) {
  const MPI_Comm world = MPI_COMM_WORLD;
  auto mesh = std::filesystem::absolute(out) / (name + ".msh"), unfinished = mesh;
  unfinished.replace_extension(".unfinished.msh");
  int made = 0;
  on_all_ranks(world, [&] {
    std::error_code failure;
    std::filesystem::create_directories(mesh.parent_path(), failure);
    if (failure)
      throw Error(ExitCode::io, out.string() + ": the output folder cannot be made (" + failure.message() + "); choose another --out");
    made = std::filesystem::exists(mesh);
  });
  MPI_Bcast(&made, 1, MPI_INT, 0, world);
  if (made) return mesh;
  log::info("bench: making the mesh (" + name + ")");
  std::vector<std::string> all = arguments;
  all.insert(all.end(), {"--out", unfinished.string()});
  const ExitCode code = generate_mesh(world, all);
  if (code != ExitCode::ok) throw Error(code, "bench: no mesh was made; try snag mesh " + arguments.front() + " by itself");
  on_all_ranks(world, [&] {
    if (rank_of(world) != 0) return;
    auto parameters = mesh, written = unfinished;  // what snag-mesh writes beside the mesh
    std::filesystem::rename(written.replace_extension(".resolved.toml"), parameters.replace_extension(".resolved.toml"));
    std::filesystem::rename(unfinished, mesh);
  });
  return mesh;
}

}  // namespace snag
