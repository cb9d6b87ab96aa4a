#pragma once
// Meshes of parametric geometries that cases ask for: files that the generator makes, once for all runs that share them.
#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

namespace snag {

class GeneratedMeshes {
 public:
  GeneratedMeshes() = default;
  /// Removes the files.
  ~GeneratedMeshes();
  GeneratedMeshes(const GeneratedMeshes&) = delete;
  GeneratedMeshes& operator=(const GeneratedMeshes&) = delete;

  /// File of the mesh of a geometry with the parameters of a file (empty: all by default), of which `set` ("key=value") replaces some. It
  /// is made where no earlier call had the same geometry and parameters, and stays until this object ends. Collective; throws Error with
  /// the exit code of the generator.
  std::filesystem::path file(MPI_Comm comm, const std::string& geometry, const std::filesystem::path& parameters,
                             const std::vector<std::string>& set);

 private:
  struct Made {
    std::string geometry, parameters;  // the content of their file
    std::vector<std::string> set;
    std::filesystem::path file;
  };
  std::vector<Made> made_;  // the same on all ranks, but parameters, which rank 0 alone reads
};

}  // namespace snag
