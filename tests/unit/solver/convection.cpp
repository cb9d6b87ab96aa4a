// Every convection scheme and every limiter of the registries is held to the same rules; a new file of their folders is tested without a
// line here.
#include <gtest/gtest.h>
#include <array>

#include <random>

#include "solver/convection/convection.hpp"
#include "solver/convection/limiter.hpp"
#include "solver/convection/tetrahedra.hpp"
#include "solver/fields/face.hpp"
#include "tests/sources.hpp"
#include "tests/structured_box.hpp"

using namespace snag;

namespace {

template <class Models, class Work>
void for_each(const Models& models, const Work& work) {
  ASSERT_FALSE(models.names().empty());
  for (const std::string& name : models.names()) {
    SCOPED_TRACE(name);
    work(*models.make(name, "test"));
  }
}

Mesh box() { return structured_box(MPI_COMM_WORLD, {}, {1, 1, 1}, {4, 3, 3}); }

/// A guess of the velocity with its gradient and the factors of a limiter.
struct Guess {
  explicit Guess(const Mesh& mesh) : u(mesh.n_all_cells()), G(mesh.n_all_cells()), psi(mesh.n_all_cells(), Vec3{1, 1, 1}) {}
  std::vector<Vec3> u;
  std::vector<Mat3> G;
  std::vector<Vec3> psi;
};

const Mat3 slope{Vec3{1, 2, -3}, Vec3{0.5, -1, 2}, Vec3{-2, 0, 1}};

Guess linear(const Mesh& mesh) {
  Guess guess(mesh);
  for (int c = 0; c < mesh.n_all_cells(); ++c) guess.u[c] = Vec3{1, 2, 3} + slope * mesh.cell_centre[c], guess.G[c] = slope;
  return guess;
}

/// Noise, with gradients that have nothing to do with it.
Guess rough(const Mesh& mesh) {
  Guess guess(mesh);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3{any(engine), any(engine), any(engine)}; };
  for (int c = 0; c < mesh.n_all_cells(); ++c) guess.u[c] = vector(), guess.G[c] = {9 * vector(), 9 * vector(), 9 * vector()};
  return guess;
}

/// Value that a scheme gives to face f where `flux` m3/s flow from the owner to the neighbour, and nothing elsewhere: from the balance of
/// the row of the owner, without viscosity and at a density of 1.
Vec3 value_at_face(const ConvectionScheme& scheme, const Mesh& mesh, const Guess& guess, int f, double flux) {
  Flow flow(mesh);
  flow.density = 1;
  std::fill(flow.face_viscosity.begin(), flow.face_viscosity.end(), 0.0);
  CellMatrix matrix(mesh);
  const auto n = static_cast<std::size_t>(mesh.n_all_cells());
  std::vector<Vec3> diagonal(n), right_side(n);
  std::vector<double> fluxes(static_cast<std::size_t>(mesh.n_faces));
  fluxes[f] = flux;
  const std::vector<std::uint8_t> in_corner(n);
  const FaceInputs inputs{.flow = flow,
                          .guess = guess.u,
                          .flux = fluxes,
                          .gradient = guess.G,
                          .reconstruction = guess.G,
                          .psi = guess.psi,
                          .in_corner = in_corner};
  scheme.add_interior(inputs, {matrix, diagonal, right_side});
  const int P = mesh.owner[f], N = mesh.neighbour[f];
  const Vec3 out = diagonal[P].x * guess.u[P] + matrix.value[matrix.place_of_owner[f]] * guess.u[N] - right_side[P];
  const Vec3 in = diagonal[N].x * guess.u[N] + matrix.value[matrix.place_of_neighbour[f]] * guess.u[P] - right_side[N];
  EXPECT_LT(norm(out + in), 1e-13) << "what leaves one cell enters the other";
  std::array<MomentumFlux, 1> of_face;
  scheme.fluxes(inputs, guess.u, f, of_face);
  EXPECT_LT(norm(of_face[0].convection - out), 1e-13) << "the flux of the face is that of the rows";
  EXPECT_EQ(norm(of_face[0].friction), 0);
  return out / flux;
}

double lowest(double a, double b) { return std::min(a, b); }
double highest(double a, double b) { return std::max(a, b); }

}  // namespace

// Requirement: no scheme and no limiter is dropped by the linker: the registries hold what their folders hold.
TEST(ConvectionSchemes, RegistryHoldsTheFolder) { EXPECT_EQ(convection_schemes().names().size(), n_sources("solver/convection/schemes")); }
TEST(Limiters, RegistryHoldsTheFolder) { EXPECT_EQ(limiters().names().size(), n_sources("solver/convection/limiters")); }

