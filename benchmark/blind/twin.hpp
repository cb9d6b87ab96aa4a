#pragma once
// Twins: experiments whose truth is known because this program made it, for the blind benchmark.
//
// The truth of a set is a run of the same particle code in which one more thing acts. At level L1 it has another step; at L2 also another
// functional form of the effect (the second `form` of its force), another drag law, and a flow that is off by its uncertainty. Inputs are
// off by their stated uncertainties at both, and every sample has noise and a shared bias.
#include <cstdint>
#include <filesystem>
#include <string>

#include "diagnosis/score/sealed_set.hpp"

namespace snag {

struct TwinPlan {
  std::string twin = "sphere";  // sphere | fibre | rag
  std::string level = "L2";     // L1 | L2
  std::uint64_t seed = 1;
};

/// Makes set `number` in `folder`: DIAGNOSIS.toml, data.csv, point_*.toml. Returns what is true of it. One rank; throws Error.
Truth make_twin(const TwinPlan& plan, int number, const std::filesystem::path& folder);

}  // namespace snag
