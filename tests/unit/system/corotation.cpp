// Tests that frozen layer operators rotate with the particle for which they were assembled.

#include "system/frozen/frozen_layers.hpp"
#include "tests/states.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/system/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

/// Returns 20 points without symmetry.
Net cloud(double seed) {
  return Net::NullaryExpr(20, 3, [&](Eigen::Index i, Eigen::Index c) { return std::sin(seed + 3.7 * double(i) + 1.3 * double(c * c)); });
}

/// Returns two particles with 20 points each.
std::vector<Particle> two_particles() {
  std::vector<Particle> particles(2);
  particles[0].block = {0, 20, 0, 0};
  particles[1].block = {20, 20, 0, 0};
  return particles;
}

TEST(Corotation, FindsTheRotationOfEachParticle) {
  const std::vector<Particle> particles = two_particles();
  const Mat3 turns[] = {turn(2.5, {1, 2, 3}), turn(-0.8, {0, 1, -1})};
  Net from(40, 3), to(40, 3), field(40, 3), turned(40, 3);
  from << cloud(1), cloud(2);
  field << cloud(3), cloud(4);
  for (int p = 0; p < 2; ++p) {
    to.middleRows(20 * p, 20) = from.middleRows(20 * p, 20) * turns[p].transpose();
    to.middleRows(20 * p, 20).rowwise() += Eigen::RowVector3d(5, -3, p);
    turned.middleRows(20 * p, 20) = field.middleRows(20 * p, 20) * turns[p].transpose();
  }
  const Corotation corotation(particles, from, to);
  EXPECT_LT((corotation.forth(field) - turned).norm(), 1e-13);
  EXPECT_LT((corotation.back(turned) - field).norm(), 1e-13);
  EXPECT_LT(Corotation::deformation(particles, from, to).norm(), 1e-13);
}

TEST(Corotation, IsARotationEvenIfTheShapeIsMirrored) {
  const std::vector<Particle> particles = two_particles();
  Net from(40, 3);
  from << cloud(1), cloud(2);
  const Net mirrored = from * Vec3(-1, 1, 1).asDiagonal();
  const Net x = Net::Identity(40, 3);
  const Net f = Corotation(particles, from, mirrored).forth(x);
  EXPECT_NEAR(Mat3(f.topRows(3)).determinant(), 1, 1e-13);
}

TEST(Corotation, DeformationIsAStretchWithoutItsRotation) {
  std::vector<Particle> particles(1);
  particles[0].block = {0, 20, 0, 0};
  const Net from = cloud(1).rowwise() - cloud(1).colwise().mean(), stretched = from * Vec3(1.2, 1, 0.9).asDiagonal();
  const Net moved = (stretched * turn(0.6, {1, 0, 2}).transpose()).rowwise() + Eigen::RowVector3d(1, 1, 1);
  const double deformation = Corotation::deformation(particles, from, moved).norm();
  EXPECT_LE(deformation, (stretched - from).norm());  // the residual of the best rigid motion is at most that of the known motion
  EXPECT_GT(deformation, 0.5 * (stretched - from).norm());
}

// A sphere is rotated and then slightly stretched. Operators assembled before the rotation are as accurate as operators assembled on the new shape.
// Without corotation the result differs by a tenth.
TEST(Corotation, OperatorsOfARotatedCapsuleEqualNewlyAssembledOnes) {
  for (const char* frozen : {"nodal", "assembled"})
    for (const double ratio : {1.0, 5.0}) {
      SphereInFlow f(3, "quiescent");
      f.parameters.particles.front().material.law = membrane::NeoHookean{2.5};
      f.parameters.particles.front().viscosity_ratio = ratio;
      f.parameters.solvers.frozen_operator = frozen;
      Net stretched = f.sphere * Vec3(1.3, 1, 0.8).asDiagonal();
      const Mat3 q = turn(1.1, {1, -2, 0.5});
      const Net turned = stretched * q.transpose();
      Net r(stretched.rows(), 3);
      for (Eigen::Index i = 0; i < r.rows(); ++i) r.row(i) << stretched(i, 1), std::sin(2 * stretched(i, 2)), stretched(i, 0) * stretched(i, 1);
      Capsule capsule = f.capsule();
      const double shift = 0.3;
      capsule.freeze(turned);
      capsule.linearise(turned);
      const Net fresh = implicit_step(capsule, shift, r, 1e-8);
      capsule.freeze(stretched);
      capsule.linearise(turned);
      const Net followed = implicit_step(capsule, shift, r, 1e-8);
      EXPECT_LT((followed - fresh).norm(), 4e-3 * fresh.norm()) << frozen << " " << ratio;  // entries are rounded to 2^-9
    }
}

}  // namespace
}  // namespace tanktread::coupling