// Requirement: the manual says of each scheme and limiter what it is and where it comes from.
TEST(ConvectionSchemes, Cards) {
  for_each(convection_schemes(), [](const ConvectionScheme& scheme) {
    EXPECT_FALSE(scheme.description().equation.empty() || scheme.description().source.empty());
    EXPECT_NE(convection_meaning().find(scheme.description().equation), std::string::npos);
  });
  for_each(limiters(), [](const Limiter& limiter) {
    EXPECT_FALSE(limiter.description().equation.empty() || (limiter.bounds() && limiter.description().source.empty()));
    EXPECT_NE(limiter_meaning().find(limiter.description().equation), std::string::npos);
  });
}

// Requirement: a scheme keeps a uniform velocity, and gives that of a linear field exactly if it is of second order, for both directions of
// the flow.
TEST(ConvectionSchemes, UniformAndLinear) {
  const Mesh mesh = box();
  Guess uniform(mesh);
  std::fill(uniform.u.begin(), uniform.u.end(), Vec3{1, -2, 3});
  const Guess guess = linear(mesh);
  for_each(convection_schemes(), [&](const ConvectionScheme& scheme) {
    double largest = 0;
    for (int f = 0; f < mesh.first_facet; ++f)
      for (const double flux : {0.3, -0.7}) {
        EXPECT_LT(norm(value_at_face(scheme, mesh, uniform, f, flux) - uniform.u[0]), 1e-14);
        const Vec3 exact = Vec3{1, 2, 3} + slope * mesh.face_centre[f];
        largest = std::max(largest, norm(value_at_face(scheme, mesh, guess, f, flux) - exact));
      }
    if (scheme.description().order > 1)
      EXPECT_LT(largest, 1e-13);
    else
      EXPECT_GT(largest, 0.1);
  });
}

// Requirement: a bounded scheme gives a face no value beyond those of its two cells; one that takes a limiter none beyond those of the
// upwind cell and its neighbours.
TEST(ConvectionSchemes, Bounded) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {}, {1, 1, 1}, {4, 3, 3});
  Guess guess = rough(mesh);
  for_each(convection_schemes(), [&](const ConvectionScheme& scheme) {
    if (!scheme.is_bounded()) return;
    if (scheme.is_limited()) limiters().make("barth_jespersen", "test")->limit({mesh, false, guess.u, guess.G, 0, {}}, guess.psi);
    for (int f = 0; f < mesh.first_facet; ++f)
      for (const double flux : {0.3, -0.7}) {
        const Vec3 value = value_at_face(scheme, mesh, guess, f, flux);
        const int C = flux > 0 ? mesh.owner[f] : mesh.neighbour[f];
        for (int i = 0; i < 3; ++i) {
          double low = lowest(guess.u[mesh.owner[f]][i], guess.u[mesh.neighbour[f]][i]),
                 high = highest(guess.u[mesh.owner[f]][i], guess.u[mesh.neighbour[f]][i]);
          for (int k = mesh.cell_face_start[C]; scheme.is_limited() && k < mesh.cell_face_start[C + 1]; ++k) {
            const int other = mesh.cell_face[k];
            if (other >= mesh.n_interior) continue;
            const Vec3& u = guess.u[mesh.owner[other] == C ? mesh.neighbour[other] : mesh.owner[other]];
            low = lowest(low, u[i]), high = highest(high, u[i]);
          }
          EXPECT_GE(value[i], low - 1e-13);
          EXPECT_LE(value[i], high + 1e-13);
        }
      }
  });
}

