#pragma once
// A run can be asked to stop: by a signal (SIGTERM, SIGINT, SIGUSR1 of batch systems, SIGHUP of a terminal that closes) or by a file named
// `stop` in its output folder. Under nohup SIGHUP stays ignored.
#include <mpi.h>

#include <filesystem>
#include <string>

namespace snag {

class StopRequest {
 public:
  /// Handles the signals from now on; `folder` is looked at for the file. A `stop` file left by an earlier run is removed. Collective.
  StopRequest(MPI_Comm comm, const std::filesystem::path& folder);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  /// True on all ranks as soon as one rank has a request. Collective.
  bool asked() const;
  /// Source of the request: "signal 15", "file stop".
  std::string reason() const;

 private:
  MPI_Comm comm_;
  std::filesystem::path file_;
};

}  // namespace snag
