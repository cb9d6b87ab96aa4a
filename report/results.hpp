#pragma once
// What summary.json says, in words and tables for a reader who does not know its keys. Every group and key may be absent.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace snag {

/// What came out, in a sentence or two. `verdict`: sentences on the rags where more is known of them than their outcome.
std::string outcome_sentence(const nlohmann::json& summary, const std::string& verdict = "");
/// True if the run ended as planned and no check failed.
bool ended_well(const nlohmann::json& summary);
/// Tables as HTML; "" where the summary has nothing for them.
std::string run_table(const nlohmann::json& summary);
std::string pump_table(const nlohmann::json& summary);
/// The balances of angular momentum and of energy, with a sentence on what the scheme takes of each.
std::string balance_tables(const nlohmann::json& summary);
/// y+ of each wall, with what it means for the friction there.
std::string wall_table(const nlohmann::json& summary);
std::string rag_tables(const nlohmann::json& summary);
/// The checks of simulation/setup/checks.hpp with value, limit and verdict.
std::string check_table(const nlohmann::json& summary);
std::string cost_table(const nlohmann::json& summary);

}  // namespace snag
