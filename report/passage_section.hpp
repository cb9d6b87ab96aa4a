#pragma once
// A rag's way through the pump in a report: in words, over the angle of the volute, over time.
#include <filesystem>
#include <string>
#include <vector>

#include "report/monitor_plots.hpp"
#include "report/rag_passage.hpp"
#include "simulation/output/pump_record.hpp"

namespace snag {

/// What an engineer wants to know first, a paragraph of sentences for each rag; "" without passages.
std::string passage_verdict(const std::vector<RagPassage>& passages, const PumpRecord& pump);

/// The pump before, while and after a rag passed; paths, contacts, forces. `case_text`: case.resolved.toml, for radii of impeller and
/// tongue. "" without passages.
std::string passage_section(const std::vector<RagPassage>& passages, const PumpRecord& pump, const std::string& case_text);

/// What the section shows of the monitors.
ColumnsByMonitor passage_columns();

}  // namespace snag
