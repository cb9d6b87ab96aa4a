#pragma once
// The data file of an experiment: rows of point,replicate,t_s,observable,value[,censored][,n,sd], in any order of columns.
#include <string>
#include <vector>

#include "diagnosis/data/experiment.hpp"

namespace snag {

struct DatumRow {
  Datum datum;  // value as written, not yet SI
  int line = 0;
  int n = 1;      // repeats that the row stands for; value is their mean
  double sd = 0;  // their standard deviation, as written; 0: as noise_u says
};

struct DataTable {
  std::vector<DatumRow> rows;  // in the order of the file
  std::string data_sha256, withheld_sha256;
};

/// Reads the text of a data file. Throws Error(usage) that names file and line.
DataTable read_data_table(const std::string& text, const std::string& name, const Experiment& experiment);

}  // namespace snag
