// Tests of several capsules and drops in one system: their interactions, and properties that each particle keeps.

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"
#include "tests/states.hpp"

namespace tanktread::coupling {
namespace {

/// Kind of a particle: a stretched ellipsoid with its centre and material.
struct Kind {
  int elements_per_side;
  Vec3 centre;
  double viscosity_ratio;
  membrane::Law law;
  MeshMotion motion = MeshMotion::material;
};

/// Particles of the given kinds, in the given order.
struct Several {
  std::vector<spline::Space> spaces;
  spline::Space space;
  Net rest, x;
  CapsuleParameters parameters;
  Phases phases;

  explicit Several(const std::vector<Kind>& kinds) {
    std::vector<Net> nets;
    std::vector<const spline::Space*> all;
    for (const Kind& kind : kinds) {
      const spline::TMesh mesh = spline::cube(kind.elements_per_side);
      spaces.push_back(spline::space(mesh, spline::ExtraordinaryRule::g1));
      nets.push_back(surface::resting_shape(spaces.back(), mesh, {}));
    }
    for (const spline::Space& one : spaces) all.push_back(&one);
    space = spline::stacked(all);
    parameters.quadrature.tolerance = 1e-7;
    parameters.solvers.tolerance = 1e-11;
    parameters.particles.resize(kinds.size());
    const std::vector<spline::Block> blocks = spline::blocks(all);
    rest.resize(space.n_points, 3), x.resize(space.n_points, 3);
    for (size_t p = 0; p < kinds.size(); ++p) {
      Particle& particle = parameters.particles[p];
      particle.space = &spaces[p], particle.block = blocks[p];
      particle.viscosity_ratio = kinds[p].viscosity_ratio, particle.material.law = kinds[p].law;
      particle.interface_motion = kinds[p].motion, particle.interface_speed = 1;
      if (std::holds_alternative<membrane::SurfaceTension>(kinds[p].law)) particle.measure = stokes::Measure::current;
      Net stretched = nets[p];
      stretched.col(0) *= 1.1, stretched.col(2) *= 0.95;
      blocks[p].rows(rest) = nets[p].rowwise() + kinds[p].centre.transpose();
      blocks[p].rows(x) = stretched.rowwise() + kinds[p].centre.transpose();
    }
  }

