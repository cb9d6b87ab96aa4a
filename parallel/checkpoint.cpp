// Layout of a slot:
//   /                 attributes case_sha256, ranks, time_step, time_s, date, version, sequence
//   /ids/K            [n] ids of a set of rows, rank by rank, and /ids/K_start [ranks + 1] where each rank's begin; sets that agree are
//                     stored once
//   /rows/NAME        [n][components], attribute ids = K
//   /shared/NAME      [n], /text/NAME [n] bytes: the same on every rank
//   trailer           behind the HDF5 data: length and CRC-32 of all bytes (checkpoint_trailer.hpp)
// Every array carries its CRC-32, too, from the memory of the ranks that wrote it to that of those that read it: an error on the way
// between memory and file is an error of the run, never a start state.
#include "parallel/checkpoint.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "base/date.hpp"
#include "base/error.hpp"
#include "base/version.hpp"
#include "parallel/checkpoint_file.hpp"
#include "parallel/checkpoint_slots.hpp"
#include "parallel/checkpoint_trailer.hpp"
#include "parallel/halo.hpp"
#include "parallel/id_directory.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

using hdf5::Handle;

}  // namespace

struct CheckpointWriter::File {
  CheckpointFile slot;
  std::vector<std::vector<std::int64_t>> id_sets;  // of this rank, those written so far

  /// Number of the set of these ids, written if it is not there yet.
  std::int64_t id_set(std::span<const std::int64_t> ids, Slab slab, const std::vector<std::int64_t>& start, const std::string& name) {
    std::vector<int> same(id_sets.size() + 1, 0);
    for (std::size_t k = 0; k < id_sets.size(); ++k) same[k] = std::equal(ids.begin(), ids.end(), id_sets[k].begin(), id_sets[k].end());
    MPI_Allreduce(MPI_IN_PLACE, same.data(), static_cast<int>(same.size()), MPI_INT, MPI_MIN, slot.comm);
    const auto known = std::find(same.begin(), same.end(), 1);
    if (known != same.end()) return known - same.begin();
    find_rows(slot.comm, ids, {}, slot.path.string() + ": " + name);  // throws if an id occurs twice: it could not be found again
    const auto number = std::to_string(id_sets.size());
    slot.write<std::int64_t>("/ids/" + number, ids, slab, start.back(), 1);
    slot.write_shared<std::int64_t>("/ids/" + number + "_start", start);
    id_sets.emplace_back(ids.begin(), ids.end());
    return static_cast<std::int64_t>(id_sets.size()) - 1;
  }

  template <class T>
  void rows(const std::string& name, std::span<const std::int64_t> ids, std::span<const T> values, int components) {
    on_all_ranks(slot.comm, [&] {
      if (components < 1 || values.size() != ids.size() * components)
        throw Error(ExitCode::io, "checkpoint " + name + ": " + std::to_string(values.size()) + " values for " +
                                      std::to_string(ids.size()) + " rows of " + std::to_string(components) +
                                      " components; give one row per id");
    });
    const auto count = static_cast<std::int64_t>(ids.size());
    std::vector<std::int64_t> start(size_of(slot.comm) + 1, 0);
    MPI_Allgather(&count, 1, MPI_INT64_T, &start[1], 1, MPI_INT64_T, slot.comm);
    std::partial_sum(start.begin(), start.end(), start.begin());
    const Slab slab{static_cast<hsize_t>(start[rank_of(slot.comm)]), ids.size()};
    const auto set = id_set(ids, slab, start, name);
    const Handle dataset = slot.write("/rows/" + name, values, slab, start.back(), components);
    slot.on_all("writing " + name, [&] { return hdf5::write_attribute(dataset, "ids", set); });
  }
};

