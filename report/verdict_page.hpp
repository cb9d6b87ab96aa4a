#pragma once
// The verdict as a page for a reader who has to do something about the gap.
#include <string>

#include "diagnosis/data/verdict.hpp"

namespace snag {

/// The verdict in one sentence.
std::string verdict_sentence(const Verdict& verdict);
/// report.html: the verdict, which (probabilities), how far (four bars), where (cells), what to measure next; the evidence below.
std::string verdict_page(const Verdict& verdict);

}  // namespace snag
