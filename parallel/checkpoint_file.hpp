#pragma once
// A slot open on all ranks: arrays written and read together, each with its checksum. For .cpp files of this folder only.
#include <mpi.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "parallel/checkpoint_trailer.hpp"
#include "parallel/hdf5_file.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "parallel/write_failure.hpp"

namespace snag {

/// Type of numbers in the file and in memory: the same bytes on the usual machines, so that every bit is kept.
template <class T>
struct FileType;
template <>
struct FileType<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
};
template <>
struct FileType<std::int64_t> {
  static hid_t file() { return H5T_STD_I64LE; }
  static hid_t memory() { return H5T_NATIVE_INT64; }
};
template <>
struct FileType<char> {
  static hid_t file() { return H5T_STD_U8LE; }
  static hid_t memory() { return H5T_NATIVE_UINT8; }
};

/// The part [begin, begin + count) of all rows that one rank reads or writes.
struct Slab {
  hsize_t begin = 0, count = 0;
};

/// A slot open on all ranks. All members are collective.
struct CheckpointFile {
  MPI_Comm comm = MPI_COMM_NULL;
  std::filesystem::path path;
  hdf5::Handle file, collective;  // `collective`: transfers that all ranks do together

  [[noreturn]] void fail(const std::string& what) const { throw Error(ExitCode::io, path.string() + ": " + what); }

  /// A call of the library on all ranks; throws the same Error on all if it fails on one.
  template <class Call>
  auto on_all(const std::string& what, Call call) const {
    decltype(call()) result = -1;
    on_all_ranks(comm, [&] {
      result = call();
      if (result >= 0 && write_failure().empty()) return;
      const std::string reason = write_failure().empty() ? hdf5::last_reason() : write_failure();
      fail(what + " failed (" + reason + "); is the disk full or the folder not accessible?");
    });
    return result;
  }

  CheckpointFile(MPI_Comm c, std::filesystem::path p, bool create) : comm(c), path(std::move(p)) {
    hdf5::silence();
    forget_write_failure();
    const hdf5::Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    file = hdf5::Handle(on_all("opening",
                               [&] {
                                 return create ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)
                                               : H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
                               }),
                        H5Fclose);
    collective = hdf5::Handle(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    H5Pset_dxpl_mpio(collective, H5FD_MPIO_COLLECTIVE);
  }

  /// CRC-32 of the array of which each rank has a part, in rank order.
  std::int64_t checksum(const void* part, std::size_t bytes) const {
    return joined_crc32(comm, crc32_z(0, static_cast<const Bytef*>(part), bytes), static_cast<std::int64_t>(bytes));
  }

  /// Space in memory and in the file of a slab of rows.
  static std::pair<hdf5::Handle, hdf5::Handle> selection(hid_t space, Slab slab, hsize_t components) {
    const hsize_t start[2] = {slab.begin, 0}, count[2] = {slab.count, components};
    std::pair<hdf5::Handle, hdf5::Handle> spaces{hdf5::Handle(H5Screate_simple(2, count, nullptr), H5Sclose),
                                                 hdf5::Handle(H5Scopy(space), H5Sclose)};
    if (slab.count > 0)
      H5Sselect_hyperslab(spaces.second, H5S_SELECT_SET, start, nullptr, count, nullptr);
    else
      H5Sselect_none(spaces.second), H5Sselect_none(spaces.first);
    return spaces;
  }

  template <class T>
  hdf5::Handle write(const std::string& name, std::span<const T> values, Slab slab, hsize_t rows, int components) {
    const hsize_t shape[2] = {rows, static_cast<hsize_t>(components)};
    const hdf5::Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
    const hdf5::Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    hdf5::Handle dataset(
        on_all("writing " + name, [&] { return H5Dcreate2(file, name.c_str(), FileType<T>::file(), space, links, creation, H5P_DEFAULT); }),
        H5Dclose);
    const auto spaces = selection(space, slab, shape[1]);
    if (rows > 0)
      on_all("writing " + name,
             [&] { return H5Dwrite(dataset, FileType<T>::memory(), spaces.first, spaces.second, collective, values.data()); });
    const auto sum = checksum(values.data(), values.size_bytes());
    on_all("writing " + name, [&] { return hdf5::write_attribute(dataset, "crc32", sum); });
    return dataset;
  }

  /// Rows and components of a dataset.
  static std::pair<hsize_t, int> shape(hid_t dataset) {
    hsize_t extent[2] = {0, 0};
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose);
    if (H5Sget_simple_extent_ndims(space) == 2) H5Sget_simple_extent_dims(space, extent, nullptr);
    return {extent[0], static_cast<int>(extent[1])};
  }

  hdf5::Handle open(const std::string& name) const {
    return {on_all("reading " + name, [&] { return H5Dopen2(file, name.c_str(), H5P_DEFAULT); }), H5Dclose};
  }

  /// The slabs of all ranks must cover the dataset in rank order, so that its checksum can be verified.
  template <class T>
  std::vector<T> read(hid_t dataset, const std::string& name, Slab slab) const {
    const auto [rows, components] = shape(dataset);
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose);
    if (H5Tequal(type, FileType<T>::file()) <= 0) fail(name + " holds other numbers than are asked for (integers or floating point)");
    const auto spaces = selection(space, slab, components);
    std::vector<T> values(slab.count * components);
    if (rows > 0)
      on_all("reading " + name,
             [&] { return H5Dread(dataset, FileType<T>::memory(), spaces.first, spaces.second, collective, values.data()); });
    const auto written = hdf5::integer_attribute(dataset, "crc32");
    if (!written || checksum(values.data(), values.size() * sizeof(T)) != *written)
      fail(name + ": checksum mismatch, the file is damaged; remove it to resume from the other slot");
    return values;
  }

  /// A small array that is the same on every rank: rank 0 reads or writes all of it.
  Slab whole_on_first(hsize_t rows) const { return {0, rank_of(comm) == 0 ? rows : 0}; }
  template <class T>
  void write_shared(const std::string& name, std::span<const T> values) {
    std::int64_t rows = static_cast<std::int64_t>(values.size());
    MPI_Bcast(&rows, 1, MPI_INT64_T, 0, comm);
    const Slab slab = whole_on_first(rows);
    write<T>(name, values.first(slab.count), slab, rows, 1);
  }
  template <class T>
  std::vector<T> read_shared(const std::string& name) const {
    const hdf5::Handle dataset = open(name);
    const hsize_t rows = shape(dataset).first;
    auto values = read<T>(dataset, name, whole_on_first(rows));
    values.resize(rows);
    broadcast<T>(comm, values);
    return values;
  }
};

}  // namespace snag
