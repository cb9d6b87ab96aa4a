// Resistance of a sheet by its local tangent plane, in place of a share theta of the drag of its particles:
//
//   F = (1 - theta) F_drag + theta (1/2 rho C_n A |w_n| w_n + rho C_t A |w_t| w_t),   A = (2 r_p)^2: the cloth that a particle stands for
//   n: unit normal of the cloth from the bonded neighbours along and across the rows,   w_n = (w.n) n,   w_t = w - w_n
//
//   form "quadratic"   C_n, C_t as given: bluff plate, rough surface on both sides
//   form "viscous"     C_t + c_f: boundary layers;  one-way also C_n + 20.4/Re, Re = rho |w| D_s/mu: a disc in creeping flow, which a
//                      two-way run resolves; D_s: diameter of the disc that has the area of the sheet
//
// Layers begin at the edge of the sheet from which the water comes, x before the particle along the slip; h: half of the particle's cloth
// along the slip; x_t = Re_t nu/U:
//
//   c_f = (D(x + h) - D(x - h))/(2 h)
//   D = 1.328 (x nu/U)^(1/2) + 2.67 (nu/U)^(7/8) x^(1/8)         x < x_t, laminar, with the term of the trailing edge
//   D = D(x_t) + 0.074 (nu/U)^(1/5) (x^(4/5) - x_t^(4/5))        behind x_t, turbulent
//
// Two-way the velocity at the sheet is the resolved one. C_n is then the loss coefficient K of the cloth: the pressure drop across it over
// 1/2 rho |w| w, w the velocity through it; a free-stream coefficient would count the blockage of the sheet twice. (One-way: 1.17, a plate
// across the stream. No measured K of a soaked wipe is known: 2 is an assumption.) Two corrections take the width delta of the kernel into
// account:
//
//   edges    w = w_n - R Phi,   R = f(s/sigma)/(2 (s/sigma)^(1/2) sigma),   sigma = 2^(1/2) delta: of spreading and averaging together
//            dPhi/dt = F_n/(rho A) - chi |Phi| Phi/(2 g^2) - nu Phi/l^2,   chi = K/((1 + K)^(1/2) - 1)^2,   g = max((1 - kappa)/R, c s)
//            Phi: jump of the potential across the sheet, m2/s; F_n: all that the water gives the particle along n; kappa: coverage; c =
//            1/2; s: distance from the edges (coupling/cloth_edges.hpp);   l^2 = sigma^2 (1 - exp(-1.4 t - 0.4 t^2)), t = s/sigma
//
//            The kernel also averages water beside the sheet. About an edge that pressure sets in motion the potential jumps by 2 B
//            x^(1/2) at the distance x inside, and the average of the velocity over a Gaussian of width sigma is B f(x/sigma)/sigma^(1/2):
//            R is their ratio, f fitted within 1.4 %. Far inside R is sigma/(2 pi)^(1/2) times the surface Laplacian of the jump: exact
//            with s as it is defined. In steady flow the water beside the sheet has the velocity w (1 + K)^(1/2) that Bernoulli's equation
//            gives it, so that w_n = w kappa + w (1 + K)^(1/2) (1 - kappa): Phi stops growing there. In slow flow the friction stops it: at
//            the edge of a plate that moves across itself in creeping flow the average of the kernel is R l^2/mu times the pressure jump
//            (within 8 %).
//   layers   U = |w_t|/(1 - q),   q = D/(4 pi (delta^2 + (D/1.328)^2))^(1/2). The boundary layers of both sides slow the water that the
//            kernel averages. Their deficit, D U, is distributed over the widths of the kernel and of the layers. q is at most 0.375.
//
// Two-way a sheet also hinders eddies: the particle gives the screen theta A ((1 + K)^(1/2) - 1) to the models of turbulence, which say
// what it does (solver/turbulence/two_equation_model.hpp).
//
// Particles that have not neighbours in both directions (fibres, spheres) keep the drag that they have. Layers begin at the
// edge of the lattice, of a disc at that of the square around it; a tear or a cut begins no layer.
// Source: resistance of screens, Taylor and Batchelor (1949), Q. J. Mech. Appl. Math. 2, 1-29; plate across the flow C_n = 1.17, Hoerner
// (1965), chapter 3; disc in creeping flow, Lamb (1932), section 339; laminar layer, Blasius (1908), trailing edge, Messiter (1970), SIAM
// J. Appl. Math. 18, 241-257; turbulent layer, Prandtl (Schlichting, Boundary-Layer Theory, chapter XXI). At Re 4000 Messiter's term is
// half of what a plate has above Blasius' drag (McLachlan (1991), Phys. Fluids A 3, 341-348): the drag is then 8 % too low.
#include <algorithm>
#include <numbers>

#include "coupling/lattice_directions.hpp"
#include "coupling/vector_math.hpp"

