#pragma once
// A row of a data file that stands for several repeats, as publications print them: mean, standard deviation and number.
#include <vector>

#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/experiment_table.hpp"

namespace snag {

struct MeanAndSd {
  double mean = 0, sd = 0;
};
/// Of the logarithm of a lognormal quantity with these: variance ln(1 + (sd/mean)^2), mean ln(mean) less half of that.
MeanAndSd of_logarithm(const MeanAndSd& quantity);

/// The repeats of a scalar row in SI whose n is above 1, numbered from its replicate on: as many samples with exactly this mean and
/// standard deviation, which hold all that a normal (lognormal: of the logarithm, by its moments) law needs; of events and counts with this
/// total, rounded to a whole number.
std::vector<Datum> repeats_of(const DatumRow& row, const Observable& observable);

}  // namespace snag
