// mesh file -> cells on rank 0 -> DMPlex -> PTScotch -> one layer of ghosts across faces -> MeshParts -> Mesh. The DMPlex lives only here
// and in mesh/import/plex.hpp.
#include "mesh/import/import.hpp"

#include <petscdmplex.h>
#include <petscsf.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/words.hpp"
#include "mesh/geometry.hpp"
#include "mesh/import/connectivity.hpp"
#include "mesh/import/mesh_reader.hpp"
#include "mesh/import/partition.hpp"
#include "mesh/import/parts.hpp"
#include "mesh/import/plex.hpp"
#include "mesh/shapes.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

/// Closes a DM when it goes out of scope.
struct Plex {
  DM dm = nullptr;
  PetscSF migration = nullptr;  // from rank 0's points to the local ones; none on a single rank
  ~Plex() {
    PetscSFDestroy(&migration);
    DMDestroy(&dm);
  }
};

/// Points of a stratum.
struct Range {
  PetscInt begin = 0, end = 0;
  bool holds(PetscInt point) const { return point >= begin && point < end; }
};
Range cells_of(DM dm) {
  Range range;
  check_petsc(DMPlexGetHeightStratum(dm, 0, &range.begin, &range.end), "DMPlexGetHeightStratum");
  return range;
}
Range vertices_of(DM dm) {
  Range range;
  check_petsc(DMPlexGetDepthStratum(dm, 0, &range.begin, &range.end), "DMPlexGetDepthStratum");
  return range;
}

/// A list of words, from rank 0 to all.
std::vector<std::string> shared_words(MPI_Comm comm, const std::vector<std::string>& words) {
  std::string packed;
  for (const std::string& word : words) packed.append(word).append("\n");
  auto length = static_cast<int>(packed.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  packed.resize(static_cast<std::size_t>(length));
  MPI_Bcast(packed.data(), length, MPI_CHAR, 0, comm);
  std::vector<std::string> result = split(packed, '\n');
  result.pop_back();
  return result;
}

/// Rank of every cell of the file, by the graph of cells that share a face; all cells are on rank 0. Collective; empty on the other ranks.
std::vector<int> fresh_partition(MPI_Comm comm, const Plex& plex, const std::vector<PetscInt>& number) {
  PetscInt n = 0, *offset = nullptr, *neighbour = nullptr;
  check_petsc(DMPlexCreatePartitionerGraph(plex.dm, 0, &n, &offset, &neighbour, nullptr), "DMPlexCreatePartitionerGraph");
  std::vector<int> rank_of_cell(number.size());
  on_all_ranks(comm, [&] {
    if (n == 0) return;
    const std::vector<int> part = partition_graph({offset, offset + n + 1}, {neighbour, neighbour + offset[n]}, size_of(comm));
    for (std::size_t c = 0; c < number.size(); ++c) rank_of_cell[number[c]] = part[c];
  });
  PetscFree(offset);
  PetscFree(neighbour);
  return rank_of_cell;
}

/// Cells go to the ranks that `rank_of_cell` names, by their number in the file.
void prescribe_partition(PetscPartitioner partitioner, const std::vector<int>& rank_of_cell, const std::vector<PetscInt>& number,
                         int size) {
  std::vector<PetscInt> count(static_cast<std::size_t>(size), 0), points(number.size());
  for (const PetscInt cell : number) ++count[rank_of_cell[cell]];
  std::vector<PetscInt> next(static_cast<std::size_t>(size), 0);
  for (int r = 1; r < size; ++r) next[r] = next[r - 1] + count[r - 1];
  for (std::size_t c = 0; c < number.size(); ++c) points[next[rank_of_cell[number[c]]]++] = static_cast<PetscInt>(c);
  check_petsc(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSHELL), "PetscPartitionerSetType");
  check_petsc(PetscPartitionerShellSetPartition(partitioner, size, count.data(), points.data()), "PetscPartitionerShellSetPartition");
}

/// Spread over the ranks; `number`: file numbers of rank 0's cells.
void distribute(MPI_Comm comm, Plex& plex, const ImportOptions& options, const std::vector<PetscInt>& number) {
  check_petsc(DMSetBasicAdjacency(plex.dm, PETSC_TRUE, PETSC_FALSE), "DMSetBasicAdjacency");
  PetscPartitioner partitioner = nullptr;
  check_petsc(DMPlexGetPartitioner(plex.dm, &partitioner), "DMPlexGetPartitioner");
  prescribe_partition(partitioner, options.partition ? *options.partition : fresh_partition(comm, plex, number), number, size_of(comm));
  DM spread = nullptr;
  check_petsc(DMPlexDistribute(plex.dm, 1, &plex.migration, &spread), "DMPlexDistribute");
  if (!spread) return;
  DMDestroy(&plex.dm);
  plex.dm = spread;
}

