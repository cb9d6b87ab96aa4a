// Periodic joins: a face of the first patch and the face of the second whose centre lies one translation further become one interior face,
//
//   |x_f + T - x_f'| <= 1e-6 sqrt(|S|).
//
// All faces of periodic patches are gathered on every rank (some 200 bytes each), so that every rank finds the same pairs. As for other
// faces the owner is the cell of the lower cell_id; nodes and geometry are those of the owner's side, and `shift` takes the neighbour's
// centre to that side.
#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/geometry.hpp"
#include "mesh/import/connectivity.hpp"
#include "mesh/point_tree.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

constexpr double tolerance = 1e-6;  // distance of centres over the size of the face, the root of its area

/// A face of a periodic patch as other ranks see it.
struct Record {
  int pair, side;        // side 0: first, 1: second patch of the pair
  int rank, cell, face;  // place on its rank: cell of MeshParts, index into the faces
  int zone, n_nodes;
  std::int64_t cell_id;
  std::array<std::int64_t, 4> node_id;
  std::array<Vec3, 4> node;
  Vec3 centre;
  double size;
};

int patch_named(const MeshParts& parts, const std::string& name) {
  const auto found = std::find(parts.patches.begin(), parts.patches.end(), name);
  if (found != parts.patches.end()) return static_cast<int>(found - parts.patches.begin());
  throw Error(ExitCode::mesh,
              parts.source + ": periodic patch \"" + name + "\" is not in the mesh; its patches are " + joined(parts.patches));
}

Record record_of(const MeshParts& parts, const LocalFace& face, int index) {
  Record record{};
  record.rank = rank_of(parts.comm), record.cell = face.owner, record.face = index;
  record.zone = parts.zone[face.owner], record.cell_id = parts.cell_id[face.owner];
  record.n_nodes = face.n_nodes;
  for (int i = 0; i < face.n_nodes; ++i) record.node[i] = parts.node[face.node[i]], record.node_id[i] = parts.node_id[face.node[i]];
  const auto geometry = face_geometry({record.node.data(), static_cast<std::size_t>(face.n_nodes)});
  record.centre = geometry.centre;
  record.size = std::sqrt(norm(geometry.vector));
  return record;
}

/// The records of all ranks, sorted by pair, side and cell: the same array everywhere.
std::vector<Record> sorted_records(const MeshParts& parts, const std::vector<LocalFace>& faces) {
  std::map<int, std::pair<int, int>> place_of_patch;  // patch -> pair, side
  for (int p = 0; p < static_cast<int>(parts.periodic.size()); ++p) {
    place_of_patch[patch_named(parts, parts.periodic[p].first)] = {p, 0};
    place_of_patch[patch_named(parts, parts.periodic[p].second)] = {p, 1};
  }
  std::vector<Record> mine;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const auto found = place_of_patch.find(faces[f].patch);
    if (faces[f].patch < 0 || found == place_of_patch.end()) continue;
    mine.push_back(record_of(parts, faces[f], f));
    std::tie(mine.back().pair, mine.back().side) = found->second;
  }
  std::vector<Record> all = gathered(parts.comm, mine);
  std::sort(all.begin(), all.end(), [](const Record& a, const Record& b) {
    return std::tie(a.pair, a.side, a.cell_id, a.node_id) < std::tie(b.pair, b.side, b.cell_id, b.node_id);
  });
  return all;
}

[[noreturn]] void throw_unmatched(const MeshParts& parts, const Record& record, const std::string& reason) {
  const PeriodicPair& pair = parts.periodic[record.pair];
  throw Error(ExitCode::mesh, parts.source + ": the face at " + point_text(record.centre) + " of periodic patch \"" +
                                  (record.side == 0 ? pair.first : pair.second) + "\" " + reason + " on \"" +
                                  (record.side == 0 ? pair.second : pair.first) +
                                  "\", faces must coincide within 1e-6 of their size after the translation " +
                                  point_text(pair.translation) +
                                  "; mesh the second patch as a copy of the first (gmsh: Periodic Surface) and check the translation; "
                                  "patches that a rotation joins are not supported: mesh the whole machine");
}

