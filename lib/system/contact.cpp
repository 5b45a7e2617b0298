#include "system/contact.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "spline/basis.hpp"

namespace tanktread::coupling {

double Contacts::force() const {
  return std::accumulate(all.begin(), all.end(), 0., [](double sum, const Contact& one) { return sum + one.force; });
}

void Contacts::add_columns(Columns& to) const {
  to.add(force(), {"contact_force", "force",
                   "sum of the contact forces of Contact/limiter between all particles in the time step that ended at this time; 0 if the "
                   "fluid kept the gaps open"});
  to.add(impulse, {"contact_impulse", "force time", "time integral of `contact_force` since the start of the run"});
}

void add_work(std::span<const Particle> particles, const Contact& contact, double force, Net& work) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Particle& particle = particles[contact.particle[k]];
    const auto& [element, s, t] = contact.site[k];
    const spline::Element& at = particle.space->elements[static_cast<std::size_t>(element)];
    const Eigen::VectorXd shares = spline::basis(at, s, t, 0).value;
    auto rows = particle.block.rows(work);
    for (Eigen::Index a = 0; a < shares.size(); ++a)
      rows.row(at.points[static_cast<std::size_t>(a)]) += (k == 0 ? -force : force) * shares[a] * contact.normal.transpose();
  }
}

Net work(std::span<const Particle> particles, const Contacts& contacts, Eigen::Index n_points) {
  Net sum;
  if (!contacts.all.empty()) sum.setZero(n_points, 3);
  for (const Contact& one : contacts.all) add_work(particles, one, one.force, sum);
  return sum;
}

namespace {

/// Returns the contact forces f with A f + q = 0 (gap exactly closed) in the rows of the contacts `active`, and f = 0 in all other rows.
Eigen::VectorXd forces(const Eigen::MatrixXd& a, const Eigen::VectorXd& q, const std::vector<int>& active) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(q.size());
  if (active.empty()) return f;
  const Eigen::MatrixXd of_active = a(active, active);
  const Eigen::VectorXd right = -q(active), found = of_active.partialPivLu().solve(right);
  f(active) = found;
  return f;
}

}  // namespace

Eigen::VectorXd complementary(const Eigen::MatrixXd& a, const Eigen::VectorXd& q) {
  const Eigen::Index n = q.size();
  const double small = 1e-12 * q.cwiseAbs().maxCoeff();
  std::vector<int> active;
  const Eigen::Index most = 1000 * n;
  for (Eigen::Index pivot = 0; pivot < most; ++pivot) {
    const Eigen::VectorXd f = forces(a, q, active), open = a * f + q;
    const auto wrong = [&](int k) { return std::ranges::binary_search(active, k) ? f[k] < 0 : open[k] < -small; };
    int k = 0;
    while (k < n && !wrong(k)) ++k;
    if (k == n) return f;
    const auto at = std::ranges::lower_bound(active, k);
    if (at != active.end() && *at == k)
      active.erase(at);
    else
      active.insert(at, k);
  }
  return Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace tanktread::coupling
