#include "parallel/session.hpp"

#include <petscsys.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/explained.hpp"

namespace snag {

namespace {

bool is_set(const char* name) { return std::getenv(name) != nullptr; }

/// Within one machine Open MPI needs no network: the search for one takes 0.2 s of each start (psm measures the clock, even where there is
/// no such hardware), and a process without a launcher starts a daemon, another 0.1 s. Parameters that the user set in the environment
/// stay; those set here last until MPI has started, so that a program started from this one does not inherit them.
class NoNetwork {
 public:
  NoNetwork() {
    const bool launched = is_set("OMPI_COMM_WORLD_SIZE") || is_set("PMIX_RANK") || is_set("PMI_RANK") || is_set("SLURM_PROCID");
    const char *ranks = std::getenv("OMPI_COMM_WORLD_SIZE"), *ranks_here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const bool one_machine = ranks && ranks_here && std::string_view(ranks) == ranks_here;
    if (launched && !one_machine) return;
    set("OMPI_MCA_pml", "ob1");
    set("OMPI_MCA_btl", launched ? "self,vader" : "self");
    if (launched) return;
    set("OMPI_MCA_ess_singleton_isolated", "1");
    // Processes without a daemon share one folder of a session, which the first that ends removes; the files of ompio lie there. Open MPI
    // reads the last of these when the first file is opened, so that it stays.
    set("OMPI_MCA_orte_create_session_dirs", "0");
    setenv("OMPI_MCA_io", "^ompio", 0);
  }
  ~NoNetwork() {
    for (const char* name : set_) unsetenv(name);
  }
  NoNetwork(const NoNetwork&) = delete;
  NoNetwork& operator=(const NoNetwork&) = delete;

 private:
  void set(const char* name, const char* value) {
    if (is_set(name)) return;
    setenv(name, value, 0);
    set_.push_back(name);
  }
  std::vector<const char*> set_;
};

}  // namespace

Session::Session(int argc, char** argv) {
  const NoNetwork parameters;
  std::signal(SIGXFSZ, SIG_IGN);  // a file that reaches a limit of its size is an error of writing, with its message, and no sudden end
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  // Our own options only: the command line belongs to Snag. Signals are ours too (a request to stop writes a checkpoint first).
  PetscInitializeNoArguments();
  PetscPopSignalHandler();
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
}

Session::~Session() {
  PetscPopErrorHandler();
  PetscFinalize();
  MPI_Finalize();
}

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

void on_all_ranks(MPI_Comm comm, const std::function<void()>& work) {
  const int rank = rank_of(comm), size = size_of(comm);
  std::optional<Error> caught;
  try {
    work();
  } catch (const std::exception& error) {
    caught = explained(error);
  }
  const int mine = caught ? rank : size;
  int failing = size;
  MPI_Allreduce(&mine, &failing, 1, MPI_INT, MPI_MIN, comm);
  if (failing == size) return;

  int header[2] = {0, 0};
  std::string message;
  if (rank == failing) {
    message = caught->what();
    header[0] = static_cast<int>(caught->code), header[1] = static_cast<int>(message.size());
  }
  MPI_Bcast(header, 2, MPI_INT, failing, comm);
  message.resize(header[1]);
  MPI_Bcast(message.data(), header[1], MPI_CHAR, failing, comm);
  throw Error(static_cast<ExitCode>(header[0]), message);
}

void leave_together(const Error& failure) {
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int waited = 0; waited < 100; ++waited) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (rank_of(MPI_COMM_WORLD) > 0)
    std::fprintf(stderr, "error: rank %d of %d: %s\n", rank_of(MPI_COMM_WORLD), size_of(MPI_COMM_WORLD), failure.what());
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(failure.code));
}

void check_petsc(int error_code, const char* call) {
  if (error_code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(static_cast<PetscErrorCode>(error_code), &text, nullptr);
  throw Error(ExitCode::io, std::string("PETSc: ") + call + " failed: " + (text ? text : "unknown error"));
}

}  // namespace snag