/// Partner among `second` of every record of `first`.
std::vector<int> partners(const MeshParts& parts, std::span<const Record> first, std::span<const Record> second) {
  if (first.size() != second.size())
    throw_unmatched(parts, first.empty() ? second[0] : first[0],
                    "and " + std::to_string(first.size()) + " and " + std::to_string(second.size()) + " faces in all find no equal number");
  std::vector<int> partner(first.size());
  std::vector<char> is_taken(second.size(), 0);
  if (first.empty()) return partner;
  std::vector<Vec3> centres;
  for (const Record& record : second) centres.push_back(record.centre);
  const PointTree tree(centres);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Vec3 target = first[i].centre + parts.periodic[first[i].pair].translation;
    unsigned nearest = 0;
    double distance_squared = 0;
    tree->knnSearch(&target.x, 1, &nearest, &distance_squared);
    if (std::sqrt(distance_squared) > tolerance * first[i].size)
      throw_unmatched(parts, first[i], "has no partner (the nearest is " + number_text(std::sqrt(distance_squared)) + " m off)");
    if (is_taken[nearest]++) throw_unmatched(parts, first[i], "shares its partner with another face");
    partner[i] = static_cast<int>(nearest);
  }
  return partner;
}

/// Finds or makes local numbers of ghosts and nodes that a join brings to this rank.
class Adopter {
 public:
  explicit Adopter(MeshParts& parts) : parts_(parts), n_cells_before_(static_cast<int>(parts.cell_id.size())) {
    for (int g = 0; g < n_cells_before_ - parts.n_owned; ++g) cell_[{parts.ghost_rank[g], parts.ghost_index[g]}] = parts.n_owned + g;
    for (int i = 0; i < static_cast<int>(parts.node_id.size()); ++i) node_[parts.node_id[i]] = i;
  }
  int cell(const Record& record) {
    if (record.rank == rank_of(parts_.comm)) return record.cell;
    const auto [entry, is_first] = cell_.try_emplace({record.rank, record.cell}, static_cast<int>(parts_.cell_id.size()));
    if (is_first) {
      parts_.cell_id.push_back(record.cell_id), parts_.zone.push_back(record.zone);
      parts_.ghost_rank.push_back(record.rank), parts_.ghost_index.push_back(record.cell);
    }
    return entry->second;
  }
  int node(std::int64_t id, const Vec3& position) {
    const auto [entry, is_first] = node_.try_emplace(id, static_cast<int>(parts_.node_id.size()));
    if (is_first) parts_.node_id.push_back(id), parts_.node.push_back(position);
    return entry->second;
  }

 private:
  MeshParts& parts_;
  int n_cells_before_;
  std::map<std::pair<int, int>, int> cell_;
  std::map<std::int64_t, int> node_;
};

/// The interior face made of two sides, a on the first and b on the second patch.
LocalFace joined(const Record& a, const Record& b, const Vec3& translation, Adopter& adopter) {
  const bool first_owns = a.cell_id <= b.cell_id;
  const Record &owner = first_owns ? a : b, &neighbour = first_owns ? b : a;
  LocalFace face;
  face.owner = adopter.cell(owner), face.neighbour = adopter.cell(neighbour);
  face.shift = first_owns ? -translation : translation;
  face.n_nodes = owner.n_nodes;
  for (int i = 0; i < owner.n_nodes; ++i) face.node[i] = adopter.node(owner.node_id[i], owner.node[i]);
  return face;
}

}  // namespace

void join_periodic(MeshParts& parts, std::vector<LocalFace>& faces) {
  if (parts.periodic.empty()) return;
  const std::vector<Record> all = sorted_records(parts, faces);
  const int me = rank_of(parts.comm);
  Adopter adopter(parts);
  std::vector<char> is_joined(faces.size(), 0);
  std::vector<LocalFace> extra;
  for (int p = 0; p < static_cast<int>(parts.periodic.size()); ++p) {
    const auto side = [&](int s) {
      const auto before = [](const Record& r, const std::pair<int, int>& key) { return std::pair(r.pair, r.side) < key; };
      const auto begin = std::lower_bound(all.begin(), all.end(), std::pair(p, s), before);
      return std::span<const Record>(begin, std::lower_bound(begin, all.end(), std::pair(p, s + 1), before));
    };
    const auto first = side(0), second = side(1);
    const auto partner = partners(parts, first, second);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const Record &a = first[i], &b = second[partner[i]];
      if (a.rank != me && b.rank != me) continue;
      extra.push_back(joined(a, b, parts.periodic[p].translation, adopter));
      for (const Record* r : {&a, &b})
        if (r->rank == me) is_joined[r->face] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (!is_joined[f]) faces[kept++] = faces[f];
  faces.resize(kept);
  faces.insert(faces.end(), extra.begin(), extra.end());
}

}  // namespace snag
