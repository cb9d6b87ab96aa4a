#pragma once
// How the passage of a rag ends, and what happens to it on the way: the one table of their words. Runs, studies, reports, the diagnosis and
// the observation of pictures use the enumerations; files (summary.json, volute.csv) hold the words, which stay as they are.
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace snag {

/// At the end of a run; observe/passage/passage_tracker.hpp defines them.
enum class Outcome { exited, recirculating, stuck_on_tongue, stuck_on_impeller, upstream, in_domain };

/// In the order in which a rag that passes meets them.
enum class PassageEvent { entered, wholly_in, tongue_passed, recirculated, stuck_on_tongue, stuck_on_impeller, reached_outlet, exited };

struct OutcomeWords {
  Outcome outcome;
  const char* key;         // in files
  const char* now;         // "Rag 0 ..."
  const char* at_the_end;  // of a pump: "The rag ... when the run ended"
  bool is_stuck;
};

inline constexpr std::array outcome_table{
    OutcomeWords{Outcome::exited, "exited", "has left the domain", "left the pump", false},
    OutcomeWords{Outcome::recirculating, "recirculating", "is still going round", "was still going round in the casing", false},
    OutcomeWords{Outcome::stuck_on_tongue, "stuck_on_tongue", "hangs on the tongue", "hung on the tongue", true},
    OutcomeWords{Outcome::stuck_on_impeller, "stuck_on_impeller", "hangs on the impeller", "hung on the impeller", true},
    OutcomeWords{Outcome::upstream, "upstream", "is still upstream", "was still entering the pump", false},
    OutcomeWords{Outcome::in_domain, "in_domain", "is still in the domain", "was still in the pump", false},
};

struct EventWords {
  PassageEvent event;
  const char* key;  // in files
};

inline constexpr std::array event_table{
    EventWords{PassageEvent::entered, "entered"},
    EventWords{PassageEvent::wholly_in, "wholly in the casing"},
    EventWords{PassageEvent::tongue_passed, "tongue passed"},
    EventWords{PassageEvent::recirculated, "recirculated"},
    EventWords{PassageEvent::stuck_on_tongue, "stuck on tongue"},
    EventWords{PassageEvent::stuck_on_impeller, "stuck on impeller"},
    EventWords{PassageEvent::reached_outlet, "reached the outlet"},
    EventWords{PassageEvent::exited, "exited"},
};

constexpr const OutcomeWords& words_of(Outcome outcome) { return outcome_table[static_cast<std::size_t>(outcome)]; }
constexpr const EventWords& words_of(PassageEvent event) { return event_table[static_cast<std::size_t>(event)]; }

/// Absent: no such word.
constexpr std::optional<Outcome> outcome_named(std::string_view key) {
  for (const OutcomeWords& words : outcome_table)
    if (key == words.key) return words.outcome;
  return {};
}
constexpr std::optional<PassageEvent> event_named(std::string_view key) {
  for (const EventWords& words : event_table)
    if (key == words.key) return words.event;
  return {};
}

}  // namespace snag
