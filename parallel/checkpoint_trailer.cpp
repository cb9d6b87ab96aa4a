#include "parallel/checkpoint_trailer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/open_file.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr std::int64_t trailer_length = 60, block = 1 << 20;  // bytes

std::string trailer(std::int64_t bytes, std::uint32_t crc) {
  char text[trailer_length + 1];
  std::snprintf(text, sizeof text, "\nsnag checkpoint: %016llx bytes of CRC-32 %08lx\n", static_cast<unsigned long long>(bytes),
                static_cast<unsigned long>(crc));
  return text;
}

/// The bytes [begin, end) of a file, or nothing if it does not have them.
std::optional<std::string> bytes_of(const OpenFile& file, std::int64_t begin, std::int64_t end) {
  std::string bytes(static_cast<std::size_t>(end - begin), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = pread(file.descriptor(), bytes.data() + done, bytes.size() - done, begin + static_cast<off_t>(done));
    if (n <= 0) return {};
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

/// CRC-32 of the first `length` bytes of a file; nothing on all ranks if one cannot read its share.
std::optional<std::uint32_t> file_crc32(MPI_Comm comm, const std::filesystem::path& path, std::int64_t length) {
  const std::int64_t rank = rank_of(comm), size = size_of(comm), begin = length / size * rank,
                     end = rank + 1 == size ? length : length / size * (rank + 1);
  uLong crc = crc32_z(0, nullptr, 0);
  int readable = 1;
  try {
    const OpenFile file(path, O_RDONLY);
    for (std::int64_t at = begin; at < end && readable; at += block) {
      const auto bytes = bytes_of(file, at, std::min(at + block, end));
      readable = bytes.has_value();
      if (bytes) crc = crc32_z(crc, reinterpret_cast<const Bytef*>(bytes->data()), bytes->size());
    }
  } catch (const Error&) {
    readable = 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &readable, 1, MPI_INT, MPI_MIN, comm);
  const std::uint32_t joined = joined_crc32(comm, crc, end - begin);
  if (!readable) return {};
  return joined;
}

/// Length of the file without its trailer, on all ranks; negative: the file is too short or not there.
std::int64_t content_length(MPI_Comm comm, const std::filesystem::path& file) {
  std::int64_t length = -1;
  std::error_code failure;
  if (rank_of(comm) == 0 && std::filesystem::exists(file, failure)) {
    const auto bytes = std::filesystem::file_size(file, failure);
    if (!failure) length = static_cast<std::int64_t>(bytes) - trailer_length;
  }
  MPI_Bcast(&length, 1, MPI_INT64_T, 0, comm);
  return length;
}

}  // namespace

std::uint32_t joined_crc32(MPI_Comm comm, uLong part, std::int64_t part_bytes) {
  const std::int64_t mine[2] = {static_cast<std::int64_t>(part), part_bytes};
  std::vector<std::int64_t> all(2 * static_cast<std::size_t>(size_of(comm)));
  MPI_Allgather(mine, 2, MPI_INT64_T, all.data(), 2, MPI_INT64_T, comm);
  uLong total = crc32_z(0, nullptr, 0);
  for (std::size_t i = 0; i < all.size(); i += 2) total = crc32_combine(total, static_cast<uLong>(all[i]), all[i + 1]);
  return static_cast<std::uint32_t>(total);
}

void append_trailer(MPI_Comm comm, const std::filesystem::path& file) {
  const std::int64_t length = content_length(comm, file) + trailer_length;
  const auto crc = file_crc32(comm, file, length);
  on_all_ranks(comm, [&] {
    if (!crc) throw Error(ExitCode::io, file.string() + ": cannot be read again after it was written; is the disk damaged?");
    if (rank_of(comm) != 0) return;
    OpenFile out(file, O_WRONLY | O_APPEND);
    out.sync();
    out.write(trailer(length, *crc));
    out.sync();
    sync_to_disk(file.parent_path());
  });
}

std::string damage_of(MPI_Comm comm, const std::filesystem::path& file) {
  int found = rank_of(comm) == 0 && std::filesystem::exists(file);
  MPI_Bcast(&found, 1, MPI_INT, 0, comm);
  if (!found) return "absent";
  const std::int64_t length = content_length(comm, file);
  if (length < 0) return "incomplete: too short for a checkpoint";
  const auto crc = file_crc32(comm, file, length);
  if (!crc) return "damaged: it cannot be read to its end";
  int complete = 0, whole = 0;
  if (rank_of(comm) == 0) try {
      const std::string found_trailer = bytes_of(OpenFile(file, O_RDONLY), length, length + trailer_length).value_or("");
      complete = found_trailer.starts_with("\nsnag checkpoint: ");
      whole = found_trailer == trailer(length, *crc);
    } catch (const Error&) {
    }
  MPI_Bcast(&complete, 1, MPI_INT, 0, comm);
  MPI_Bcast(&whole, 1, MPI_INT, 0, comm);
  if (whole) return "";
  if (!complete) return "incomplete: the run was stopped while it was written, or the file was cut";
  return "damaged: its " + std::to_string(length) + " bytes do not have the checksum they were written with";
}

}  // namespace snag