// Requirement: a limiter leaves a constant velocity alone; its factors lie in [0, 1]; and one that bounds lets no face of a cell lie beyond
// the values of the cell and its neighbours, in each component or along its change, where nothing is small against the reference speed.
TEST(Limiters, Bounds) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {}, {1, 1, 1}, {4, 3, 3});
  const Guess guess = rough(mesh);
  for_each(limiters(), [&](const Limiter& limiter) {
    std::vector<Vec3> psi(guess.u.size(), Vec3{-1, -1, -1});
    limiter.limit({mesh, false, guess.u, std::vector<Mat3>(guess.u.size()), 1, {}}, psi);
    for (const Vec3& factor : psi) EXPECT_EQ(norm(factor - Vec3{1, 1, 1}), 0);
    std::vector<Vec3> across_periods(psi);
    limiter.limit({mesh, true, guess.u, guess.G, 0, {}}, across_periods);
    limiter.limit({mesh, false, guess.u, guess.G, 0, {}}, psi);
    for (std::size_t c = 0; c < psi.size(); ++c) EXPECT_LT(norm(psi[c] - across_periods[c]), 1e-12);
    double beyond = 0, beyond_along = 0;
    for (int c = 0; c < mesh.n_cells; ++c) {
      Vec3 low = guess.u[c], high = guess.u[c];
      std::vector<Vec3> differences{{}};
      for (int k = mesh.cell_face_start[c]; k < mesh.cell_face_start[c + 1]; ++k) {
        const int f = mesh.cell_face[k];
        if (f >= mesh.n_interior) continue;
        const Vec3& u = guess.u[mesh.owner[f] == c ? mesh.neighbour[f] : mesh.owner[f]];
        for (int i = 0; i < 3; ++i) low[i] = lowest(low[i], u[i]), high[i] = highest(high[i], u[i]);
        differences.push_back(u - guess.u[c]);
      }
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(psi[c][i] >= 0 && psi[c][i] <= 1) << psi[c][i];
      for (int k = mesh.cell_face_start[c]; k < mesh.cell_face_start[c + 1]; ++k) {
        const int f = mesh.cell_face[k];
        if (f >= mesh.n_interior) continue;
        const Vec3 change = guess.G[c] * (mesh.face_centre[f] - mesh.cell_centre[c]);
        for (int i = 0; i < 3; ++i) {
          const double value = guess.u[c][i] + psi[c][i] * change[i];
          beyond = std::max({beyond, value - high[i], low[i] - value});
        }
        double along = 0;
        for (const Vec3& difference : differences) along = std::max(along, dot(difference, unit(change)));
        beyond_along = std::max(beyond_along, dot(scaled(psi[c], change), unit(change)) - along);
      }
    }
    if (limiter.bounds())
      EXPECT_LT(std::min(beyond, beyond_along), 1e-13);
    else
      EXPECT_GT(std::min(beyond, beyond_along), 0.1);
  });
}

// Requirement: the factor is the published function of y, the largest change to a neighbour over the change to the face; that of Michalak
// and Ollivier-Gooch has the four values and slopes that define its cubic.
TEST(Limiters, PublishedFactors) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {}, {3, 1, 1}, {3, 1, 1});
  Guess guess(mesh);
  for (int c = 0; c < mesh.n_cells; ++c) guess.u[c] = {mesh.cell_centre[c].x, 0, 0};
  const int middle = [&] {
    for (int c = 0; c < mesh.n_cells; ++c)
      if (std::abs(mesh.cell_centre[c].x - 1.5) < 1e-12) return c;
    return -1;
  }();
  const auto factor = [&](const char* name, double y) {
    guess.G[middle] = {Vec3{2 / y, 0, 0}, {}, {}};  // the change to a neighbour is 1 m/s, that to the face 1/y
    limiters().make(name, "test")->limit({mesh, false, guess.u, guess.G, 0, {}}, guess.psi);
    return guess.psi[middle].x;
  };
  for (const double y : {0.25, 0.75, 1.25, 1.5, 4.0}) {
    SCOPED_TRACE(y);
    EXPECT_EQ(factor("none", y), 1);
    EXPECT_NEAR(factor("barth_jespersen", y), std::min(1.0, y), 1e-14);
    for (const char* law : {"venkatakrishnan", "vector_venkatakrishnan"})
      EXPECT_NEAR(factor(law, y), std::min(1.0, (y * y + 2 * y) / (y * y + y + 2)), 1e-14);
  }
  EXPECT_NEAR(factor("michalak_ollivier_gooch", 0.75), 0.6875, 1e-14);
  EXPECT_NEAR(factor("michalak_ollivier_gooch", 1.2), 0.944, 1e-14);
  EXPECT_NEAR(factor("michalak_ollivier_gooch", 1e-3), 1e-3, 1e-9);     // slope 1 at y = 0
  EXPECT_NEAR(factor("michalak_ollivier_gooch", 1.5 - 1e-4), 1, 1e-7);  // slope 0 at y = 3/2
  EXPECT_EQ(factor("michalak_ollivier_gooch", 1.5), 1);
}

