// Tests that the derivatives of fields used by implicit steps are those of their load and rate.

#include <memory>

#include <gtest/gtest.h>

#include "capsules.hpp"
#include "membrane/mass.hpp"
#include "membrane/maxwell_element.hpp"
#include "membrane/surfactant.hpp"

namespace tanktread::membrane {
namespace {

std::unique_ptr<Field> field(const std::string& name, const Sphere& s, double diffusivity = 0.3) {
  if (name == "Maxwell") return std::make_unique<MaxwellElement>(s.space, s.net, 4, SurfaceViscosity{0.6, 1.4}, 0.5);
  SurfactantOptions options;
  options.elasticity = 0.3;
  if (name == "Langmuir") options.coverage = 0.4;
  return std::make_unique<Surfactant>(s.space, s.net, options, 1.3, diffusivity);
}

class FieldJacobian : public testing::TestWithParam<const char*> {};

TEST_P(FieldJacobian, IsTheDerivativeOfLoadAndRate) {
  const Sphere& s = sphere(3);
  const auto one = field(GetParam(), s);
  const Eigen::Index n = s.net.rows();
  const Net x = deformed(s.net), slip = random_net(n, 1), dx = random_net(n, 2), dslip = random_net(n, 3);
  Eigen::VectorXd q = one->start(s.net), dq(q.size());
  for (Eigen::Index k = 0; k < q.size(); ++k) q[k] += 0.1 * std::sin(k), dq[k] = std::cos(3. * k);
  one->set_state(x, q);
  one->linearise(slip);
  const Eigen::VectorXd values = one->value_change(dx, dq), rate = one->rate_change(dx, values, dslip);
  const Net load = one->load_change(dx, values);
  const double h = 1e-5;
  const auto at = [&](double part) {
    one->set_state(x + part * dx, q + part * dq);
    return std::pair(one->load(), one->rate(slip + part * dslip));
  };
  const auto [load_after, rate_after] = at(h);
  const auto [load_before, rate_before] = at(-h);
  EXPECT_LT((load - (load_after - load_before) / (2 * h)).norm(), 1e-7 * load.norm());  // h^2 times third derivatives, and 1e-13/h
  EXPECT_LT((rate - (rate_after - rate_before) / (2 * h)).norm(), 1e-7 * rate.norm());
}

TEST_P(FieldJacobian, IsInvertedBySolve) {
  const Sphere& s = sphere(3);
  const auto one = field(GetParam(), s);
  const Eigen::VectorXd q = one->start(s.net);
  one->set_state(s.net, q);
  one->linearise({});
  one->freeze(s.net);
  one->set_state(s.net, q);
  Eigen::VectorXd r(q.size());
  for (Eigen::Index k = 0; k < r.size(); ++k) r[k] = std::sin(2. * k);
  // a shift for which the surfactant's factors are exact: a power of 1.25 times the area, divided by the diffusivity
  const double shift = std::pow(1.25, -15) * MassMatrix(s.space).update(s.net).sum() / 0.3;
  const Eigen::VectorXd dq = one->solve(shift, r);
  const Net none = Net::Zero(s.net.rows(), 3);
  EXPECT_LT((dq - shift * one->rate_change(none, one->value_change(none, dq), {}) - r).norm(), 1e-11 * r.norm());
}

INSTANTIATE_TEST_SUITE_P(Fields, FieldJacobian, testing::Values("linear", "Langmuir", "Maxwell"));

}  // namespace
}  // namespace tanktread::membrane
