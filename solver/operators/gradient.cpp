// Least-squares and Gauss gradients; the equations stand in the header.
#include "solver/operators/gradient.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/flat.hpp"
#include "mesh/geometry.hpp"
#include "parallel/sum.hpp"
#include "solver/fields/face.hpp"

namespace snag {

namespace {

// Eigenvalues of M below this leave a direction open: each face adds 1 to the trace, a regular tetrahedron has 4/3 in every direction.
constexpr double open_eigenvalue = 0.05;

inline void add_product(Vec3& g, double a, const Vec3& e) { g += a * e; }
/// The first eight of the nine numbers in one instruction: a compiler adds them one by one.
inline void add_product(Mat3& g, const Vec3& a, const Vec3& e) {
  using Eight = double __attribute__((vector_size(8 * sizeof(double))));
  const Eight of_a{a.x, a.y, a.z}, of_e{e.x, e.y, e.z};
  const Eight a_in_places = __builtin_shufflevector(of_a, of_a, 0, 0, 0, 1, 1, 1, 2, 2);
  const Eight e_in_places = __builtin_shufflevector(of_e, of_e, 0, 1, 2, 0, 1, 2, 0, 1);
  void* const place = g.data();
  Eight most;
  std::memcpy(&most, place, sizeof most);
  most += a_in_places * e_in_places;
  std::memcpy(place, &most, sizeof most);
  g[2].z += a.z * e.z;
}

// Normal derivative times distance at a mirror: (u - u_w).n goes to zero at the face.
inline double mirrored(double, double, const Vec3&) { return 0; }
inline double normal_slope(double given) { return given; }
inline Vec3 normal_slope(const Vec3&) { return {}; }
inline Vec3 mirrored(const Vec3& u, const Vec3& of_wall, const Vec3& n) { return dot(of_wall - u, n) * n; }

template <class Gradient>
void exchange(const Mesh& mesh, std::vector<Gradient>& g) {
  mesh.halo.exchange(flat(g), static_cast<int>(sizeof(Gradient) / sizeof(double)));
}

inline Vec3 product(const Mat3& m, const Vec3& g) { return m * g; }
inline Mat3 product(const Mat3& m, const Mat3& g) { return {m * g[0], m * g[1], m * g[2]}; }
template <class Gradient>
Gradient product(const SymmetricTensor& m, const Gradient& g) {
  return product(Mat3{Vec3{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}, g);
}
/// m += a v v
inline void add_square(SymmetricTensor& m, const Vec3& v, double a) {
  const Vec3 av = a * v;
  m.xx += av.x * v.x, m.xy += av.x * v.y, m.xz += av.x * v.z, m.yy += av.y * v.y, m.yz += av.y * v.z, m.zz += av.z * v.z;
}
inline Vec3 scaled(double s, const Vec3& a) { return s * a; }
inline Mat3 scaled(double s, const Mat3& a) { return {s * a[0], s * a[1], s * a[2]}; }
/// What a cell has by itself: phi, or nothing where a scalar is given by its changes.
template <class Value>
auto values_of(std::span<const Value> phi) {
  return [phi](int c) { return phi[static_cast<std::size_t>(c)]; };
}
constexpr auto zero = [](int) { return 0.0; };
inline void add(Vec3& a, const Vec3& b) { a += b; }
inline void add(Mat3& a, const Mat3& b) { a[0] += b[0], a[1] += b[1], a[2] += b[2]; }

}  // namespace

CellMoments::CellMoments(const Mesh& mesh) : mesh_(mesh), inverse_(static_cast<std::size_t>(mesh.n_cells)) {
  place_of_boundary_face_.reserve(static_cast<std::size_t>(mesh.n_faces - mesh.n_interior));
  for (int c = 0; c < mesh_.n_cells; ++c) {
    const auto faces = row(mesh_.cell_face_start, mesh_.cell_face, c);
    const auto on_boundary = [&](int f) { return f >= mesh_.n_interior; };
    const auto is_facet = [&](int f) { return f >= mesh_.first_facet && f < mesh_.n_interior; };
    int place = -1;
    if (std::any_of(faces.begin(), faces.end(), on_boundary)) {
      place = static_cast<int>(boundary_cells_.size());
      boundary_cells_.push_back(c), boundary_moments_.emplace_back();
    }
    if (mesh_.cell_zone[c] == mesh_.turning.zone || std::any_of(faces.begin(), faces.end(), is_facet)) turning_.push_back(c);
    set(c, place);
  }
  turning_.shrink_to_fit(), boundary_cells_.shrink_to_fit(), boundary_moments_.shrink_to_fit();
  for (int f = mesh_.n_interior; f < mesh_.n_faces; ++f)
    place_of_boundary_face_.push_back(
        static_cast<int>(std::lower_bound(boundary_cells_.begin(), boundary_cells_.end(), mesh_.owner[f]) - boundary_cells_.begin()));
}

void CellMoments::update() {
  std::erase_if(open_, [&](const OpenCell& open) { return std::ranges::binary_search(turning_, open.cell); });
  auto boundary = boundary_cells_.begin();
  for (const int c : turning_) {
    boundary = std::find_if(boundary, boundary_cells_.end(), [c](int other) { return other >= c; });
    const bool is_on_boundary = boundary != boundary_cells_.end() && *boundary == c;
    set(c, is_on_boundary ? static_cast<int>(boundary - boundary_cells_.begin()) : -1);
  }
}

void CellMoments::set(int cell, int place) {
  SymmetricTensor M;
  for (const int f : row(mesh_.cell_face_start, mesh_.cell_face, cell)) {
    if (f >= mesh_.n_interior) continue;
    const Vec3& d = mesh_.delta[f];
    add_square(M, d, share_of_face(mesh_, f, mesh_.owner[f] == cell) / norm_squared(d));
  }
  if (place < 0)
    inverse_[cell] = inverse(M, cell, open_);
  else
    boundary_moments_[place] = M, inverse_[cell] = {.xx = 1, .xy = 0, .xz = 0, .yy = 1, .yz = 0, .zz = 1};
}

SymmetricTensor CellMoments::inverse(const SymmetricTensor& m, int cell, std::vector<OpenCell>& open) {
  const double cxx = m.yy * m.zz - m.yz * m.yz, cxy = m.xz * m.yz - m.xy * m.zz, cxz = m.xy * m.yz - m.xz * m.yy;
  const double det = m.xx * cxx + m.xy * cxy + m.xz * cxz, trace = m.xx + m.yy + m.zz;
  if (4 * det > open_eigenvalue * trace * trace) {  // smallest eigenvalue >= det / (trace/2)^2
    const double r = 1 / det;
    return {r * cxx, r * cxy, r * cxz, r * (m.xx * m.zz - m.xz * m.xz), r * (m.xy * m.xz - m.xx * m.yz), r * (m.xx * m.yy - m.xy * m.xy)};
  }
  Eigen::Matrix3d M;
  M << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(M);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero(), along_open = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d v = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()(k) < open_eigenvalue)
      along_open += v * v.transpose();
    else
      inverse += v * v.transpose() / eigen.eigenvalues()(k);
  }
  const auto line = [&](int i) { return Vec3{along_open(i, 0), along_open(i, 1), along_open(i, 2)}; };
  if (along_open.trace() > 0.5) open.push_back({cell, {line(0), line(1), line(2)}});
  return {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)};
}

