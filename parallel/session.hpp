#pragma once
// The life of MPI and PETSc, and the rule that an error on one rank is an error on all with the same exit code.
#include <mpi.h>

#include <functional>

#include "base/error.hpp"

namespace snag {

/// Starts MPI and PETSc; ends them when it goes out of scope. One per process.
class Session {
 public:
  Session(int argc, char** argv);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  int rank() const { return rank_; }
  int size() const { return size_; }

 private:
  int rank_ = 0, size_ = 1;
};

int rank_of(MPI_Comm comm);
int size_of(MPI_Comm comm);

/// Run a piece of work that may fail on some ranks only; then either all ranks return or all throw the same Error (that of the lowest
/// failing rank). The work itself must not communicate after the point where it may throw. Collective.
void on_all_ranks(MPI_Comm comm, const std::function<void()>& work);

/// After an error. Waits 5 s for all ranks to fail, and returns if they do. If not, the other ranks wait in an exchange: this rank then
/// writes its number and the error to stderr (only rank 0 has a log, and has written it) and ends all ranks with the code.
void leave_together(const Error& failure);

/// Throw Error(io/mesh/...) with PETSc's own message if a PETSc call failed.
void check_petsc(int error_code, const char* call);

}  // namespace snag
