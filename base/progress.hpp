#pragma once
// How far a run is: one line rewritten on a terminal, plain lines now and then in a batch log; with the time left.
#include <chrono>
#include <string>

namespace snag {

/// Of one rank: the others keep none, or their lines would mix.
class Progress {
 public:
  /// `total`: the amount of work (seconds to simulate, steps); `start`: the amount done before (a resume).
  Progress(std::string what, double total, double start = 0);
  /// `done` of `total`; `note` is appended ("Co 0.8, 3 iterations"). Prints at most 5 times a second (terminal) or every 30 s (batch).
  void update(double done, const std::string& note = "");
  void finish();

 private:
  std::string what_;
  double total_, start_;
  bool terminal_;
  std::chrono::steady_clock::time_point begun_, printed_;
};

/// "3 h 05 min", "12 s".
std::string duration(double seconds);

}  // namespace snag