/// For every local point the number it has in the file: of cells and of vertices.
std::vector<PetscInt> origins(const Plex& plex, const Range& cells_at_origin, const Range& vertices_at_origin,
                              const std::vector<PetscInt>& number) {
  PetscInt begin = 0, end = 0;
  check_petsc(DMPlexGetChart(plex.dm, &begin, &end), "DMPlexGetChart");
  std::vector<PetscInt> root(static_cast<std::size_t>(std::max(vertices_at_origin.end, cells_at_origin.end)), -1);
  for (PetscInt c = cells_at_origin.begin; c < cells_at_origin.end; ++c) root[c] = number[c - cells_at_origin.begin];
  for (PetscInt v = vertices_at_origin.begin; v < vertices_at_origin.end; ++v) root[v] = v - vertices_at_origin.begin;
  if (!plex.migration) {
    root.resize(static_cast<std::size_t>(end), -1);
    return root;
  }
  PetscInt n_roots = 0;
  check_petsc(PetscSFGetGraph(plex.migration, &n_roots, nullptr, nullptr, nullptr), "PetscSFGetGraph");
  root.resize(static_cast<std::size_t>(std::max<PetscInt>(n_roots, 0)), -1);
  std::vector<PetscInt> leaf(static_cast<std::size_t>(end), -1);
  check_petsc(PetscSFBcastBegin(plex.migration, MPIU_INT, root.data(), leaf.data(), MPI_REPLACE), "PetscSFBcastBegin");
  check_petsc(PetscSFBcastEnd(plex.migration, MPIU_INT, root.data(), leaf.data(), MPI_REPLACE), "PetscSFBcastEnd");
  return leaf;
}

/// Nodes of a cell, by their numbers in the file, in VTK's order; -1 behind the last.
using CellNodes = std::array<PetscInt, 8>;

std::vector<CellNodes> nodes_of_cells(const MeshParts& whole, const std::vector<PetscInt>& number) {
  std::vector<CellNodes> nodes(number.size());
  for (std::size_t c = 0; c < number.size(); ++c) {
    nodes[c].fill(-1);
    std::ranges::copy(row(whole.cell_start, whole.cell_node, static_cast<int>(number[c])), nodes[c].begin());
  }
  return nodes;
}

/// Of the local cells, from those at the origin.
std::vector<CellNodes> spread_nodes(const Plex& plex, const std::vector<CellNodes>& at_origin) {
  if (!plex.migration) return at_origin;
  std::vector<PetscInt> cell(at_origin.size());
  std::iota(cell.begin(), cell.end(), 0);
  PetscSF of_cells = nullptr;
  check_petsc(PetscSFCreateEmbeddedRootSF(plex.migration, static_cast<PetscInt>(cell.size()), cell.data(), &of_cells),
              "PetscSFCreateEmbeddedRootSF");
  MPI_Datatype nodes = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(std::tuple_size_v<CellNodes>, MPIU_INT, &nodes);
  MPI_Type_commit(&nodes);
  std::vector<CellNodes> local(static_cast<std::size_t>(cells_of(plex.dm).end));
  check_petsc(PetscSFBcastBegin(of_cells, nodes, at_origin.data(), local.data(), MPI_REPLACE), "PetscSFBcastBegin");
  check_petsc(PetscSFBcastEnd(of_cells, nodes, at_origin.data(), local.data(), MPI_REPLACE), "PetscSFBcastEnd");
  MPI_Type_free(&nodes);
  PetscSFDestroy(&of_cells);
  return local;
}

void take_nodes(const Plex& plex, const std::vector<PetscInt>& origin, MeshParts& parts) {
  Vec coordinates = nullptr;
  PetscSection section = nullptr;
  const PetscScalar* x = nullptr;
  check_petsc(DMGetCoordinatesLocal(plex.dm, &coordinates), "DMGetCoordinatesLocal");
  check_petsc(DMGetCoordinateSection(plex.dm, &section), "DMGetCoordinateSection");
  check_petsc(VecGetArrayRead(coordinates, &x), "VecGetArrayRead");
  const Range vertices = vertices_of(plex.dm);
  for (PetscInt v = vertices.begin; v < vertices.end; ++v) {
    PetscInt offset = 0;
    PetscSectionGetOffset(section, v, &offset);
    parts.node.push_back({x[offset], x[offset + 1], x[offset + 2]});
    parts.node_id.push_back(origin[v]);
  }
  VecRestoreArrayRead(coordinates, &x);
}