CheckpointWriter::CheckpointWriter(MPI_Comm comm, const std::filesystem::path& folder, const CheckpointStamp& stamp) {
  on_all_ranks(comm, [&] {
    std::error_code failure;
    if (rank_of(comm) == 0) std::filesystem::create_directories(folder, failure);
    if (failure) throw Error(ExitCode::io, folder.string() + ": cannot be created (" + failure.message() + "); choose another --out");
  });
  const auto slots = checkpoint_slots(comm, folder);
  const int latest = newest(slots);
  const std::int64_t sequence = latest < 0 ? 0 : slots[latest].sequence + 1;
  file_.reset(new File{CheckpointFile(comm, slots[latest == 0 ? 1 : 0].file, true), {}});
  std::string now = date();  // attributes must be the same on all ranks
  MPI_Bcast(now.data(), static_cast<int>(now.size()), MPI_CHAR, 0, comm);
  const hid_t root = file_->slot.file;
  file_->slot.on_all("writing the stamp", [&] {
    using hdf5::write_attribute;
    return std::min({write_attribute(root, "case_sha256", stamp.case_sha256),
                     write_attribute(root, "ranks", static_cast<std::int64_t>(size_of(comm))),
                     write_attribute(root, "time_step", stamp.time_step), write_attribute(root, "time_s", stamp.time),
                     write_attribute(root, "sequence", sequence), write_attribute(root, "date", now),
                     write_attribute(root, "version", std::string(version_number) + " " + version_git)});
  });
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::rows(const std::string& name, std::span<const std::int64_t> ids, std::span<const double> values, int components) {
  file_->rows(name, ids, values, components);
}

void CheckpointWriter::rows(const std::string& name, std::span<const std::int64_t> ids, std::span<const std::int64_t> values,
                            int components) {
  file_->rows(name, ids, values, components);
}

void CheckpointWriter::shared(const std::string& name, std::span<const double> values) {
  file_->slot.write_shared("/shared/" + name, values);
}

void CheckpointWriter::shared(const std::string& name, std::span<const std::int64_t> values) {
  file_->slot.write_shared("/shared/" + name, values);
}

void CheckpointWriter::text(const std::string& name, const std::string& value) {
  file_->slot.write_shared("/text/" + name, std::span<const char>(value));
}

void CheckpointWriter::finish() {
  CheckpointFile& slot = file_->slot;
  slot.on_all("flushing", [&] { return H5Fflush(slot.file, H5F_SCOPE_GLOBAL); });
  slot.on_all("closing", [&] { return slot.file.reset(); });
  append_trailer(slot.comm, slot.path);
  file_.reset();
}

/// Ids of the rows that this rank reads from the file.
struct StoredIds {
  Slab slab;
  std::vector<std::int64_t> ids;
};

struct CheckpointReader::File {
  CheckpointFile slot;
  CheckpointStamp stamp;
  std::string fallback;
  std::set<std::string> names;  // "rows/flow/velocity"
  std::map<std::int64_t, StoredIds> id_sets;
  // way of the rows last redistributed: all fields of a mesh take the same
  std::int64_t route_set = -1;
  std::vector<std::int64_t> route_ids;
  Halo route;

  const std::string& known(const std::string& name) const {
    const auto found = names.find(name);
    if (found == names.end()) {
      std::string list;
      for (const auto& each : names) list += (list.empty() ? "" : ", ") + each;
      slot.fail("no array " + name + "; there are: " + list + "; was it written by another case or version?");
    }
    return *found;
  }

  std::pair<std::int64_t, const StoredIds&> stored(hid_t dataset, const std::string& name) {
    const auto set = hdf5::integer_attribute(dataset, "ids");
    if (!set) slot.fail(name + " has no ids, the file is damaged; remove it to resume from the other slot");
    if (!id_sets.contains(*set)) {
      const auto path = "/ids/" + std::to_string(*set);
      const Handle ids = slot.open(path);
      const auto n_rows = CheckpointFile::shape(ids).first;
      const hsize_t rank = rank_of(slot.comm), size = size_of(slot.comm);
      hsize_t begin = n_rows * rank / size, end = n_rows * (rank + 1) / size;
      if (stamp.ranks == static_cast<int>(size)) {
        const auto start = slot.read_shared<std::int64_t>(path + "_start");
        begin = start.at(rank), end = start.at(rank + 1);
      }
      StoredIds part{{begin, end - begin}, {}};
      part.ids = slot.read<std::int64_t>(ids, path, part.slab);
      id_sets.emplace(*set, std::move(part));
    }
    return {*set, id_sets.at(*set)};
  }

  template <class T>
  std::vector<T> rows(const std::string& name, std::span<const std::int64_t> ids, int components) {
    const Handle dataset = slot.open("/" + known("rows/" + name));
    const int in_file = CheckpointFile::shape(dataset).second;
    if (in_file != components)
      slot.fail(name + " has " + std::to_string(in_file) + " components, " + std::to_string(components) +
                " are asked for; was it written by another version?");
    const auto [set, part] = stored(dataset, name);
    auto values = slot.read<T>(dataset, name, part.slab);
    int in_place = std::equal(ids.begin(), ids.end(), part.ids.begin(), part.ids.end());
    MPI_Allreduce(MPI_IN_PLACE, &in_place, 1, MPI_INT, MPI_MIN, slot.comm);
    if (in_place) return values;
    find_route(set, part, ids, name);
    return sent(values, part.ids.size(), ids.size(), components);
  }

  void find_route(std::int64_t set, const StoredIds& part, std::span<const std::int64_t> ids, const std::string& name) {
    int is_known = set == route_set && std::equal(ids.begin(), ids.end(), route_ids.begin(), route_ids.end());
    MPI_Allreduce(MPI_IN_PLACE, &is_known, 1, MPI_INT, MPI_MIN, slot.comm);
    if (is_known) return;
    const auto places = find_rows(slot.comm, part.ids, ids, slot.path.string() + ": " + name);
    route = Halo(slot.comm, static_cast<int>(part.ids.size()), places.rank, places.index);
    route_set = set;
    route_ids.assign(ids.begin(), ids.end());
  }

  /// Values of rows as read -> values of the rows asked for. To a halo the rows read are owned, those asked for are ghosts.
  std::vector<double> sent(std::vector<double>& values, std::size_t n_read, std::size_t n_asked, int components) const {
    values.resize((n_read + n_asked) * components);
    route.exchange(values, components);
    return {values.begin() + static_cast<std::ptrdiff_t>(n_read * components), values.end()};
  }
  std::vector<std::int64_t> sent(const std::vector<std::int64_t>& values, std::size_t n_read, std::size_t n_asked, int components) const {
    std::vector<std::int64_t> result(n_asked * components), one(n_read + n_asked);
    for (int c = 0; c < components; ++c) {
      for (std::size_t i = 0; i < n_read; ++i) one[i] = values[i * components + c];
      route.exchange(std::span(one));
      for (std::size_t i = 0; i < n_asked; ++i) result[i * components + c] = one[n_read + i];
    }
    return result;
  }
};

CheckpointReader::CheckpointReader(MPI_Comm comm, const std::filesystem::path& folder) {
  const auto slots = checkpoint_slots(comm, folder);
  const int latest = newest(slots);
  if (latest < 0)
    throw Error(ExitCode::io,
                folder.string() + ": no valid checkpoint (" + states(slots) + "), a resume needs one; check --out or run without --resume");
  file_.reset(new File{CheckpointFile(comm, slots[latest].file, false), slots[latest].stamp, fallback_of(slots), {}, {}, -1, {}, {}});
  const auto add_name = [](hid_t, const char* name, const H5O_info_t* object, void* names) -> herr_t {
    if (object->type == H5O_TYPE_DATASET) static_cast<std::set<std::string>*>(names)->insert(name);
    return 0;
  };
  file_->slot.on_all("listing",
                     [&] { return H5Ovisit2(file_->slot.file, H5_INDEX_NAME, H5_ITER_NATIVE, add_name, &file_->names, H5O_INFO_BASIC); });
}

CheckpointReader::~CheckpointReader() = default;

const CheckpointStamp& CheckpointReader::stamp() const { return file_->stamp; }

const std::string& CheckpointReader::fallback() const { return file_->fallback; }

bool CheckpointReader::has(const std::string& name) const {
  return file_->names.contains("rows/" + name) || file_->names.contains("shared/" + name) || file_->names.contains("text/" + name);
}

std::vector<double> CheckpointReader::rows(const std::string& name, std::span<const std::int64_t> ids, int components) {
  return file_->rows<double>(name, ids, components);
}

std::vector<std::int64_t> CheckpointReader::integer_rows(const std::string& name, std::span<const std::int64_t> ids, int components) {
  return file_->rows<std::int64_t>(name, ids, components);
}

std::vector<std::int64_t> CheckpointReader::ids(const std::string& name) {
  const Handle dataset = file_->slot.open("/" + file_->known("rows/" + name));
  return file_->stored(dataset, name).second.ids;
}

std::vector<double> CheckpointReader::shared(const std::string& name) {
  return file_->slot.read_shared<double>("/" + file_->known("shared/" + name));
}

std::vector<std::int64_t> CheckpointReader::shared_integers(const std::string& name) {
  return file_->slot.read_shared<std::int64_t>("/" + file_->known("shared/" + name));
}

std::string CheckpointReader::text(const std::string& name) {
  const auto value = file_->slot.read_shared<char>("/" + file_->known("text/" + name));
  return {value.begin(), value.end()};
}

}  // namespace snag