namespace snag {
namespace {

/// Drag of one side of a plate of the length x per width and rho U^2/2, m; `ratio` nu/U, m, `transition` Re_t.
inline double layer_drag(double x, double ratio, double transition) {
  const double x_t = transition * ratio, laminar = std::min(x, x_t);
  const double sum = 1.328 * std::sqrt(laminar * ratio) + 2.67 * ratio * std::sqrt(std::sqrt(std::sqrt(laminar / ratio)));
  return sum + 0.074 * pow(ratio, 0.2) * (pow(std::max(x, x_t), 0.8) - pow(x_t, 0.8));
}

/// R, 1/m.
inline double relief_ratio(double s, double sigma) {
  const double t = std::min(s / sigma, 1e4), root = std::sqrt(t);
  return 0.164 * (1 + t * (-0.16245 + t * 0.16691)) /
         (root * (1 + t * (0.22519 + t * (0.29641 + t * (-0.06504 + root * 0.27447)))) * sigma);
}

/// l^2, m2.
inline double friction_area(double s, double sigma) {
  const double t = std::min(s / sigma, 20.0);  // exp(-t^2) that underflows is slow
  return sigma * sigma * (1 - exp(-t * (1.4 + 0.4 * t)));
}

struct SheetDrag final : FluidForce {
  static constexpr const char* name = "sheet_drag";
  static constexpr double of_plate = 1.17, of_cloth = 2;  // C_n one-way and two-way
  static constexpr double rough = 0.02;                   // C_t of form "quadratic"
  static constexpr double inner = 0.5;                    // c
  double share = 1, chosen_coefficient = of_plate, transition_reynolds = 5e5;
  std::optional<double> normal_coefficient, tangential_coefficient;
  enum class Form { quadratic, viscous };
  Choice<Form> form{Form::quadratic, {"quadratic", "viscous"}};
  bool is_two_way = false;

  bool viscous() const { return form == Form::viscous; }
  ForceDescription description() const override {
    return {.name = name,
            .equation = "F = (1 - theta) F_drag + theta (1/2 rho C_n A |w_n| w_n + rho C_t A |w_t| w_t)",
            .source = "Taylor and Batchelor (1949); Hoerner (1965)",
            .valid_for =
                "sheets resolved by particles; compared for K from 0.5 to impermeable, Re of the sheet 100 to 1e6, kernels of 0.06 to 0.12 "
                "of its side",
            .samples = {.disturbance = is_two_way, .coverage = is_two_way},
            .gives_screen = is_two_way,
            .needs_impulse = is_two_way,
            .role = Role::drag_replacement,
            .n_particle_state = is_two_way ? 1 : 0,
            .prior = Prior{.key = "coupling.sheet_drag.share",
                           .meaning = "share of the drag that follows the plane of the sheet",
                           .mean = 0.8,
                           .sd = 0.4,
                           .minimum = 0,
                           .maximum = 1,
                           .is_share = true,
                           .needs = {Need::sheet}}};
  }
  std::vector<Parameter> parameters() override {
    return {
        {"share", &share, "1", 0, 1, Basis::assumed, "Weight theta of the sheet law; 0: drag of the particles, 1: drag of the sheet."},
        {"normal_coefficient", &normal_coefficient, "1", 0, 1e6, Basis::assumed,
         "C_n: one-way the drag coefficient of a plate normal to the flow, by default 1.17 (Hoerner 1965); two-way the loss coefficient of "
         "the cloth, by default 2, an assumption: no measured one of a soaked wipe is known."},
        {"tangential_coefficient", &tangential_coefficient, "1", 0, 10, Basis::assumed,
         "C_t: friction coefficient of one side; by default 0.02, with form = \"viscous\" 0."},
        setting("form", &form,
                "quadratic: constant coefficients; viscous: with the boundary layers along the sheet and the term of slow flow across it."),
        {"transition_reynolds", &transition_reynolds, "1", 0, 1e9, Basis::literature,
         "Re_t = U x/nu from the edge at which boundary layers become turbulent (form = \"viscous\"); 0: from the edge on, as in stirred "
         "water."}};
  }
  void set_coupling(bool two_way) override { chosen_coefficient = two_way ? of_cloth : of_plate, is_two_way = two_way; }
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const override {
    if (share == 0) return;
    if (viscous())
      add<true>(fluid, particles, forces);
    else
      add<false>(fluid, particles, forces);
  }

