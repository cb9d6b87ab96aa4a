#include "parallel/write_failure.hpp"

#include <mpi.h>

#include <cerrno>
#include <cstring>

namespace snag {

namespace {

std::string first_failure;

std::string words_of_mpi(int code) {
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  return text;
}

/// The operating system's reason, where there is one, says more than that of MPI.
void remember(int reason, const std::string& otherwise) {
  if (first_failure.empty()) first_failure = reason != 0 ? std::strerror(reason) : otherwise;
}

/// Makes a call of MPI-IO and remembers why it failed.
template <class Call>
int remembered(Call call) {
  errno = 0;
  const int code = call(), reason = errno;
  if (code != MPI_SUCCESS) remember(reason, words_of_mpi(code));
  return MPI_SUCCESS;
}

/// A write without the other ranks; its status says in the end that all was written. Behind a failure it is left out: the file is lost
/// anyway. What was cut short is written again, to hear the reason.
template <class Call>
int written(int count, MPI_Datatype type, MPI_Status* status, Call call) {
  MPI_Count size = 0, done = 0;
  MPI_Type_size_x(type, &size);
  size *= count;
  MPI_Status own{};
  const auto is_cut_short = [&] { return MPI_Get_elements_x(&own, MPI_BYTE, &done) == MPI_SUCCESS && done != size; };
  if (first_failure.empty())
    remembered([&] {
      int code = call(&own);
      if (code == MPI_SUCCESS && is_cut_short()) code = call(&own);
      if (const int reason = errno; code == MPI_SUCCESS && is_cut_short())
        remember(reason, "only " + std::to_string(done) + " of " + std::to_string(size) + " bytes were written");
      return code;
    });
  MPI_Status_set_elements_x(&own, MPI_BYTE, size);
  if (status != MPI_STATUS_IGNORE) *status = own;
  return MPI_SUCCESS;
}

}  // namespace

const std::string& write_failure() { return first_failure; }
void forget_write_failure() { first_failure.clear(); }

}  // namespace snag

extern "C" {

int MPI_File_write_at(MPI_File file, MPI_Offset offset, const void* values, int count, MPI_Datatype type, MPI_Status* status) {
  return snag::written(count, type, status, [&](MPI_Status* own) { return PMPI_File_write_at(file, offset, values, count, type, own); });
}

/// Alone, too: each rank writes one piece in a row, so that the others have nothing to gather; and where the writing rank of Open MPI fails
/// it leaves the others waiting.
int MPI_File_write_at_all(MPI_File file, MPI_Offset offset, const void* values, int count, MPI_Datatype type, MPI_Status* status) {
  return snag::written(count, type, status, [&](MPI_Status* own) { return PMPI_File_write_at(file, offset, values, count, type, own); });
}

int MPI_File_set_size(MPI_File file, MPI_Offset size) {
  return snag::remembered([&] { return PMPI_File_set_size(file, size); });
}

int MPI_File_sync(MPI_File file) {
  return snag::remembered([&] { return PMPI_File_sync(file); });
}

}  // extern "C"
