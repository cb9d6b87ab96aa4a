#pragma once
// What is made before a run and takes long, once for all runs of a process that share it: those of a study, or of a diagnosis.
#include "simulation/setup/generated_meshes.hpp"
#include "simulation/setup/rag_poses.hpp"

namespace snag {

struct Prepared {
  GeneratedMeshes meshes;
  MadePoses poses;
};

}  // namespace snag