LeastSquares::LeastSquares(const Mesh& mesh, const CellMoments& moments, std::vector<Side> sides)
    : mesh_(mesh), sides_(std::move(sides)), moments_(moments), skew_faces_(snag::skew_faces(mesh)) {
  skew_anywhere_ = sum(mesh_.comm, static_cast<std::int64_t>(skew_faces_.size())) > 0;
  update();
}

void LeastSquares::update() {
  aslant_faces_.clear();  // numbered behind the facets of a sliding interface, which change
  boundary_inverse_ = moments_.boundary_moments();
  for (std::size_t p = 0; p < sides_.size(); ++p)
    for (int f = mesh_.patches[p].first; f < mesh_.patches[p].end(); ++f) {
      if (sides_[p] != Side::value && is_aslant(mesh_, f)) aslant_faces_.push_back({f, 1});
      if (sides_[p] == Side::none) continue;
      const Vec3& way = sides_[p] == Side::value ? mesh_.delta[f] : mesh_.face_vector[f];
      add_square(boundary_inverse_[moments_.place_of_boundary_face()[f - mesh_.n_interior]], way, 1 / norm_squared(way));
    }
  share_among_aslant_faces();
  open_ = moments_.open();
  for (std::size_t i = 0; i < boundary_inverse_.size(); ++i)
    boundary_inverse_[i] = CellMoments::inverse(boundary_inverse_[i], moments_.boundary_cells()[i], open_);
  open_anywhere_ = sum(mesh_.comm, static_cast<std::int64_t>(open_.size())) > 0;
}

