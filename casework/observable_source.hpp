#pragma once
// How a run gives the structs from which observables are read (Reading, observe/observables.hpp). Each struct is one file of
// casework/sources/. A new source is one such file: it registers the struct and, where only a simulation has it, the observables that are
// read from it (add_observables).
#include <any>
#include <filesystem>
#include <functional>
#include <map>
#include <typeindex>

#include "casework/exit_watch.hpp"
#include "observe/observables.hpp"
#include "simulation/setup/simulation.hpp"

namespace snag {

/// A run in memory at the end of a step, or at its start.
struct RunInMemory {
  const Simulation& simulation;
  const View& view;  // of the camera
  const ExitWatch& exit;
};

struct ObservableSource {
  std::function<std::any(const RunInMemory&)> in_memory;
  /// Of a run in a folder that has ended, for observables of the whole run; holds nothing where the run lacks it. Null: the folder has no
  /// such number. What changes in time is the column of a monitor that has the name of the observable.
  std::function<std::any(const std::filesystem::path& folder)> in_folder = nullptr;
};

/// All, by the type of their struct.
std::map<std::type_index, ObservableSource>& observable_sources();

/// Registers a source. Returns true, so that a constant can hold the registration.
template <class Source>
bool add_observable_source(ObservableSource source) {
  return observable_sources().emplace(typeid(Source), std::move(source)).second;
}

/// Reads observables at one time of a run in memory: each source that they need is made once.
class RunReader {
 public:
  explicit RunReader(const RunInMemory& run) : run_(run) {}
  double operator()(const Reading& reading) { return reading(source(reading.source())); }
  template <class Source>
  const Source& get() {
    return std::any_cast<const Source&>(source(typeid(Source)));
  }

 private:
  const std::any& source(std::type_index type);

  RunInMemory run_;
  std::map<std::type_index, std::any> made_;
};

}  // namespace snag
