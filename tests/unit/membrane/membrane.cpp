#include "membrane/membrane.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "capsules.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "tests/assembled_tangent.hpp"

namespace tanktread::membrane {
namespace membrane_test {

const std::vector<Law> laws = {NeoHookean{1.3}, Skalak{1.3, 2.5}, SurfaceTension{1.3}};

TEST(Membrane, LoadIsTheGradientOfTheEnergy) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 1);
  for (const Law& law : laws)
    for (int order : {3, 4, 6})  // usual and unusual orders use different code
      EXPECT_LT(gradient_error(Membrane(s.space, s.net, law, order), x, u), 1e-8);  // cancellation in the sum over random u
}

TEST(Membrane, TangentIsTheGradientOfTheLoad) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 2);
  for (const Law& law : laws) EXPECT_LT(tangent_error(Membrane(s.space, s.net, law), s, x, u), 1e-9);
}

TEST(Membrane, TangentIsSymmetricAndInvariantUnderRigidMotions) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 3), v = random_net(x.rows(), 4);
  for (const Law& law : laws) {
    const Membrane membrane(s.space, s.net, law);
    Tangent tangent(membrane);
    tangent.update(x, s.elements);
    Net hu, hv, moved;
    tangent.apply(u, hu);
    tangent.apply(v, hv);
    EXPECT_NEAR(inner(v, hu), inner(u, hv), 1e-13 * hu.norm() * v.norm());  // round-off
    tangent.apply(Net::Ones(x.rows(), 3), moved);
    EXPECT_LT(moved.norm(), 1e-12 * hu.norm());
    const Vec3 spin(0.3, -0.5, 0.8);
    Net turn = x, turned = membrane.load(x);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      turn.row(i) = spin.cross(Vec3(x.row(i)));
      turned.row(i) = spin.cross(Vec3(turned.row(i)));
    }
    tangent.apply(turn, moved);
    EXPECT_LT((moved - turned).norm(), 1e-12 * hu.norm());  // the load rotates with the membrane
  }
}

TEST(Membrane, AssembledTangentIsTheAppliedOne) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), u = random_net(x.rows(), 5);
  const Membrane membrane(s.space, s.net, Skalak{1, 2});
  Tangent tangent(membrane);
  tangent.update(x, s.elements);
  Net hu;
  tangent.apply(u, hu);
  const Eigen::VectorXd product = assembled_tangent(membrane, x) * Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
  EXPECT_LT((product - Eigen::Map<const Eigen::VectorXd>(hu.data(), hu.size())).norm(), 1e-13 * hu.norm());  // round-off
}

TEST(Membrane, ExertsNeitherForceNorTorqueAtAnyShape) {
  const Sphere& s = sphere(4);
  const Net x = deformed(s.net);
  for (const Law& law : laws) {
    const Net d = Membrane(s.space, s.net, law).load(x);
    Vec3 torque = Vec3::Zero();
    for (Eigen::Index i = 0; i < x.rows(); ++i) torque += Vec3(x.row(i)).cross(Vec3(d.row(i)));
    EXPECT_LT(d.colwise().sum().norm(), 1e-13 * d.norm());  // round-off
    EXPECT_LT(torque.norm(), 1e-13 * d.norm());
  }
}

TEST(Membrane, RowsDoNotDependOnHowElementsAreShared) {
  const Sphere& s = sphere(4);
  const Net x = deformed(s.net), u = random_net(x.rows(), 6);
  const Membrane membrane(s.space, s.net, NeoHookean{1});
  Tangent tangent(membrane);
  tangent.update(x, s.elements);
  Net whole = membrane.load(x), part, whole_tangent, part_tangent;
  tangent.apply(u, whole_tangent);
  std::vector<char> mine(s.space.n_points, 0), share;
  for (int i = 0; i < s.space.n_points / 3; ++i) mine[i] = 1;
  std::vector<int> elements;
  for (int e : s.elements)
    if (std::ranges::any_of(s.space.elements[e].points, [&](int a) { return mine[a]; })) elements.push_back(e);
  ASSERT_LT(elements.size(), s.elements.size());
  membrane.load(x, elements, part);
  tangent.update(x, elements);
  tangent.apply(u, part_tangent);
  for (int i = 0; i < s.space.n_points; ++i)
    if (mine[i]) {
      EXPECT_EQ(part.row(i), whole.row(i));  // bitwise
      EXPECT_EQ(part_tangent.row(i), whole_tangent.row(i));
    }
}