 private:
  template <bool with_layers>
  void add(const FluidSamples& fluid, const Particles& particles, const Forces& forces) const {
    const Tile& tile = particles.tile;
    const double rho = fluid.density, nu = fluid.dynamic_viscosity / rho, r = particles.rag.radius, side = 2 * r, area = side * side,
                 K = normal_coefficient.value_or(chosen_coefficient), C_t = tangential_coefficient.value_or(with_layers ? 0 : rough),
                 theta = share, transition = transition_reynolds, around_edge = 1 + std::sqrt(1 + K),
                 chi = K > 0 ? around_edge * around_edge / K : 0;
    const double columns = particles.rag.n_columns, rows = particles.rag.n_rows;
    const double disc = side * std::sqrt(4 / std::numbers::pi * static_cast<double>(particles.rag.n_particles));  // diameter of equal area
    const double slow = is_two_way ? 0 : 20.4 * nu / disc;
    const VectorArray u = fluid.velocity, v = particles.velocity;
    const VectorSum force = forces.force;
    double* slope = forces.slope;
    const LatticeDirections lattice(particles);
    const double *covered = is_two_way ? fluid.coverage : nullptr, *width = is_two_way ? fluid.disturbance_width : nullptr;
    const double *from_edge = fluid.edge_distance, h = particles.step;
    const VectorArray J = particles.last_impulse;
    double *jump = particles.state, *relief = forces.relief, *screen = forces.screen;
    const double hindrance = area * (std::sqrt(1 + K) - 1);
    for (int j = 0; j < tile.ny; ++j) {
      const int first = tile.index(0, j);
      const double row = tile.row + j + 0.5;
#pragma omp simd
      for (int p = first; p < first + tile.nx; ++p) {
        const Vec3 along = direction(lattice.along(p)), across = direction(lattice.across(p)), n = direction(cross(along, across));
        const Vec3 w = u[p] - v[p], w_n = dot(w, n) * n, w_t = w - w_n;
        const double speed_t = std::sqrt(norm_squared(w_t)), here = norm_squared(n) > 0.5 ? theta : 0, rest = 1 - here;
        double through = dot(w, n), K_t = C_t * speed_t;
        if (covered) {
          const double s = from_edge[p], sigma = std::numbers::sqrt2 * width[p], R = relief_ratio(s, sigma);
          const double g = std::max(std::max(0.0, 1 - covered[p]) / R, inner * s) + 1e-30;
          const double driven = jump[p] + dot(J[p], n) / (rho * area),
                       fading = 1 + h * (chi * std::abs(driven) / (2 * g * g) + nu / friction_area(s, sigma));
          jump[p] = driven / fading;
          relief[p] = here * R / (rho * area * fading);
          through -= R * jump[p];
        }
        double K_n = K * std::abs(through);
        if constexpr (with_layers) {
          const double column = tile.column + (p - first) + 0.5, tiny = 1e-30, speed = speed_t + tiny;
          const double a = dot(w_t, along) / speed, b = dot(w_t, across) / speed;
          // Particles before this one, up to the edge from which the water comes.
          const double i = (a > 0 ? column : columns - column) / (std::abs(a) + tiny),
                       k = (b > 0 ? row : rows - row) / (std::abs(b) + tiny);
          // The layer over the cloth of this particle: from x - half to x + half.
          const double x = side * std::min(i, k), half = r / (std::max(std::abs(a), std::abs(b)) + tiny);
          double U = speed;
          if (width)
            for (int turn = 0; turn < 3; ++turn) {
              const double D = layer_drag(x, nu / U, transition);
              const double q = D / std::sqrt(4 * std::numbers::pi * (width[p] * width[p] + D * D / (1.328 * 1.328)));
              U = speed / (1 - q);
            }
          const double begin = x < 1.001 * half ? 0 : x - half;  // round-off before the edge would count: D is steep there
          const double D = layer_drag(x + half, nu / U, transition) - layer_drag(begin, nu / U, transition);
          K_t += 0.5 * D / half * U * U / speed;
          K_n += slow;
        }
        K_n *= 0.5 * rho * area, K_t *= rho * area;
        const Vec3 along_normal = K_n * through * n;
        // Both sides of the sheet are in C_t rho = 2 C_t rho/2.
        force.x[p] = rest * force.x[p] + here * (along_normal.x + K_t * w_t.x);
        force.y[p] = rest * force.y[p] + here * (along_normal.y + K_t * w_t.y);
        force.z[p] = rest * force.z[p] + here * (along_normal.z + K_t * w_t.z);
        slope[p] = rest * slope[p] + here * std::max(K_n, K_t);
        if (screen) screen[p] = here * hindrance;
      }
    }
  }

 public:
  std::vector<ReferenceCase> reference_cases() const override {
    auto broadside = drag_at(1e4, 0, 1e-12, "Hoerner (1965), chapter 3: plate across the flow, C_d = 1.17");
    const double d = broadside.state.diameter, speed = norm(broadside.state.velocity);
    broadside.state.next_in_row = {0, d, 0}, broadside.state.next_row = {0, 0, d};
    broadside.force = {0.5 * broadside.state.fluid_density * 1.17 * d * d * speed * speed, 0, 0};
    return {broadside};
  }
};
[[maybe_unused]] const bool registered = fluid_forces().add<SheetDrag>();

}  // namespace
}  // namespace snag