void LeastSquares::share_among_aslant_faces() {
  const auto cell = [this](const AslantFace& aslant) { return mesh_.owner[aslant.face]; };
  std::ranges::stable_sort(aslant_faces_, {}, cell);
  for (auto first = aslant_faces_.begin(); first != aslant_faces_.end();) {
    const auto end = std::find_if(first, aslant_faces_.end(), [&](const AslantFace& other) { return cell(other) != cell(*first); });
    for (auto one = first; one != end; ++one) {
      double sum = 0;
      for (auto other = first; other != end; ++other)
        sum += std::abs(dot(unit(mesh_.face_vector[one->face]), unit(mesh_.face_vector[other->face])));
      one->share = 1 / sum;
    }
    first = end;
  }
}

/// act(face, share of it in the owner, in the neighbour).
template <class Act>
void LeastSquares::for_each_difference(const Act& act) const {
  for (int f = 0; f < mesh_.first_facet; ++f) act(f, 1.0, 1.0);
  for (int f = mesh_.first_facet; f < mesh_.n_interior; ++f) act(f, share_of_face(mesh_, f, true), share_of_face(mesh_, f, false));
}

template <class Value, class Gradient>
void LeastSquares::add_interior(std::span<const Value> phi, std::vector<Gradient>& g) const {
  std::fill(g.begin(), g.end(), Gradient{});
  for_each_difference([&](int f, double owner_share, double neighbour_share) {
    const int P = mesh_.owner[f], N = mesh_.neighbour[f];
    const Vec3& d = mesh_.delta[f];
    const Vec3 e = d / norm_squared(d);
    const Value change = phi[N] - phi[P];
    add_product(g[P], owner_share * change, e);
    add_product(g[N], neighbour_share * change, e);
  });
}

/// Adds the boundary and multiplies by M^-1; `phi` gives the value of a cell.
template <class Value, class Gradient, class OfCell>
void LeastSquares::finish(const OfCell& phi, std::span<const Value> boundary, std::vector<Gradient>& g) const {
  for (std::size_t p = 0; p < sides_.size(); ++p) {
    const Patch& patch = mesh_.patches[p];
    if (sides_[p] == Side::none) continue;
    for (int f = patch.first; f < patch.end(); ++f) {
      const int P = mesh_.owner[f];
      const Vec3& d = mesh_.delta[f];
      if (sides_[p] == Side::value) {
        add_product(g[P], boundary[f - mesh_.n_interior] - phi(P), d / norm_squared(d));
      } else {
        const Vec3 n = unit(mesh_.face_vector[f]);
        if (sides_[p] == Side::slope)
          add_product(g[P], normal_slope(boundary[f - mesh_.n_interior]), n);
        else
          add_product(g[P], mirrored(phi(P), boundary[f - mesh_.n_interior], n), n / dot(d, n));
      }
    }
  }
  for (int c = 0; c < mesh_.n_cells; ++c) g[c] = product(moments_.inverse()[c], g[c]);
  for (std::size_t i = 0; i < boundary_inverse_.size(); ++i) {
    const int c = moments_.boundary_cells()[i];
    g[c] = product(boundary_inverse_[i], g[c]);
  }
  exchange(mesh_, g);
  if (open_anywhere_) fill_open(g);
}

template <class Gradient>
void LeastSquares::fill_open(std::vector<Gradient>& g) const {
  std::vector<Gradient> filled;
  for (const CellMoments::OpenCell& cell : open_) {
    Gradient mean{};
    const double weight = for_each_neighbour(mesh_, cell.cell, [&](int other, double share) { add(mean, scaled(share, g[other])); });
    Gradient whole = g[cell.cell];
    if (weight > 0) {
      Mat3 open = cell.open;
      for (Vec3& row : open) row *= 1 / weight;
      add(whole, product(open, mean));
    }
    filled.push_back(whole);
  }
  for (std::size_t i = 0; i < open_.size(); ++i) g[open_[i].cell] = filled[i];
  exchange(mesh_, g);
}

