#pragma once
// The passport of a calibration as TOML (dem/templates/passport.hpp reads it). It holds no date: the same tests give the same file.
#include <string>
#include <vector>

#include "textile/calibration.hpp"

namespace snag {

/// `tests_file`: name of the file of the tests; `pictures`: files beside the passport.
std::string passport_text(const TextileTests& tests, const std::vector<Calibration>& calibrations, const std::string& tests_file,
                          const std::vector<std::string>& pictures);

}  // namespace snag
