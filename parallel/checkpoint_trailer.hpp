#pragma once
// The last line of a slot: length and CRC-32 of all bytes before it.
//
// It is written when these bytes are on the disk, and makes the slot complete. HDF5 does not look behind the end of its own data, and has
// no checksum of the places, shapes and attributes of its arrays: without the trailer one spoilt bit there could give other numbers.
#include <mpi.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace snag {

/// CRC-32 of the bytes of which each rank has a part, in rank order, from that of this rank's part. Collective.
std::uint32_t joined_crc32(MPI_Comm comm, uLong part, std::int64_t part_bytes);

/// Appends the trailer to a closed file and brings it to the disk, with the name in its folder. Collective; throws Error(io).
void append_trailer(MPI_Comm comm, const std::filesystem::path& file);

/// Nothing if the file has the bytes that its trailer was written for, else what is wrong with it ("absent", "damaged: ..."). Each rank
/// reads its share. Collective; never throws for a bad file.
std::string damage_of(MPI_Comm comm, const std::filesystem::path& file);

}  // namespace snag