void LeastSquares::gradient(std::span<const double> phi, std::span<const double> boundary, std::vector<Vec3>& g) const {
  add_interior<double, Vec3>(phi, g);
  finish<double, Vec3>(values_of(phi), boundary, g);
}

void LeastSquares::gradient_of_changes(std::span<const double> change, std::vector<Vec3>& g) const {
  std::fill(g.begin(), g.end(), Vec3{});
  for_each_difference([&](int f, double owner_share, double neighbour_share) {
    const Vec3& d = mesh_.delta[f];
    const Vec3 e = change[f] / norm_squared(d) * d;
    g[mesh_.owner[f]] += owner_share * e;
    g[mesh_.neighbour[f]] += neighbour_share * e;
  });
  finish<double, Vec3>(zero, change.subspan(static_cast<std::size_t>(mesh_.n_interior)), g);
}

void LeastSquares::gradient(std::span<const Vec3> u, std::span<const Vec3> boundary, std::vector<Mat3>& g) const {
  add_interior<Vec3, Mat3>(u, g);
  finish<Vec3, Mat3>(values_of(u), boundary, g);
}

namespace {

template <class OfCell>
void fill_boundary_from(const Mesh& mesh, const LeastSquares& squares, const OfCell& phi, std::span<const Vec3> g,
                        std::span<const double> given, std::span<double> values) {
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    for (int f = mesh.patches[p].first; f < mesh.patches[p].end(); ++f) {
      const int P = mesh.owner[f], b = f - mesh.n_interior;
      const Vec3& d = mesh.delta[f];
      if (squares.side(p) == Side::value) {
        values[b] = given[b];
      } else if (squares.side(p) == Side::slope) {
        const Vec3 n = unit(mesh.face_vector[f]);
        values[b] = phi(P) + dot(g[P], along_face(d, n)) + given[b] * dot(d, n);
      } else {
        values[b] = phi(P) + dot(g[P], d);
      }
    }
  }
}

/// What the sum of phi_f S, `g`, lacks of V `slope` in a cell, along S, as a value at the face.
inline double lacking(const Mesh& mesh, int c, const Vec3& S, std::span<const Vec3> slope, const std::vector<Vec3>& g) {
  return dot(mesh.cell_volume[c] * slope[c] - g[c], S) / norm_squared(S);
}

/// Values at skew faces, changed in g and `facets`: all from the sums before, so that their order does not matter.
void close_skew_faces(const Mesh& mesh, const LeastSquares& squares, std::span<const Vec3> slope, std::vector<Vec3>& g,
                      std::span<double> facets) {
  if (!squares.skew_anywhere()) return;
  exchange(mesh, g);
  std::vector<double> change;
  change.reserve(squares.skew_faces().size());
  for (const int f : squares.skew_faces()) {
    const Vec3& S = mesh.face_vector[f];
    change.push_back(0.5 * (lacking(mesh, mesh.owner[f], S, slope, g) - lacking(mesh, mesh.neighbour[f], S, slope, g)));
  }
  for (std::size_t i = 0; i < change.size(); ++i) {
    const int f = squares.skew_faces()[i];
    g[mesh.owner[f]] += change[i] * mesh.face_vector[f];
    g[mesh.neighbour[f]] -= change[i] * mesh.face_vector[f];
    if (f >= mesh.first_facet && !facets.empty()) facets[static_cast<std::size_t>(f - mesh.first_facet)] += change[i];
  }
}

/// Values at boundary faces whose cell lies aslant over them, changed in g and `boundary`: all from the sums before, so that their order
/// does not matter.
void close_aslant_faces(const Mesh& mesh, const LeastSquares& squares, std::span<const Vec3> slope, std::span<double> boundary,
                        std::vector<Vec3>& g) {
  std::vector<double> change;
  change.reserve(squares.aslant_faces().size());
  for (const auto& [f, share] : squares.aslant_faces())
    change.push_back(share * lacking(mesh, mesh.owner[f], mesh.face_vector[f], slope, g));
  for (std::size_t i = 0; i < change.size(); ++i) {
    const int f = squares.aslant_faces()[i].face;
    boundary[f - mesh.n_interior] += change[i];
    g[mesh.owner[f]] += change[i] * mesh.face_vector[f];
  }
}

