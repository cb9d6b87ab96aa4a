#pragma once
// Repeats of an observation in several groups (operating points): a table of samples, and the comparison of the groups.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "observe/anova.hpp"
#include "observe/independent_samples.hpp"

namespace snag {

inline constexpr double largest_measured = 1e30;  // of a measured value in its unit: statistics take its square

struct Quantity {
  std::string name, unit;
  /// An orientation: the direction of an axis in degrees, so that 89 and -89 lie 2 apart.
  bool is_axis() const;
};

struct Repeats {
  struct Row {
    int group = 0, rag = -1;     // rag: of its group; -1: not known
    std::vector<double> values;  // of each quantity
  };
  std::vector<std::string> groups;
  std::vector<Quantity> quantities;
  std::vector<Row> rows;  // in the order in which they were taken
};

/// A CSV file with the columns "group", perhaps "rag", and one for each quantity with its unit: "area [m2]", "orientation [deg]". Groups
/// and rags are any words. Blank lines and lines with # are passed over. Throws Error(usage) naming the line, Error(io).
Repeats read_repeats(const std::filesystem::path& file);

/// Mean and standard deviation (n - 1; not a number for one value) of a quantity.
struct MeanAndSigma {
  double mean = 0, sigma = 0;
};
/// Of at least one value. Of an axis: the mean direction by the doubled angle, the deviation of what lies within 90 degrees of it.
MeanAndSigma mean_and_sigma(const std::vector<double>& values, const Quantity& quantity);

struct GroupComparison {
  struct Group {
    MeanAndSigma values;
    double n = 0, n_independent = 0;
  };
  Quantity quantity;
  std::vector<Group> groups;
  Dependence dependence = Dependence::none;
  double correlation = 0;
  Anova by_count;
  std::optional<Anova> by_independent;  // none if there are not more independent samples than groups
};

/// One comparison for each quantity. `where` stands in messages. Throws Error(usage) on fewer than two groups, on a group with fewer than
/// two samples, on a value that is not finite, and on a quantity that does not vary within the groups.
std::vector<GroupComparison> compare_groups(const Repeats& repeats, const std::string& where);

/// A row for each quantity and group; a row for each quantity.
std::string groups_csv(const std::vector<GroupComparison>& comparisons, const Repeats& repeats);
std::string anova_csv(const std::vector<GroupComparison>& comparisons);
/// A line for each quantity.
std::string words_of(const std::vector<GroupComparison>& comparisons);

}  // namespace snag
