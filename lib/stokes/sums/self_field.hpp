#pragma once
// The rules of the panels that a target lies on.

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "quadrature/options.hpp"
#include "quadrature/polar.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/point_table.hpp"
#include "stokes/sums/panels.hpp"

namespace tanktread::stokes {

/// Points of spline surfaces, each with every element whose closure holds it; the first is the one to evaluate on.
using Sites = std::vector<std::vector<spline::Site>>;

/// A site on one of its panels.
struct SelfPair {
  int panel = 0;
  quadrature::Shear shear;         ///< the bin that its rule is made for
  quadrature::PolarOrders orders;  ///< and its orders, where the element is distorted; otherwise 0. Only radial: no polar rule
  const PointTable* table = nullptr;
  std::vector<Pack> weights;      ///< rule weights times the area of the unstressed surface
  std::vector<double> bernstein;  ///< B_i(s), B_j(t), B_i'(s), B_j'(t) at the site
  double s = 0, t = 0;
};

/// All such pairs of some sites, and the polar rules they share: one for each place on a panel, degree and bin of the metric.
class SelfField {
 public:
  SelfField(const spline::Space& space, const Sites& sites, const quadrature::Options& options);

  /// The pairs of site i.
  std::span<SelfPair> operator[](int i) { return {&pairs_[first_[i]], first_[i + 1] - first_[i]}; }

  /// The rule for the pair's panel in its present metric. Weights kept for another rule are thrown away.
  const PointTable& rule(SelfPair& pair, const Panels& panels, const std::vector<double>& bezier);

  /// Throws away all weights kept.
  void forget_weights();

  /// Value at site i of the field with these Bezier points, and its derivatives by s and t, from its first panel.
  Vec3 value(int i, const Panels& panels, const std::vector<double>& bezier) const;
  std::pair<Vec3, Vec3> tangents(int i, const Panels& panels, const std::vector<double>& bezier) const;

  /// The functions that live on the first panel of site i: panel and N_A there.
  std::pair<int, Eigen::VectorXd> basis(int i, const Panels& panels) const;

 private:
  const PointTable& made(const SelfPair& pair, int degree);
  void forget_rules();
  quadrature::PolarOrders raised_orders(const SelfPair& pair, int degree, const double* bezier, quadrature::Shear shear, const Vec3& a1,
                                        const Vec3& a2) const;

  quadrature::Options options_;
  int radial_;
  std::vector<std::size_t> first_;
  std::vector<SelfPair> pairs_;
  struct Key {
    int degree;
    double s, t;
    quadrature::Shear shear;
    quadrature::PolarOrders orders;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, std::unique_ptr<PointTable>> tables_;
};

}  // namespace tanktread::stokes