  Capsule system(const char* type = "simple shear") {
    stokes::FlowOptions flow;
    flow.type = type;
    return Capsule(space, rest, rest, stokes::AmbientFlow(flow), parameters, phases);
  }
  Net velocity_of(size_t p, const Net& v) const { return parameters.particles[p].block.rows(v); }
};

const membrane::Law soft = membrane::NeoHookean{2}, hard = membrane::Skalak{3, 1}, tension = membrane::SurfaceTension{4};

TEST(SeveralParticles, FarApartMoveLikeSingleParticles) {
  const Kind capsule{3, Vec3(0, 0, 0), 5, hard}, drop{4, Vec3(0, 1e4, 0), 0.2, tension, MeshMotion::relaxed};
  Several both({capsule, drop});
  const Net v = both.system().velocity(both.x);
  for (size_t p = 0; p < 2; ++p) {
    Several one({p == 0 ? capsule : drop});
    EXPECT_LT((both.velocity_of(p, v) - one.system().velocity(one.x)).lpNorm<Eigen::Infinity>(), 1e-7) << p;  // decreases with the square of the
                                                                                                              // distance
  }
}

TEST(SeveralParticles, DoNotDependOnTheirOrder) {
  const Kind drop{4, Vec3(0.2, 2.3, 0.1), 0.5, tension, MeshMotion::relaxed};
  const std::vector<Kind> kinds{{3, Vec3(0, 0, 0), 5, hard}, drop, {3, Vec3(-2.5, 0, 0.3), 1, soft}};
  Several one(kinds), other({kinds[2], kinds[0], kinds[1]});
  const Net v = one.system().velocity(one.x), w = other.system().velocity(other.x);
  const size_t place[3] = {1, 2, 0};
  for (size_t p = 0; p < 3; ++p) EXPECT_LT((one.velocity_of(p, v) - other.velocity_of(place[p], w)).lpNorm<Eigen::Infinity>(), 1e-9) << p;
}

TEST(SeveralParticles, ConserveTheirVolumes) {
  Several pair({{3, Vec3(0, 0, 0), 2, soft}, {4, Vec3(0, 0, 2.4), 0.5, hard}});
  Capsule system = pair.system();
  Net x = pair.x;
  system.restore_constraints(x);
  const Net v = system.velocity(x), flux = system.geometry().volume_gradient(x);
  for (size_t p = 0; p < 2; ++p) {
    EXPECT_NEAR(system.volume_error(surface::volume(pair.spaces[p], pair.velocity_of(p, x)), p), 0, 1e-14) << p;
    EXPECT_NEAR(pair.velocity_of(p, flux).cwiseProduct(pair.velocity_of(p, v)).sum(), 0, 1e-10) << p;
  }
}

/// Two equal particles at r and -r move point-symmetrically, although the system does not use this symmetry.
TEST(SeveralParticles, OfEqualShapeMoveSymmetrically) {
  const Vec3 r(1.1, 0.2, 0.3);
  Several pair({{3, r, 5, soft}, {3, -r, 5, soft}});
  const Net v = pair.system().velocity(pair.x), first = pair.velocity_of(0, v), second = pair.velocity_of(1, v);
  const Net x0 = pair.velocity_of(0, pair.x), x1 = pair.velocity_of(1, pair.x);
  double largest = 0;
  for (Eigen::Index i = 0; i < x0.rows(); ++i) {
    Eigen::Index j;
    (x1.rowwise() + x0.row(i)).rowwise().squaredNorm().minCoeff(&j);
    largest = std::max(largest, (first.row(i) + second.row(j)).norm());
  }
  EXPECT_LT(largest, 1e-6);  // tolerance of the quadrature
}


TEST(SeveralParticles, OfEqualMaterialShareIt) {
  const Several three({{3, Vec3(0, 0, 0), 5, soft}, {3, Vec3(4, 0, 0), 1, hard}, {3, Vec3(8, 0, 0), 1, soft}});
  const membrane::Materials all = materials(three.parameters.particles);
  ASSERT_EQ(all.all.size(), 2u);
  EXPECT_EQ(all.all[0].law, soft);
  EXPECT_EQ(all.all[1].law, hard);
  ASSERT_EQ(all.of_element.size(), three.space.elements.size());
  for (std::size_t e = 0; e < all.of_element.size(); ++e) EXPECT_EQ(all.of_element[e], 3 * e / all.of_element.size() == 1 ? 1 : 0);
  EXPECT_TRUE(materials(std::span(three.parameters.particles).first(1)).of_element.empty());
}

TEST(SeveralParticles, JacobianIsTheDerivative) {
  Several pair({{3, Vec3(0, 0, 0), 5, soft}, {3, Vec3(0.3, 0, 2.6), 1, hard}});
  Capsule system = pair.system();
  const Net v = system.velocity(pair.x);
  Net delta(pair.x.rows(), 3);
  for (Eigen::Index i = 0; i < delta.rows(); ++i) delta.row(i) << std::sin(2. * pair.x(i, 2)), pair.x(i, 0) * pair.x(i, 1), std::cos(pair.x(i, 1));
  delta *= 1e-4 / system.norm(delta);
  system.freeze(pair.x);
  system.linearise(pair.x);
  const Net told = derivative_along(system, pair.x, v, delta), found = system.velocity(pair.x + delta) - v;
  EXPECT_LT((told - found).norm(), 0.3 * found.norm());  // contribution of the change of the frozen layer operator
}

}  // namespace
}  // namespace tanktread::coupling