/// What counts at an interior face in the sum of the owner and in that of the neighbour.
struct FaceValues {
  double in_owner, in_neighbour;
};

/// Both forms of the gradient. `of_face` has FaceValues operator()(int f).
template <class OfFace>
void sum_over_faces(const Mesh& mesh, const LeastSquares& squares, const OfFace& of_face, std::span<double> boundary,
                    std::span<const Vec3> slope, std::vector<Vec3>& g, std::span<double> facets) {
  std::fill(g.begin(), g.end(), Vec3{});
  for (int f = 0; f < mesh.n_interior; ++f) {
    const FaceValues phi_f = of_face(f);
    if (f >= mesh.first_facet && !facets.empty()) facets[static_cast<std::size_t>(f - mesh.first_facet)] = phi_f.in_owner;
    g[mesh.owner[f]] += phi_f.in_owner * mesh.face_vector[f];
    g[mesh.neighbour[f]] -= phi_f.in_neighbour * mesh.face_vector[f];
  }
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) g[mesh.owner[f]] += boundary[f - mesh.n_interior] * mesh.face_vector[f];
  close_skew_faces(mesh, squares, slope, g, facets);
  close_aslant_faces(mesh, squares, slope, boundary, g);
  for (int c = 0; c < mesh.n_cells; ++c) g[c] *= 1 / mesh.cell_volume[c];
  exchange(mesh, g);
}

}  // namespace

void fill_boundary(const Mesh& mesh, const LeastSquares& squares, std::span<const double> phi, std::span<const Vec3> g,
                   std::span<const double> given, std::span<double> values) {
  fill_boundary_from(mesh, squares, values_of(phi), g, given, values);
}

void gauss_gradient(const Mesh& mesh, const LeastSquares& squares, std::span<const double> phi, std::span<double> boundary,
                    std::span<const Vec3> slope, std::vector<Vec3>& g, std::span<double> facets) {
  const auto of_face = [&mesh, phi, slope](int f) -> FaceValues {
    const int P = mesh.owner[f], N = mesh.neighbour[f];
    const double w = mesh.weight[f], phi_f = w * phi[P] + (1 - w) * phi[N] + dot(skewness(mesh, f), blend(w, slope[P], slope[N]));
    return {phi_f, phi_f};
  };
  sum_over_faces(mesh, squares, of_face, boundary, slope, g, facets);
}

void gauss_gradient_of_changes(const Mesh& mesh, const LeastSquares& squares, std::span<const double> change, std::span<double> boundary,
                               std::span<const Vec3> slope, std::vector<Vec3>& g) {
  const auto of_face = [&mesh, change, slope](int f) -> FaceValues {
    const double w = mesh.weight[f];
    const double from_owner = (1 - w) * change[f] + dot(skewness(mesh, f), blend(w, slope[mesh.owner[f]], slope[mesh.neighbour[f]]));
    return {from_owner, from_owner - change[f]};
  };
  fill_boundary_from(mesh, squares, zero, slope, change.subspan(static_cast<std::size_t>(mesh.n_interior)), boundary);
  sum_over_faces(mesh, squares, of_face, boundary, slope, g, {});
}

std::vector<int> closed_cells(const Mesh& mesh, const LeastSquares& squares) {
  std::vector<int> cells = skew_cells(mesh);
  for (const auto& aslant : squares.aslant_faces()) cells.push_back(mesh.owner[aslant.face]);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

Vec3 mean_of_neighbours(const Mesh& mesh, int cell, const std::vector<Vec3>& g) {
  Vec3 sum;
  const double weight = for_each_neighbour(mesh, cell, [&](int other, double share) { sum += share * g[other]; });
  return weight > 0 ? sum / weight : g[cell];
}

Mat3 mean_with_neighbours(const Mesh& mesh, int cell, const std::vector<Mat3>& G) {
  Mat3 sum = G[cell];
  const double weight = for_each_neighbour(mesh, cell, [&](int other, double share) { add(sum, scaled(share, G[other])); });
  return scaled(1 / (1 + weight), sum);
}

}  // namespace snag
