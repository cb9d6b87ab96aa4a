// Main of every test program: starts MPI and PETSc, lets rank 0 print, and fails on every rank when one rank failed.
#include <gtest/gtest.h>
#include <mpi.h>

#include "parallel/session.hpp"

int main(int argc, char** argv) {
  snag::Session session(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  if (session.rank() != 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    // Other ranks keep quiet unless they fail: a failure is printed by the assertion's own message to stderr.
    struct FailurePrinter final : testing::EmptyTestEventListener {
      void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.failed()) std::fprintf(stderr, "%s:%d: %s\n", result.file_name(), result.line_number(), result.message());
      }
    };
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter);
  }
  int failed = RUN_ALL_TESTS();
  if (testing::UnitTest::GetInstance()->test_to_run_count() == 0) failed = 1;
  int any = 0;
  MPI_Allreduce(&failed, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return any;
}
