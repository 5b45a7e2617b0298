// Nearly spherical drop with surfactant: the rates of change of the second harmonics of shape and concentration, (3.19), and the steady shape in a
// slow uniaxial extension, (3.20).

#include <cmath>

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include "membrane/mass.hpp"
#include "membrane/surfactant.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"
#include "system/coupled_motion.hpp"
#include "tests/evolution.hpp"
#include "tests/membrane_totals.hpp"
#include "tests/shape_measures.hpp"

namespace tanktread {
namespace surfactant_test {

/// Returns the matrix that maps (f, g) to d(f, g)/dt. `tension`: sigma at the concentration 1; mu = R_C = 1.
Eigen::Matrix2d theory(double lambda, double tension, double elasticity, double diffusivity) {
  Eigen::Matrix2d mobility, load, motion;
  mobility << 10 * (lambda + 1), 6 * (3 * lambda + 2), 3 * lambda + 2, 13 * lambda + 12;
  mobility /= (19 * lambda + 16) * (2 * lambda + 3);
  load << -4, 2 * elasticity, 0, -elasticity;
  motion << 1, 0, -2, 6;
  Eigen::Matrix2d rates = tension * motion * mobility * load;
  rates(1, 1) -= 6 * diffusivity;
  return rates;
}

struct Laden {
  Evolution scene;
  membrane::Surfactant surfactant;
  coupling::CoupledMotion motion;

  explicit Laden(std::vector<std::string> settings, double diffusivity)
      : scene([&] {
          settings.insert(settings.end(), {"Membrane/law=surface tension", "Time/scheme=rkc2", "Quadrature/tolerance=1e-7"});
          return settings;
        }()),
        surfactant(scene.body().space, scene.body().rest, *scene.scene.particles.front().surfactant, scene.scene.first().modulus(),
                   diffusivity),
        motion(*scene.capsule, {{0, &surfactant, "surfactant"}}) {}

  const spline::Space& space() const { return scene.body().space; }
  const Net& rest() const { return scene.body().rest; }

  /// Returns int N_A (n Y, Y) dGamma on the sphere. The first three columns belong to n Y.
  Eigen::MatrixX4d moments() const {
    Eigen::MatrixX4d sum = Eigen::MatrixX4d::Zero(space().n_points, 4);
    each_point([&](const spline::Element& element, const spline::Basis& basis, const surface::Point& p, double area) {
      const double y = harmonic(p.n);
      for (std::size_t a = 0; a < element.points.size(); ++a)
        sum.row(element.points[a]) += area * y * basis.value[static_cast<Eigen::Index>(a)] * Eigen::RowVector4d(p.n[0], p.n[1], p.n[2], 1);
    });
    return sum;
  }

  static double harmonic(const Vec3& n) { return 1.5 * n[2] * n[2] - 0.5; }

  template <class Use>
  void each_point(const Use& use) const {
    for (std::size_t e = 0; e < space().elements.size(); ++e) {
      const quadrature::TensorRule& rule = quadrature::tensor_gauss(5);
      for (int q = 0; q < rule.size(); ++q) {
        const surface::Point p = surface::point(space(), rest(), {static_cast<int>(e), rule.s[q], rule.t[q]});
        use(space().elements[e], spline::basis(space().elements[e], rule.s[q], rule.t[q]), p, rule.weights[q] * p.jacobian);
      }
    }
  }

  /// Returns the state y of the sphere with the displacement f Y n and the concentration 1 + g Y.
  coupling::State displaced(double f, double g) const {
    membrane::MassMatrix mass(space());
    const Eigen::SparseMatrix<double> m0 = mass.update(rest());
    const Eigen::MatrixX4d fields = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(m0).solve(moments());
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(space().n_points);
    const Net x = rest() + f * fields.leftCols<3>();
    coupling::State y = motion.state_of(x);
    const Eigen::VectorXd content = (mass.update(x) * (one + g * fields.col(3))).cwiseQuotient(m0 * one);
    y.set(motion.id(0), content);
    return y;
  }

  /// Returns d(f, g)/dt at the state y.
  Eigen::Vector2d rates(const coupling::State& y) {
    const double e = 1e-4;
    const coupling::State slope = motion.velocity(y);
    motion.set_state(y + e * slope);
    const Eigen::VectorXd after = surfactant.concentration();
    motion.set_state(y - e * slope);
    const Eigen::VectorXd c = (after - surfactant.concentration()) / (2 * e);
    const Eigen::MatrixX4d weights = moments();
    const double square = 4 * M_PI / 5;
    return {weights.leftCols<3>().cwiseProduct(motion.shape(slope)).sum() / square, weights.col(3).dot(c) / square};
  }