/// Local number of a node, by its number in the file; -1 where it is not local.
std::vector<int> local_nodes(const std::vector<std::int64_t>& node_id) {
  std::vector<int> local(node_id.empty() ? 0 : static_cast<std::size_t>(std::ranges::max(node_id)) + 1, -1);
  for (std::size_t i = 0; i < node_id.size(); ++i) local[static_cast<std::size_t>(node_id[i])] = static_cast<int>(i);
  return local;
}

void take_cell(const CellNodes& in_file, const std::vector<int>& local, MeshParts& parts) {
  const auto n = static_cast<int>(std::ranges::find(in_file, -1) - in_file.begin());
  CellShape shape = CellShape::hexahedron;
  for (const CellShape candidate : {CellShape::tetrahedron, CellShape::pyramid, CellShape::prism})
    if (n == n_nodes_of(candidate)) shape = candidate;
  std::array<int, 8> node{};
  for (int i = 0; i < n; ++i) node[i] = local[in_file[i]];
  add_cell(parts, shape, node.data(), n);
}

/// Cells, owned first: what the point SF does not name as a copy is owned.
void take_cells(const Plex& plex, const std::vector<PetscInt>& origin, const std::vector<CellNodes>& nodes, MeshParts& parts) {
  const Range cells = cells_of(plex.dm);
  PetscSF shared = nullptr;
  PetscInt n_roots = 0, n_leaves = 0, chart_end = 0;
  const PetscInt* leaf = nullptr;
  const PetscSFNode* root = nullptr;
  check_petsc(DMGetPointSF(plex.dm, &shared), "DMGetPointSF");
  check_petsc(PetscSFGetGraph(shared, &n_roots, &n_leaves, &leaf, &root), "PetscSFGetGraph");
  check_petsc(DMPlexGetChart(plex.dm, nullptr, &chart_end), "DMPlexGetChart");
  std::vector<int> rank(static_cast<std::size_t>(chart_end), -1);
  for (PetscInt i = 0; i < n_leaves; ++i) rank[leaf ? leaf[i] : i] = static_cast<int>(root[i].rank);

  std::vector<PetscInt> position(static_cast<std::size_t>(chart_end), -1);
  DMLabel zones = nullptr;
  check_petsc(DMGetLabel(plex.dm, zone_label, &zones), "DMGetLabel");
  const std::vector<int> local = local_nodes(parts.node_id);
  for (const bool ghosts : {false, true}) {
    for (PetscInt c = cells.begin; c < cells.end; ++c) {
      if ((rank[c] >= 0) != ghosts) continue;
      if (!ghosts) position[c] = static_cast<PetscInt>(parts.cell_id.size());
      take_cell(nodes[c], local, parts);
      parts.cell_id.push_back(origin[c]);
      PetscInt zone = -1;
      if (zones) DMLabelGetValue(zones, c, &zone);
      parts.zone.push_back(static_cast<int>(zone));
      if (ghosts) parts.ghost_rank.push_back(rank[c]), parts.ghost_index.push_back(static_cast<int>(c));
    }
    if (!ghosts) parts.n_owned = static_cast<int>(parts.cell_id.size());
  }
  if (n_roots < 0) return;  // a single rank
  std::vector<PetscInt> at_owner(position);
  check_petsc(PetscSFBcastBegin(shared, MPIU_INT, position.data(), at_owner.data(), MPI_REPLACE), "PetscSFBcastBegin");
  check_petsc(PetscSFBcastEnd(shared, MPIU_INT, position.data(), at_owner.data(), MPI_REPLACE), "PetscSFBcastEnd");
  for (int& index : parts.ghost_index) index = static_cast<int>(at_owner[index]);
}

