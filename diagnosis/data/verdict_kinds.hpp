#pragma once
// Kinds of verdicts, how sure they are, tests of the cells and where a gap comes from: the one table of their words. The diagnosis, reports
// and benchmarks use the enumerations; files (verdict.json, scores.csv) hold the words, which stay as they are.
#include <array>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string_view>

namespace snag {

enum class VerdictKind {
  none,     // no gap beyond the uncertainty
  effects,  // effects are named
  outside,  // a gap that no effect of the library explains
  tie,      // hypotheses that the data do not tell apart
  blind     // no effect would show in these data
};

/// How sure a verdict is.
enum class Wording { no_gap, attributed, suspected, undecided, outside, blind };

/// Test of one cell of "where".
enum class CellTest { z, binomial, negative_binomial, log_rank, energy_distance, fitted, shape };

/// Of the gap in a window, by a restart from the measured state.
enum class GapOrigin { not_judged, born, inherited, undecided };

inline constexpr std::array verdict_kind_words{"none", "effects", "outside", "tie", "blind"};
inline constexpr std::array wording_words{"no gap beyond u_val", "attributed", "suspected", "undecided", "outside", "blind"};
inline constexpr std::array cell_test_words{"z", "binomial", "negative_binomial", "log_rank", "energy_distance", "fitted", "shape"};
inline constexpr std::array gap_origin_words{"", "born", "inherited", "undecided"};

constexpr const char* word(VerdictKind kind) { return verdict_kind_words[static_cast<std::size_t>(kind)]; }
constexpr const char* word(Wording wording) { return wording_words[static_cast<std::size_t>(wording)]; }
constexpr const char* word(CellTest test) { return cell_test_words[static_cast<std::size_t>(test)]; }
constexpr const char* word(GapOrigin origin) { return gap_origin_words[static_cast<std::size_t>(origin)]; }

/// Absent: no such word.
template <class Kind, std::size_t n>
constexpr std::optional<Kind> kind_of_word(std::string_view text, const std::array<const char*, n>& all) {
  for (std::size_t i = 0; i < n; ++i)
    if (text == all[i]) return static_cast<Kind>(i);
  return {};
}
constexpr std::optional<VerdictKind> verdict_named(std::string_view text) { return kind_of_word<VerdictKind>(text, verdict_kind_words); }
constexpr std::optional<Wording> wording_named(std::string_view text) { return kind_of_word<Wording>(text, wording_words); }

inline std::ostream& operator<<(std::ostream& out, VerdictKind kind) { return out << word(kind); }
inline std::ostream& operator<<(std::ostream& out, Wording wording) { return out << word(wording); }
inline std::ostream& operator<<(std::ostream& out, CellTest test) { return out << word(test); }
inline std::ostream& operator<<(std::ostream& out, GapOrigin origin) { return out << word(origin); }

}  // namespace snag