// Requirement: in tetrahedra, limiters of components leave a linear velocity alone up to walls whose velocity is known, and let no face lie
// beyond the cells around, their neighbours and the boundaries of these. Within the four neighbours they cut a linear velocity.
TEST(Limiters, Tetrahedra) {
  const Mesh mesh = tetrahedral_box(MPI_COMM_SELF, {.upper = {1, 1, 1}, .distortion = 0.2}, {4, 3, 3});
  const std::vector<Side> walls(mesh.patches.size(), Side::value);
  std::vector<Vec3> given;
  for (int f = mesh.n_interior; f < mesh.n_faces; ++f) given.push_back(Vec3{1, 2, 3} + slope * mesh.face_centre[f]);
  TetrahedronReconstruction reconstruction(mesh);
  const Guess smooth = linear(mesh), noise = rough(mesh);
  std::vector<Vec3> psi(smooth.u.size());
  const auto smallest = [&psi] {
    double least = 1;
    for (const Vec3& factor : psi) least = std::min({least, factor.x, factor.y, factor.z});
    return least;
  };
  for (const char* name : {"barth_jespersen", "michalak_ollivier_gooch", "venkatakrishnan"}) {
    SCOPED_TRACE(name);
    const auto limiter = limiters().make(name, "test");
    limiter->limit({mesh, false, smooth.u, smooth.G, 0, {}}, psi);
    EXPECT_LT(smallest(), 0.7);
    limiter->limit({mesh, false, smooth.u, smooth.G, 0, reconstruction.ranges(smooth.u, walls, given)}, psi);
    EXPECT_GT(smallest(), 1 - 1e-12);

    limiter->limit({mesh, false, noise.u, noise.G, 0, reconstruction.ranges(noise.u, walls, given)}, psi);
    double beyond = 0;
    for (int c = 0; c < mesh.n_cells; ++c) {
      Vec3 low = noise.u[c], high = noise.u[c];
      const auto include = [&](const Vec3& u) {
        for (int i = 0; i < 3; ++i) low[i] = lowest(low[i], u[i]), high[i] = highest(high[i], u[i]);
      };
      const auto include_around = [&](int cell) {
        include(noise.u[cell]);
        for (const int f : row(mesh.cell_face_start, mesh.cell_face, cell))
          include(f < mesh.n_interior ? noise.u[mesh.owner[f] + mesh.neighbour[f] - cell] : given[f - mesh.n_interior]);
      };
      include_around(c);
      for_each_neighbour(mesh, c, [&](int other, double) { include_around(other); });
      for (const int f : row(mesh.cell_face_start, mesh.cell_face, c)) {
        if (f >= mesh.n_interior) continue;
        const Vec3 value = noise.u[c] + scaled(psi[c], noise.G[c] * (mesh.face_centre[f] - mesh.cell_centre[c]));
        for (int i = 0; i < 3; ++i) beyond = std::max({beyond, value[i] - high[i], low[i] - value[i]});
      }
    }
    EXPECT_LT(beyond, 1e-13);
  }
}

// Requirement: the factors of the limiter of vectors are the same where all velocities are turned; those of components are not.
TEST(Limiters, VectorsTurn) {
  const Mesh mesh = structured_box(MPI_COMM_SELF, {}, {1, 1, 1}, {4, 3, 3});
  const Guess guess = rough(mesh);
  const Mat3 turn = rotation(unit(Vec3{1, 2, 3}), 0.6);
  std::vector<Vec3> u(guess.u);
  std::vector<Mat3> G(guess.G);
  for (std::size_t c = 0; c < u.size(); ++c) {
    u[c] = turn * guess.u[c];
    for (std::size_t i = 0; i < 3; ++i)  // rows: gradients of the components
      G[c][i] = turn[i].x * guess.G[c][0] + turn[i].y * guess.G[c][1] + turn[i].z * guess.G[c][2];
  }
  const auto largest_change = [&](const char* name) {
    const auto limiter = limiters().make(name, "test");
    std::vector<Vec3> psi(u.size()), turned(u.size());
    limiter->limit({mesh, false, guess.u, guess.G, 0.1, {}}, psi);
    limiter->limit({mesh, false, u, G, 0.1, {}}, turned);
    double largest = 0;
    for (std::size_t c = 0; c < u.size(); ++c) largest = std::max(largest, norm(turned[c] - psi[c]));
    return largest;
  };
  EXPECT_LT(largest_change("vector_venkatakrishnan"), 1e-12);
  EXPECT_GT(largest_change("venkatakrishnan"), 0.1);
}
