#include "parallel/session.hpp"

#include <petscsys.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "base/explained.hpp"

namespace snag {

Session::Session(int argc, char** argv) {
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

void leave_together(ExitCode code) {
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int waited = 0; waited < 100; ++waited) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
}

void check_petsc(int error_code, const char* call) {
  if (error_code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(static_cast<PetscErrorCode>(error_code), &text, nullptr);
  throw Error(ExitCode::io, std::string("PETSc: ") + call + " failed: " + (text ? text : "unknown error"));
}

}  // namespace snag
