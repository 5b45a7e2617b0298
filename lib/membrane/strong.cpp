// The strong form of the load, t = -div_s tau (equation 3 of Maestre et al. 2017), by dual numbers.

#include <Eigen/Geometry>

#include "membrane/dual.hpp"
#include "membrane/membrane.hpp"
#include "surface/patch.hpp"

namespace tanktread::membrane {
namespace {

using Number = Dual<double>;
using Tangents = std::array<Vector<Number>, 2>;
Vector<Number> with_slope(const Vec3& v, const Vec3& d) { return {Number{v[0], d[0]}, Number{v[1], d[1]}, Number{v[2], d[2]}}; }

// Returns the vector sqrt(g) tau^ab g_b for a = `row` (0: s, 1: t), from the tangents X_,s X_,t of the unstressed surface in `r` and the tangents
// x_,s x_,t of the current surface in `a`.
template <class AnyLaw>
Vector<Number> flux(const AnyLaw& law, const Tangents& r, const Tangents& a, int row) {
  const Number r11 = dot(r[0], r[0]), r12 = dot(r[0], r[1]), r22 = dot(r[1], r[1]), inverse = 1.0 / (r11 * r22 - r12 * r12);
  const Number a11 = dot(a[0], a[0]), a12 = dot(a[0], a[1]), a22 = dot(a[1], a[1]);
  const Number i1 = (r22 * a11 - 2.0 * r12 * a12 + r11 * a22) * inverse - 2.0, i2 = (a11 * a22 - a12 * a12) * inverse - 1.0;
  const Response<Number> psi = law.response(i1, i2);
  const Number scale = 2.0 * sqrt(inverse);  // 2 sqrt|G|, times the factor 1/|G| of the cofactors in the next lines
  const Number same = scale * (psi.psi1 * (row == 0 ? r22 : r11) + psi.psi2 * (row == 0 ? a22 : a11));
  const Number mixed = scale * (psi.psi1 * (-r12) + psi.psi2 * (-a12));
  Vector<Number> sum;
  for (int c = 0; c < 3; ++c) sum[c] = same * a[row][c] + mixed * a[1 - row][c];
  return sum;
}

}  // namespace

// Computes -1/sqrt(g) (sqrt(g) tau^ab g_b),a.
Vec3 Membrane::strong_load(const Net& x, const spline::Site& site) const {
  const surface::Jet before = surface::jet(surface::ElementPoints(*space_, unstressed_, site.element).patch(), site.s, site.t);
  const surface::Jet now = surface::jet(surface::ElementPoints(*space_, x, site.element).patch(), site.s, site.t);
  return std::visit(
      [&](const auto& l) {
        const auto by_s = flux(l, {with_slope(before.s, before.ss), with_slope(before.t, before.st)},
                               {with_slope(now.s, now.ss), with_slope(now.t, now.st)}, 0);
        const auto by_t = flux(l, {with_slope(before.s, before.st), with_slope(before.t, before.tt)},
                               {with_slope(now.s, now.st), with_slope(now.t, now.tt)}, 1);
        Vec3 t;
        for (int c = 0; c < 3; ++c) t[c] = -(by_s[c].slope + by_t[c].slope);
        return Vec3(t / now.s.cross(now.t).norm());
      },
      law(site.element));
}

void Membrane::strong_load(const Net& x, std::span<const int> targets, Net& t) const {
  for (int target : targets) {
    const std::vector<spline::Site>& sites = space_->collocation[target];
    Vec3 sum = Vec3::Zero();
    for (const spline::Site& site : sites) sum += strong_load(x, site);
    t.row(target) = sum.transpose() / static_cast<double>(sites.size());
  }
}

}  // namespace tanktread::membrane
