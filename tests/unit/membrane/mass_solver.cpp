#include "membrane/mass_solver.hpp"

#include <gtest/gtest.h>

#include "capsules.hpp"
#include "membrane/mass.hpp"

namespace tanktread::membrane {
namespace {

TEST(MassSolver, SolvesOnADeformedSurfaceWithTheFactorsOfTheUnstressedOne) {
  const Sphere& s = sphere(6);
  MassMatrix mass(s.space);
  MassSolver solver;
  solver.factor(mass.update(s.net));
  Net d = random_net(s.space.n_points, 11);
  d.col(1).setZero();                                                              // a component without a load is solved at once
  EXPECT_LT((mass.update(s.net) * solver.solve(d) - d).norm(), 1e-13 * d.norm());  // round-off
  const Eigen::SparseMatrix<double>& now = mass.update(deformed(s.net));
  EXPECT_LT((now * solver.solve(now, d) - d).norm(), 3e-13 * d.norm());  // the solver's tolerance
  EXPECT_GT(solver.iterations(), 0);
  EXPECT_LT(solver.iterations(), 25);  // 13 to 17 for this strongly varying stretch at n = 6
  EXPECT_EQ(solver.solve(now, d).col(1).norm(), 0);
}

TEST(MassSolver, FactorsAgainIfTheUnstressedSurfaceIsTooDifferent) {
  const Sphere& s = sphere(3);
  MassMatrix mass(s.space);
  MassSolver solver;
  solver.factor(mass.update(s.net));
  Net crumpled = s.net;
  for (Eigen::Index i = 0; i < crumpled.rows(); i += 3) crumpled.row(i) *= 30;
  const Eigen::SparseMatrix<double>& now = mass.update(crumpled);
  const Net d = random_net(s.space.n_points, 12);
  EXPECT_LT((now * solver.solve(now, d) - d).norm(), 1e-11 * d.norm());  // round-off times the condition
}

}  // namespace
}  // namespace tanktread::membrane
