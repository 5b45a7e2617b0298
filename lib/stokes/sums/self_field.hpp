#pragma once
// Singular quadrature rules for the panels that contain the target.

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

/// Points of spline surfaces, each given on every element whose closure contains the point. Values are evaluated on the first of these elements.
using Sites = std::vector<std::vector<spline::Site>>;

/// A pair of a site and one of the panels that contain the site.
struct SelfPair {
  int panel = 0;
  quadrature::MetricBin bin;       ///< metric of the panel at the site, rounded to a bin; the rule was constructed for this bin
  quadrature::PolarOrders orders;  ///< higher orders of the rule if the panel is distorted, otherwise 0. If only the angular orders are 0, the rule
                                   ///< is a tensor Gauss rule of the radial order
  const PointTable* table = nullptr;  ///< rule; null if it has to be looked up
  std::vector<Pack> weights;      ///< weights of the rule times the area element of the unstressed surface
  std::vector<double> bernstein;  ///< Bernstein polynomials and their derivatives at the site: B_i(s), B_j(t), B_i'(s), B_j'(t)
  double s = 0, t = 0;
};

/// All pairs of a site and a panel that contains it, for a set of sites. The pairs share polar rules: one rule for each combination of position on
/// the panel, degree and rounded metric.
class SelfField {
 public:
  SelfField(const spline::Space& space, const Sites& sites, const quadrature::Options& options);

  /// Returns the pairs of site i and a panel that contains it, one pair per panel.
  std::span<SelfPair> operator[](int i) { return {&pairs_[first_[i]], first_[i + 1] - first_[i]}; }

  /// Calls use(some, first) for parts of `sites` in their order, where `some` are the sites from index `first` on. During a call, the pairs of these
  /// sites have the singular quadrature rules (SelfPair::table) for the current metrics at the sites. If a rule has changed, the stored weights of
  /// the
  /// pair have been discarded. A part has as many sites as there is memory for rules; its number of sites is a multiple of `multiple`, except in the
  /// last part. If has_singular_rules is false, calls use(sites, 0).
  template <class Use>
  void with_rules(std::span<const int> sites, std::size_t multiple, const Panels& panels, const std::vector<double>& bezier, const Use& use) {
    for (std::size_t first = 0; first < sites.size();) {
      const std::span<const int> some = sites.subspan(first, prepare(sites.subspan(first), multiple, panels, bezier));
      use(some, first);
      first += some.size();
    }
  }

  /// Discards all stored weights.
  void forget_weights();

  /// value() returns the value at site i of the field with the Bezier points `bezier`, and tangents() its derivatives with respect to s and t, both
  /// on the first panel of the site.
  Vec3 value(int i, const Panels& panels, const std::vector<double>& bezier) const;
  std::pair<Vec3, Vec3> tangents(int i, const Panels& panels, const std::vector<double>& bezier) const;

  /// Returns the first panel that contains site i, and the values N_A at the site of the basis functions supported on this panel.
  std::pair<int, Eigen::VectorXd> basis(int i, const Panels& panels) const;

 private:
  std::size_t prepare(std::span<const int> sites, std::size_t multiple, const Panels& panels, const std::vector<double>& bezier);
  void choose(SelfPair& pair, const Panels& panels, const std::vector<double>& bezier) const;
  void fill(const SelfPair& pair, int degree, PointTable& table) const;
  void forget_rules();
  quadrature::PolarOrders raised_orders(const SelfPair& pair, int degree, const double* bezier, quadrature::MetricBin bin, const Vec3& a1,
                                        const Vec3& a2) const;

  quadrature::Options options_;
  int radial_;
  std::vector<std::size_t> first_;
  std::vector<SelfPair> pairs_;
  struct Key {
    int degree;
    double s, t;
    quadrature::MetricBin bin;
    quadrature::PolarOrders orders;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, std::unique_ptr<PointTable>> tables_;
  std::size_t points_ = 0;  // number of points of all rules
};

}  // namespace tanktread::stokes
