#pragma once
// The verdict as a page for a reader who has to do something about the gap.
#include <string>

#include "diagnosis/data/verdict.hpp"

namespace snag {

/// report.html: the verdict and what to do, which (probabilities), how far (four bars), where (cells), what to measure next; the evidence
/// below.
std::string verdict_page(const Verdict& verdict);

}  // namespace snag
