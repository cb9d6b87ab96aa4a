#pragma once
// What a camera sees of rags, in pictures that were taken or in pictures of a run that the same camera would take; where in the volute the
// rags stay; and whether groups of repeats differ.
#include <filesystem>
#include <string>
#include <vector>

namespace snag {

/// Repeats at one operating point.
struct ObserveGroup {
  std::string name;                             // empty: subjects without a group
  std::vector<std::filesystem::path> subjects;  // folders of pictures, pictures, output folders of runs: each the test of one rag
};

struct ObserveOptions {
  std::vector<ObserveGroup> groups;
  std::filesystem::path camera_file;  // empty: none
  std::filesystem::path out;          // empty: results/observe-NAME
  int seed = 1;                       // of the virtual camera's noise
};

/// Of each subject, in DIR if it is the only one, else in DIR[/GROUP]/NAME: observations.csv (a row a blob), statistics.json (means and
/// deviations of the blobs that lie wholly in their picture), coverage.png, extent.png, outlines/*.png, for a run pictures/*.png;
/// volute.csv (of a run with [rag_passage]) and volute_seen.csv (of pictures by a camera with [pump_in_picture]). The same of each group;
/// of all together also volute.html, and of groups groups.csv and anova.csv. A subject that is a CSV file is a table of repeats: groups.csv
/// and anova.csv only. On one rank. Throws Error(usage, io).
void observe(const ObserveOptions& options);

}  // namespace snag