/// Compares with int dt . du = int de_ab tau^ab dGamma and (3.1), (3.2) as printed.
TEST(Membrane, LoadDoesTheVirtualWork) {
  const Sphere& s = sphere(3);
  const Net x = deformed(s.net), du = random_net(x.rows(), 7);
  const int order = 5;
  for (const Law& law : laws) {
    double work = 0;
    for (int e : s.elements) {
      const surface::ElementPoints before(s.space, s.net, e), now(s.space, x, e), by(s.space, du, e);
      const auto rule = quadrature::tensor_gauss(quadrature::gauss_order(order, s.space.elements[e].degree));
      for (int q = 0; q < rule.size(); ++q) {
        const auto metric = [](const surface::Jet& a, const surface::Jet& b) {
          Eigen::Matrix2d m;
          m << a.s.dot(b.s), a.s.dot(b.t), a.t.dot(b.s), a.t.dot(b.t);
          return m;
        };
        const surface::Jet jx = surface::jet(now.patch(), rule.s[q], rule.t[q]), jr = surface::jet(before.patch(), rule.s[q], rule.t[q]);
        const Eigen::Matrix2d g = metric(jx, jx), r = metric(jr, jr), mixed = metric(surface::jet(by.patch(), rule.s[q], rule.t[q]), jx);
        const double i1 = r.inverse().cwiseProduct(g).sum() - 2, i2 = g.determinant() / r.determinant() - 1, js = std::sqrt(1 + i2);
        const auto psi = std::visit([&](const auto& l) { return l.response(i1, i2); }, law);
        const Eigen::Matrix2d tau = 2 / js * psi.psi1 * r.inverse() + 2 * js * psi.psi2 * g.inverse();
        const Eigen::Matrix2d strain = (mixed + mixed.transpose()) / 2;
        work += rule.weights[q] * std::sqrt(g.determinant()) * tau.cwiseProduct(strain).sum();
      }
    }
    EXPECT_NEAR(inner(Membrane(s.space, s.net, law, order).load(x), du) / work, 1, 1e-12);  // round-off
  }
}

TEST(Membrane, IsUnstressedAtRest) {
  const Sphere& s = sphere(3);
  for (const Law& law : {Law(NeoHookean{1}), Law(Skalak{1, 3})}) {
    const Membrane membrane(s.space, s.net, law);
    EXPECT_LT(membrane.load(s.net).norm(), 1e-14);  // round-off
    EXPECT_NEAR(energy(membrane, s.net), 0, 1e-14);
    EXPECT_NEAR(tension_summary(membrane, s.net).smallest, 0, 1e-12);
    EXPECT_EQ(tension_summary(membrane, s.net).compressed_area, 0);
  }
}

TEST(Membrane, InflationStretchesUniformly) {
  const Sphere& s = sphere(3);
  const double area = surface::measures(s.space, s.net).area;
  for (double stretch : {0.9, 1.1, 1.6})
    for (const Law& law : laws) {
      const Membrane membrane(s.space, s.net, law, 8);
      const double tension = principal_tensions(law, stretch, stretch)[0];
      EXPECT_NEAR(energy(membrane, stretch * s.net) / (energy(law, stretch, stretch) * area), 1, 1e-6);  // quadrature error of the area
      const TensionSummary summary = tension_summary(membrane, stretch * s.net);
      EXPECT_NEAR(summary.smallest / (tension / modulus(law)), 1, 1e-12);  // round-off
      EXPECT_EQ(summary.compressed_area, tension < 0 ? 1 : 0);
      EXPECT_NEAR(summary.area_change, std::abs(stretch * stretch - 1), 1e-12);
      EXPECT_NEAR(summary.rms_area_change, summary.area_change, 1e-12);
    }
}