  Eigen::Matrix2d response() {
    const double h = 1e-3;
    Eigen::Matrix2d matrix;
    matrix.col(0) = (rates(displaced(h, 0)) - rates(displaced(-h, 0))) / (2 * h);
    matrix.col(1) = (rates(displaced(0, h)) - rates(displaced(0, -h))) / (2 * h);
    return matrix;
  }
};

struct Case {
  double viscosity_ratio;
  const char* motion;
};

class SurfactantOfASphere : public testing::TestWithParam<Case> {};

TEST_P(SurfactantOfASphere, RelaxesAtTheRatesOfTheTwoByTwoSystem) {
  const auto [lambda, motion] = GetParam();
  Laden drop({"Flow/type=quiescent", "Membrane/surface tension=1", "Particle/viscosity ratio=" + std::to_string(lambda),
              "Interface/surfactant/elasticity number=0.4", std::string("Interface/motion=") + motion, "Surface/elements per side=8",
              "Solvers/projection=least squares"},
             0.3);
  const Eigen::Matrix2d exact = theory(lambda, 0.6, 0.4 / 0.6, 0.3);
  EXPECT_LT((drop.response() - exact).cwiseAbs().maxCoeff(), 1e-4 * exact.cwiseAbs().maxCoeff()) << drop.response() << "\n\n" << exact;
}

INSTANTIATE_TEST_SUITE_P(Surfactant, SurfactantOfASphere,
                         testing::Values(Case{1, "relaxed"}, Case{1, "material"}, Case{0.2, "relaxed"}, Case{5, "relaxed"}));

TEST(Surfactant, TheFreeEnergyOfADropAtRestDecreases) {
  Laden drop({"Flow/type=quiescent", "Membrane/surface tension=1", "Interface/surfactant/elasticity number=0.4", "Particle/shape=spheroid",
              "Particle/semi-axes=[0.8, 0.8, 1.6]", "Surface/elements per side=4"},
             0.02);
  motion::TimeState state;
  state.x = drop.motion.start(drop.rest());
  const auto scheme = motion::integrator(drop.scene.scene.time);
  motion::begin(drop.motion, state);
  state.step = motion::first_step(drop.motion, state, drop.scene.scene.time);
  const auto energy = [&] {
    drop.motion.set_state(state.x);
    return membrane::energy(drop.scene.capsule->membrane(), drop.motion.shape(state.x)) + drop.surfactant.energy();
  };
  for (double before = energy(); state.time < 10; before = energy()) {
    scheme->advance(drop.motion, state, 10);
    EXPECT_LT(energy(), before) << state.time;
  }
  const auto [smallest, largest] = drop.surfactant.extremes();
  EXPECT_LT(largest - smallest, 0.1);
}

/// Returns the steady D/Ca.
double slope(double ca, double diffusivity, const std::vector<std::string>& equation) {
  std::vector<std::string> settings = {"Flow/type=uniaxial extension", "Surface/elements per side=5", "Solvers/projection=least squares",
                                       "Membrane/surface tension=" + std::to_string(1 / ca), "Time/tolerance=" + std::to_string(2e-4 * ca)};
  settings.insert(settings.end(), equation.begin(), equation.end());
  Laden drop(settings, diffusivity / ca);
  motion::TimeState state;
  state.x = drop.motion.start(drop.rest());
  const auto scheme = motion::integrator(drop.scene.scene.time);
  motion::begin(drop.motion, state);
  state.step = motion::first_step(drop.motion, state, drop.scene.scene.time);
  const double mass = drop.surfactant.mass(drop.motion.coefficients(state.x, 0));
  while (state.time < 60 * ca) scheme->advance(drop.motion, state, 60 * ca);
  EXPECT_NEAR(drop.surfactant.mass(drop.motion.coefficients(state.x, 0)) / mass, 1, 1e-13);  // round-off of a few hundred steps
  return surface::deformation(drop.scene.capsule->geometry(), drop.motion.shape(state.x)).taylor_inertia / ca;
}

class SurfactantInExtension : public testing::TestWithParam<double> {};

TEST_P(SurfactantInExtension, DeformsADropAsInSmallDeformationTheory) {
  const double diffusivity = GetParam(), elasticity = 0.4 / 0.6, tension = 0.6;
  const std::vector<std::string> linear = {"Interface/surfactant/elasticity number=0.4"};
  const double coarse = slope(0.01, diffusivity, linear), middle = slope(0.005, diffusivity, linear), fine = slope(0.0025, diffusivity, linear);
  const double limit = (8 * fine - 6 * middle + coarse) / 3;  // extrapolated by a parabola through three values
  const double exact = 15. / 32 / tension * (35 * diffusivity + 4 * elasticity * tension) / (10 * diffusivity + elasticity * tension);
  EXPECT_NEAR(limit / exact, 1, 1e-4) << coarse << ' ' << middle << ' ' << fine;
}

INSTANTIATE_TEST_SUITE_P(Surfactant, SurfactantInExtension, testing::Values(0., 0.03));

}  // namespace surfactant_test
}  // namespace tanktread
