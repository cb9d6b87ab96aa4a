#pragma once
// A row of a data file that stands for several repeats, as publications print them: mean, standard deviation and number.
#include <vector>

#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/experiment_table.hpp"

namespace snag {

/// The repeats of a row in SI whose n is above 1, numbered from its replicate on: as many samples with exactly this mean and standard
/// deviation, which hold all that a normal (lognormal: of the logarithm, by its moments) law needs; of events and counts with this total,
/// rounded to a whole number.
std::vector<Datum> repeats_of(const DatumRow& row, const Observable& observable);

}  // namespace snag