TEST(Membrane, PreInflationGivesTheStretchOnePlusAlpha) {
  const Sphere& s = sphere(3);
  const Vec3 centre(0.2, -0.1, 0.4);
  const Net rest = s.net.rowwise() + centre.transpose(), x = unstressed(rest, centre, 0.05);
  EXPECT_LT((x - ((s.net / 1.05).rowwise() + centre.transpose())).norm(), 1e-14);  // round-off
  const Membrane membrane(s.space, x, NeoHookean{1});
  EXPECT_NEAR(tension_summary(membrane, rest).smallest, principal_tensions(NeoHookean{1}, 1.05, 1.05)[0], 1e-12);  // round-off
}

/// Returns the principal tensions of a membrane at some sites, smaller first, divided by the modulus.
Eigen::MatrixX2d tensions_at(const Membrane& membrane, const Net& x, std::span<const spline::Site> sites) {
  std::vector<surface::Jet> before, now;
  for (const auto& [element, s, t] : sites) {
    before.push_back(surface::jet(surface::ElementPoints(membrane.space(), membrane.unstressed(), element).patch(), s, t));
    now.push_back(surface::jet(surface::ElementPoints(membrane.space(), x, element).patch(), s, t));
  }
  return tensions(membrane.law(), before, now);
}

/// For x = F X, the stretches at the pole on x3 are those of F in the x1 x2 plane.
TEST(Membrane, PrincipalTensionsOfAHomogeneousStretch) {
  const Sphere& s = sphere(4);  // a mesh with an even number of elements has a vertex on each axis
  int pole = 0;
  s.net.col(2).maxCoeff(&pole);
  const spline::Site site = s.space.collocation[pole][0];
  for (const Law& law : laws)
    for (const auto& [l1, l2] : {std::pair(1.3, 1.0), std::pair(0.9, 1.2), std::pair(1.4, 1.1)}) {
      const Net x = s.net * Vec3(l1, l2, 0.7).asDiagonal();
      auto expected = principal_tensions(law, l1, l2);
      if (expected[0] > expected[1]) std::swap(expected[0], expected[1]);
      const auto found = tensions_at(Membrane(s.space, s.net, law), x, std::span(&site, 1));
      EXPECT_NEAR(found(0, 0), expected[0] / modulus(law), 1e-12);  // round-off
      EXPECT_NEAR(found(0, 1), expected[1] / modulus(law), 1e-12);
    }
}

TEST(Membrane, SmallestTensionIsTheSmallestOfItsPoints) {
  const Sphere& s = sphere(4);
  const Net x = deformed(s.net);
  const Membrane membrane(s.space, s.net, NeoHookean{2});
  std::vector<spline::Site> sites;
  const auto& rule = quadrature::tensor_gauss(4);
  for (int e : s.elements)
    if (s.space.elements[e].degree == 3)
      for (int q = 0; q < rule.size(); ++q) sites.push_back({e, rule.s[q], rule.t[q]});
  const TensionSummary summary = tension_summary(membrane, x);
  EXPECT_LE(summary.smallest, tensions_at(membrane, x, sites).col(0).minCoeff() + 1e-12);  // Gauss points of other elements may have lower tensions
  EXPECT_NEAR(summary.smallest, tensions_at(membrane, x, sites).col(0).minCoeff(), 0.05);
  EXPECT_GT(summary.compressed_area, 0);
  EXPECT_LT(summary.compressed_area, 1);
}

}  // namespace membrane_test
}  // namespace tanktread::membrane
