#include "parallel/id_directory.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/error.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

using Numbers = RowsByRank<std::int64_t>;

std::vector<int> starts(const std::vector<int>& counts) {
  std::vector<int> result(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), result.begin(), 0);
  return result;
}

/// Rank that knows about an id; ids may be any number.
int directory_rank(std::int64_t id, int n_ranks) { return static_cast<int>(static_cast<std::uint64_t>(id) % n_ranks); }

/// The ids for each directory rank with their indices here, as pairs or (without indices) alone.
Numbers addressed(std::span<const std::int64_t> ids, int n_ranks, bool with_index, std::vector<int>* order = nullptr) {
  const int width = with_index ? 2 : 1;
  Numbers rows_by_rank;
  rows_by_rank.counts.assign(n_ranks, 0);
  for (const auto id : ids) rows_by_rank.counts[directory_rank(id, n_ranks)] += width;
  auto at = starts(rows_by_rank.counts);
  rows_by_rank.rows.resize(ids.size() * width);
  if (order) order->resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    int& place = at[directory_rank(ids[i], n_ranks)];
    if (order) (*order)[place / width] = static_cast<int>(i);
    rows_by_rank.rows[place] = ids[i];
    if (with_index) rows_by_rank.rows[place + 1] = static_cast<std::int64_t>(i);
    place += width;
  }
  return rows_by_rank;
}

struct Entry {
  std::int64_t id;
  int rank, index;
};

/// Entries of the ids this rank knows about, sorted by id. Throws if one occurs twice.
std::vector<Entry> directory(const Numbers& held, const std::string& what) {
  std::vector<Entry> entries;
  entries.reserve(held.rows.size() / 2);
  std::size_t at = 0;
  for (std::size_t rank = 0; rank < held.counts.size(); ++rank)
    for (const std::size_t end = at + held.counts[rank]; at < end; at += 2)
      entries.push_back({held.rows[at], static_cast<int>(rank), static_cast<int>(held.rows[at + 1])});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.id < b.id; });
  const auto twice = std::adjacent_find(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.id == b.id; });
  if (twice != entries.end())
    throw Error(ExitCode::io, what + ": id " + std::to_string(twice->id) + " occurs twice (ranks " + std::to_string(twice->rank) + " and " +
                                  std::to_string((twice + 1)->rank) + "), each row needs an id of its own");
  return entries;
}

}  // namespace

RowPlaces find_rows(MPI_Comm comm, std::span<const std::int64_t> held, std::span<const std::int64_t> wanted, const std::string& what) {
  const int n_ranks = size_of(comm);
  const Numbers known = exchanged(comm, addressed(held, n_ranks, true));
  std::vector<int> order;  // position in a question -> index in `wanted`
  const Numbers asked = exchanged(comm, addressed(wanted, n_ranks, false, &order));

  Numbers answer;
  on_all_ranks(comm, [&] {
    const auto entries = directory(known, what);
    answer.rows.reserve(2 * asked.rows.size());
    for (const auto id : asked.rows) {
      const auto found =
          std::lower_bound(entries.begin(), entries.end(), id, [](const Entry& entry, std::int64_t i) { return entry.id < i; });
      if (found == entries.end() || found->id != id)
        throw Error(ExitCode::io,
                    what + ": no row with id " + std::to_string(id) + "; was the checkpoint written by another case or mesh?");
      answer.rows.push_back(found->rank);
      answer.rows.push_back(found->index);
    }
  });
  for (const int count : asked.counts) answer.counts.push_back(2 * count);
  const Numbers places = exchanged(comm, answer);

  RowPlaces result{std::vector<int>(wanted.size()), std::vector<int>(wanted.size())};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    result.rank[order[i]] = static_cast<int>(places.rows[2 * i]);
    result.index[order[i]] = static_cast<int>(places.rows[2 * i + 1]);
  }
  return result;
}

}  // namespace snag