void take_boundary(const Plex& plex, MeshParts& parts) {
  DMLabel label = nullptr;
  check_petsc(DMGetLabel(plex.dm, patch_label, &label), "DMGetLabel");
  if (!label) return;
  const Range vertices = vertices_of(plex.dm);
  for (int patch = 0; patch < static_cast<int>(parts.patches.size()); ++patch) {
    IS stratum = nullptr;
    PetscInt n_faces = 0;
    const PetscInt* faces = nullptr;
    check_petsc(DMLabelGetStratumIS(label, patch, &stratum), "DMLabelGetStratumIS");
    if (!stratum) continue;
    ISGetLocalSize(stratum, &n_faces), ISGetIndices(stratum, &faces);
    for (PetscInt i = 0; i < n_faces; ++i) {
      PetscInt n = 0;
      const PetscInt* vertex = nullptr;
      check_petsc(DMPlexGetConeSize(plex.dm, faces[i], &n), "DMPlexGetConeSize");
      check_petsc(DMPlexGetCone(plex.dm, faces[i], &vertex), "DMPlexGetCone");
      std::array<int, 4> node{};
      for (PetscInt k = 0; k < n; ++k) node[k] = vertex[k] - vertices.begin;
      add_boundary_face(parts, patch, node.data(), n);
    }
    ISRestoreIndices(stratum, &faces), ISDestroy(&stratum);
  }
}

void require_zones(const MeshParts& parts) {
  on_all_ranks(parts.comm, [&] {
    const auto unnamed = std::count(parts.zone.begin(), parts.zone.begin() + parts.n_owned, -1);
    if (unnamed > 0)
      throw Error(ExitCode::mesh,
                  parts.source + ": at least " + std::to_string(unnamed) +
                      " cells belong to no named volume; give every volume a name (gmsh: Physical Volume(\"fluid\") = {...})");
  });
}

void require_partition(const std::vector<int>& partition, std::int64_t n_cells, int size, const std::string& source) {
  const bool fits = static_cast<std::int64_t>(partition.size()) == n_cells &&
                    std::all_of(partition.begin(), partition.end(), [size](int rank) { return rank >= 0 && rank < size; });
  if (!fits)
    throw Error(ExitCode::mesh, source + ": has " + std::to_string(n_cells) + " cells on " + std::to_string(size) +
                                    " ranks, but the partition that is to be used again is that of " + std::to_string(partition.size()) +
                                    " cells or of other ranks; resume with the mesh of the earlier run, or begin again with --overwrite");
}

/// The whole mesh and its `faces` on rank 0, empty elsewhere but for the names.
MeshParts read(const std::filesystem::path& file, MPI_Comm comm, const ImportOptions& options, std::vector<LocalFace>& faces) {
  MeshParts whole;
  on_all_ranks(comm, [&] {
    if (rank_of(comm) != 0) return;
    whole = mesh_reader_of(file)->read(file, options.scale);
    faces = fitting_faces(whole);
    if (options.partition) require_partition(*options.partition, whole.n_owned, size_of(comm), file.string());
  });
  whole.zones = shared_words(comm, whole.zones), whole.patches = shared_words(comm, whole.patches);
  return whole;
}

}  // namespace

Mesh import_mesh(const std::filesystem::path& file, MPI_Comm comm, const ImportOptions& options) {
  MeshParts parts;
  parts.comm = comm;
  parts.source = file.string();
  parts.periodic = options.periodic;
  {
    Plex plex;
    std::vector<PetscInt> number;
    std::vector<CellNodes> nodes;
    {
      std::vector<LocalFace> faces;
      const MeshParts whole = read(file, comm, options, faces);
      parts.zones = whole.zones, parts.patches = whole.patches;
      number = plex_order(whole);
      plex.dm = plex_of(whole, faces, number, comm);
      nodes = nodes_of_cells(whole, number);
    }
    const Range cells = cells_of(plex.dm), vertices = vertices_of(plex.dm);
    distribute(comm, plex, options, number);
    const std::vector<PetscInt> origin = origins(plex, cells, vertices, number);
    take_nodes(plex, origin, parts);
    take_cells(plex, origin, spread_nodes(plex, nodes), parts);
    take_boundary(plex, parts);
  }
  require_zones(parts);
  Mesh mesh = build_mesh(std::move(parts));
  return_free_memory();
  return mesh;
}

std::vector<int> partition_of(const Mesh& mesh) {
  std::vector<int> rank(static_cast<std::size_t>(mesh.n_cells_global), -1);
  for (int c = 0; c < mesh.n_cells; ++c) rank[mesh.cell_id[c]] = rank_of(mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, rank.data(), static_cast<int>(rank.size()), MPI_INT, MPI_MAX, mesh.comm);
  return rank;
}

}  // namespace snag
