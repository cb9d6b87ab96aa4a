// Sums in double-double arithmetic: a term is the unevaluated sum high + low with |low| <= ulp(high)/2.
//
//   two_sum(a, b):  s = a + b,  e = (a - (s - v)) + (b - v),  v = s - a,   so that s + e = a + b exactly      (Knuth 1969)
//
// The rounding of a sum is then of the order 1e-32 of the largest partial sum: the order of terms and the number of ranks no longer show in
// a double. Only additions occur, so that a compiler that fuses products and sums changes nothing.
#include "parallel/sum.hpp"

#include "parallel/running_sum.hpp"

namespace snag {
namespace {

/// high + low normalised, |low| <= ulp(high)/2. Needs |a| >= |b|.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b, v = s - a;
  return {s, (a - (s - v)) + (b - v)};
}

inline DoubleDouble plus(const DoubleDouble& a, double b) {
  const DoubleDouble s = two_sum(a.high, b);
  return quick_two_sum(s.high, s.low + a.low);
}

inline DoubleDouble plus(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const DoubleDouble s = quick_two_sum(high.high, high.low + low.high);
  return quick_two_sum(s.high, s.low + low.low);
}

void add_arrays(void* in, void* in_out, int* length, MPI_Datatype*) {
  const auto* a = static_cast<const DoubleDouble*>(in);
  auto* b = static_cast<DoubleDouble*>(in_out);
  for (int i = 0; i < *length; ++i) b[i] = plus(b[i], a[i]);
}

/// MPI type and operation, made at the first use and kept until MPI ends.
struct Reduction {
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Op add = MPI_OP_NULL;
  Reduction() {
    MPI_Type_contiguous(2, MPI_DOUBLE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(add_arrays, /*commute=*/1, &add);
  }
};

void add_over_ranks(MPI_Comm comm, std::span<DoubleDouble> partial) {
  static const Reduction reduction;
  MPI_Allreduce(MPI_IN_PLACE, partial.data(), static_cast<int>(partial.size()), reduction.type, reduction.add, comm);
}

/// The value as a double; an infinite term makes it undefined (NaN), never finite.
double rounded(const DoubleDouble& a) { return a.high + a.low; }

}  // namespace

void RunningSum::add(double term) { partial_ = plus(partial_, term); }

std::vector<double> sums(MPI_Comm comm, std::span<const RunningSum> partial) {
  std::vector<DoubleDouble> all;
  for (const RunningSum& one : partial) all.push_back(one.partial_);
  add_over_ranks(comm, all);
  std::vector<double> values;
  for (const DoubleDouble& one : all) values.push_back(rounded(one));
  return values;
}

double sum(MPI_Comm comm, std::span<const double> terms) {
  DoubleDouble partial[1];
  for (const double term : terms) partial[0] = plus(partial[0], term);
  add_over_ranks(comm, partial);
  return rounded(partial[0]);
}

Vec3 sum(MPI_Comm comm, std::span<const Vec3> terms) {
  DoubleDouble partial[3];
  for (const Vec3& term : terms) {
    partial[0] = plus(partial[0], term.x);
    partial[1] = plus(partial[1], term.y);
    partial[2] = plus(partial[2], term.z);
  }
  add_over_ranks(comm, partial);
  return {rounded(partial[0]), rounded(partial[1]), rounded(partial[2])};
}

double sum(MPI_Comm comm, double term) { return sum(comm, std::span<const double>(&term, 1)); }

std::int64_t sum(MPI_Comm comm, std::int64_t term) {
  std::int64_t total = 0;
  MPI_Allreduce(&term, &total, 1, MPI_INT64_T, MPI_SUM, comm);
  return total;
}

double maximum(MPI_Comm comm, double value) {
  double result = value;
  MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_MAX, comm);
  return result;
}

double minimum(MPI_Comm comm, double value) {
  double result = value;
  MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_MIN, comm);
  return result;
}

}  // namespace snag
