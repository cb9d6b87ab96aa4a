#include "parallel/stop_request.hpp"

#include <csignal>

#include "parallel/session.hpp"

namespace snag {

namespace {

volatile std::sig_atomic_t signal_received = 0;

extern "C" void remember_signal(int number) { signal_received = number; }

constexpr int handled[] = {SIGTERM, SIGINT, SIGUSR1, SIGHUP};
constexpr int stop_file_seen = 1000;  // above every signal number

}  // namespace

StopRequest::StopRequest(MPI_Comm comm, const std::filesystem::path& folder) : comm_(comm), file_(folder / "stop") {
  signal_received = 0;
  for (const int number : handled) {
    const auto before = std::signal(number, remember_signal);
    if (number == SIGHUP && before == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup wants the run to go on
  }
  std::error_code ignored;
  if (rank_of(comm_) == 0) std::filesystem::remove(file_, ignored);
}

StopRequest::~StopRequest() {
  for (const int number : handled) {
    const auto before = std::signal(number, SIG_DFL);
    if (before == SIG_IGN) std::signal(number, SIG_IGN);
  }
}

bool StopRequest::asked() const {
  int mine = signal_received;
  std::error_code ignored;
  if (rank_of(comm_) == 0 && mine == 0 && std::filesystem::exists(file_, ignored)) mine = stop_file_seen;
  int any = 0;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, comm_);
  signal_received = any;
  return any != 0;
}

std::string StopRequest::reason() const {
  return signal_received == stop_file_seen ? "file " + file_.string() : "signal " + std::to_string(signal_received);
}

}  // namespace snag
