// Halo exchange on one PetscSF whose roots are the owned entries and whose leaves are the ghosts, in place.
#include "parallel/halo.hpp"

#include <petscsf.h>

#include <map>

#include "base/error.hpp"
#include "parallel/session.hpp"

namespace snag {
namespace {

/// MPI type of `components` doubles. One per number of components for the life of the process: PetscSF keeps its buffers per type.
MPI_Datatype row_type(int components) {
  static std::map<int, MPI_Datatype> types;
  if (components == 1) return MPI_DOUBLE;
  const auto [entry, is_first] = types.try_emplace(components, MPI_DATATYPE_NULL);
  if (is_first) {
    MPI_Type_contiguous(components, MPI_DOUBLE, &entry->second);
    MPI_Type_commit(&entry->second);
  }
  return entry->second;
}

}  // namespace

struct Halo::Plan {
  PetscSF sf = nullptr;
  std::size_t n_owned = 0, n_ghosts = 0;

  Plan() = default;
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan() {
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (!finalized) PetscSFDestroy(&sf);
  }

  void check_size(std::size_t size, int components) const {
    const std::size_t expected = (n_owned + n_ghosts) * static_cast<std::size_t>(components);
    if (size != expected)
      throw Error(ExitCode::invariant, "halo: a field of " + std::to_string(size) + " values was given, expected " +
                                           std::to_string(expected) + " (owned and ghost cells, " + std::to_string(components) +
                                           " components); size the field by n_all_cells()");
  }

  void to_ghosts(MPI_Datatype type, const void* owned, void* ghosts) const {
    check_petsc(PetscSFBcastBegin(sf, type, owned, ghosts, MPI_REPLACE), "PetscSFBcastBegin");
    check_petsc(PetscSFBcastEnd(sf, type, owned, ghosts, MPI_REPLACE), "PetscSFBcastEnd");
  }
};

Halo::Halo() = default;
Halo::~Halo() = default;
Halo::Halo(Halo&&) noexcept = default;
Halo& Halo::operator=(Halo&&) noexcept = default;

Halo::Halo(MPI_Comm comm, int n_owned, const std::vector<int>& owner_rank, const std::vector<int>& owner_index)
    : plan_(std::make_unique<Plan>()) {
  const std::size_t n_ghosts = owner_rank.size();
  plan_->n_owned = static_cast<std::size_t>(n_owned);
  plan_->n_ghosts = n_ghosts;
  std::vector<PetscSFNode> roots(n_ghosts);
  for (std::size_t g = 0; g < n_ghosts; ++g) roots[g] = {owner_rank[g], owner_index[g]};
  check_petsc(PetscSFCreate(comm, &plan_->sf), "PetscSFCreate");
  check_petsc(
      PetscSFSetGraph(plan_->sf, n_owned, static_cast<PetscInt>(n_ghosts), nullptr, PETSC_COPY_VALUES, roots.data(), PETSC_COPY_VALUES),
      "PetscSFSetGraph");
  check_petsc(PetscSFSetUp(plan_->sf), "PetscSFSetUp");
}

void Halo::exchange(std::span<double> field, int components) const {
  if (!plan_) return;
  plan_->check_size(field.size(), components);
  plan_->to_ghosts(row_type(components), field.data(), field.data() + plan_->n_owned * static_cast<std::size_t>(components));
}

void Halo::exchange(std::span<float> field) const {
  if (!plan_) return;
  plan_->check_size(field.size(), 1);
  plan_->to_ghosts(MPI_FLOAT, field.data(), field.data() + plan_->n_owned);
}

void Halo::exchange(std::span<std::int64_t> field) const {
  if (!plan_) return;
  plan_->check_size(field.size(), 1);
  plan_->to_ghosts(MPI_INT64_T, field.data(), field.data() + plan_->n_owned);
}

}  // namespace snag
