#pragma once
// The step that a run found by [time] step = "auto", and the trials that show why.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace snag {

/// HTML of a section, from summary.json; empty if the case gave its step.
std::string step_section(const nlohmann::json& summary);

}  // namespace snag
