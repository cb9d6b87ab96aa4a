#pragma once
// The pump in a report: the last revolution in numbers, head and torque over the angle, how the revolutions settle.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace snag {

/// From summary.json and monitors/pump.csv, revolutions.csv, phase.csv as far as they are there; "" for a run without a pump.
std::string pump_section(const nlohmann::json& summary, const std::filesystem::path& monitors);

}  // namespace snag
