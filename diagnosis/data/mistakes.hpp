#pragma once
// Mistakes that an experiment may hold, as hypotheses beside the effects: a known input that is far off, a clock that starts late, a frame
// rate, the sign of an axis, a unit. They are candidates of their own, with one strength theta each:
//
//   input:KEY   the input is (1 + theta) times what the case says, at all points that state it as uncertain, whether it has one value there
//               or, as from a scale that reads too high, several; named from 3 u on
//   input:KEY@A, B  the same at the points with one of several values
//   clock       what is measured at t was there at t + theta, s
//   frame_rate  what is measured at t was there at (1 + theta) t
//   sign:AXIS   positions and velocities along an axis have the other sign; there or not
//   scale:GROUP what is measured at a group of points is (1 + theta) times the true number; of several calibrations each,
//               scale:GROUP/CALIBRATION or UNIT, and all with one unit together, as those of the axes of one camera (scale:GROUP, of
//               several such units scale:GROUP/UNIT)
//   offset:OBSERVABLE@GROUP  it is theta more, in the unit of the observable
//   unit:UNIT   the numbers of all observables with this unit are another factor larger (1000, 25.4, 180/pi, ...), and with them noise_u
//               and bias_u, which are stated in the right unit; there or not
//
// All but the inputs change what a run answers with, not the run.
#include <map>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/data/experiment.hpp"
#include "diagnosis/data/simulator.hpp"

namespace snag {

struct Mistake {
  enum class Kind { input, clock, frame_rate, sign, unit, scale, offset };
  Kind kind = Kind::input;
  Effect effect;
  std::string input{};              // key of it
  std::vector<int> points{};        // with the wrong input, or the calibration; of the other mistakes none: they are made at all points
  std::vector<int> observables{};   // that it changes
  std::map<int, double> periods{};  // of them, of angles: a path is interpolated along the turn, not across where the angle begins again
  std::vector<int> rates{};         // of them: per time, so that a frame rate changes their numbers too
  double factor = 1;                // of a unit: simulated numbers times this are as the data say them; of an offset: SI value of its unit
};

/// Those of inputs: keys that several points state as uncertain, or the only point.
std::vector<Mistake> mistakes_of_inputs(const Experiment& experiment, std::span<const Nuisance> nuisances);
/// Those of times and axes that the data can hold.
std::vector<Mistake> mistakes_of_measurement(const Experiment& experiment);
/// Calibrations of groups of points, OperatingPoint::group: not of a group that holds all points of training, whose calibration is that of
/// the camera.
std::vector<Mistake> mistakes_of_groups(const Experiment& experiment);
/// A wrong unit of the observables with this unit; `ratio`: of data to simulation. None where it is no known factor.
std::vector<Mistake> mistakes_of_unit(const Experiment& experiment, const std::string& unit, double ratio);

/// What is measured of a run by mistake: its values at these slots. Returns by slot how uncertain they are, because the run has no number
/// there: it is continued beyond its first and last sample along a line, which differs by what a parabola would add; else 0.
std::vector<double> mismeasure(const Mistake& mistake, double theta, const std::vector<Slot>& slots, std::vector<double>& values);

}  // namespace snag
