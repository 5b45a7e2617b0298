#include "stokes/layer_surface.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "quadrature/ellipse.hpp"
#include "stokes/sums/layer_rule.hpp"

namespace tanktread::stokes {
namespace {

/// An element whose relative size (see shares()) is below this value gets fewer Gauss points of the far rule (see far_orders()).
constexpr double small = 0.6;

/// Returns the number of Gauss points per direction of the far rule. The number was chosen from errors measured on deformed capsules with 3, 6 and 12
/// elements per side of the cube mesh (tests/verify/layers.cpp). Targets off the surface need fewer points, because near rules replace the far rule
/// at small distances: with three points the far sum has an error of 1e-8 to 2e-7 (tests/verify/tube_gap.cpp).
int far_order(const quadrature::Options& options, bool on_surface = true) {
  if (!properties(options.rule).follows_tolerance) return options.points;
  if (options.tolerance >= (on_surface ? 1e-4 : 1e-5)) return 3;
  if (options.tolerance >= 1e-6) return 4;
  if (options.tolerance >= 1e-8) return 6;
  if (options.tolerance >= 1e-9) return 7;
  return options.tolerance >= 1e-10 ? 9 : 11;
}

/// Returns for each element its parametric size divided by the mean parametric spacing of the control points around it. The squared spacing is the
/// mean parametric area per control point. The ratio is 1 on a uniform mesh.
std::vector<double> shares(const spline::Space& space) {
  std::vector<double> area(space.n_points, 0);  // per control point
  for (const spline::Element& e : space.elements) {
    const double each = e.size[0] * e.size[1];
    for (std::size_t a = 0; a < e.points.size(); ++a) area[e.points[a]] += each * e.extraction->row(static_cast<Eigen::Index>(a)).mean();
  }
  std::vector<double> out;
  for (const spline::Element& e : space.elements) {
    double around = 0;
    for (std::size_t a = 0; a < e.points.size(); ++a) around += area[e.points[a]] * e.extraction->row(static_cast<Eigen::Index>(a)).mean();
    out.push_back(std::sqrt(e.size[0] * e.size[1] / around));
  }
  return out;
}

/// Returns the number of Gauss points per direction of the far rule for each element. Fewer points suffice on elements that are small compared with
/// the spacing of the surrounding targets: elements next to extraordinary points of Catmull-Clark surfaces, and bisected elements at T-junctions. On
/// a small element the integrand is smoother, and the error counts less because the area is small. These elements keep enough points for half the
/// digits of the tolerance, because the shape of elements next to extraordinary points requires them (tests/verify/layers.cpp).
std::vector<int> far_orders(const spline::Space& space, const quadrature::Options& options, int order) {
  std::vector<int> orders(space.elements.size(), order);
  if (!properties(options.rule).follows_tolerance) return orders;
  const double rho = std::pow(options.tolerance, -0.5 / order);
  const int least = std::clamp(static_cast<int>(-0.5 * std::log10(options.tolerance) + 1e-9), 1, order);
  const std::vector<double> share = shares(space);
  for (std::size_t e = 0; e < share.size(); ++e)
    if (share[e] < small)
      orders[e] = std::clamp(quadrature::order_for(options.tolerance / (share[e] * share[e]), rho / share[e]), least, order);
  return orders;
}

/// Returns the number of far nodes above which clusters are faster than direct sums: about twice the number of kernel evaluations per target that
/// clusters need on a large surface. The number of evaluations grows with the square of the number of digits of the tolerance (measured by
/// tests/benchmark/growth.cpp).
double nodes_worth_a_tree(double tolerance) { return 1000 * std::pow(std::log10(tolerance), 2); }

}  // namespace

bool sums_by_tree(double nodes, const quadrature::Options& options) {
  if (options.far_sum != "auto") return options.far_sum == "tree";
  // Without singular rules the singularity is subtracted by two identities (see Layer), which must be summed over all pairs of nodes and targets.
  // Clusters would save little.
  if (!properties(options.rule).has_singular_rules) return false;
  return nodes > nodes_worth_a_tree(options.tolerance);
}

bool sums_by_tree(const spline::Space& space, const quadrature::Options& options, int images) {
  double nodes = 0;
  for (const int order : far_orders(space, options, far_order(options))) nodes += images * order * order;
  return sums_by_tree(nodes, options);
}

LayerSurface::LayerSurface(const spline::Space& space, const Sites& sites, const quadrature::Options& how, bool steep)
    : options(how),
      n_points(space.n_points),
      n_sites(static_cast<int>(sites.size())),
      panels(space, far_orders(space, how, far_order(how, !sites.empty()))),
      near_field(panels, how.tolerance, far_order(how, !sites.empty()), steep, sites.empty()),
      self_field(space, sites, how) {
  set_symmetry(surface::Symmetry(space.n_points));
}

void LayerSurface::repeat() {
  if (near_field.repeat()) placed_.resize(0, 3);
}

void LayerSurface::set_symmetry(const surface::Symmetry& symmetry) {
  const auto points = [&](int e) { return std::span(panels.points(e), static_cast<std::size_t>(panels[e].functions)); };
  fundamental_ = surface::fundamental_elements(symmetry, panels.size(), points);
  images_.source.resize(panels.size());
  images_.image.assign(panels.size(), -1);
  images_.reflections.clear();
  for (const surface::Image& g : symmetry.images()) images_.reflections.push_back({g.signs, {}});
  for (const int e : fundamental_.element) {
    for (std::size_t g = 0; g < symmetry.images().size(); ++g) {
      const int other = symmetry.images()[g].element[e];
      images_.source[other] = e;
      if (other != e) images_.image[other] = static_cast<int>(g);
    }
    images_.source[e] = e;
  }
  placed_.resize(0, 3);
}

bool LayerSurface::set_shape(const Net& x) {
  if (same(x, placed_)) return false;
  placed_ = x;
  panels.bezier(x, bezier);
  node_values(panels, bezier, node);
  for (surface::Reflection& image : images_.reflections) image.middle = x.colwise().mean().transpose();
  if (properties(options.rule).corrects_near) near_field.update(bezier, images_);
  return true;
}

std::span<SelfPair> LayerSurface::self_pairs(int i) {
  if (!properties(options.rule).has_singular_rules) return {};
  return self_field[i];
}

const std::vector<int>& LayerSurface::near(const Vec3& target, std::span<const SelfPair> self_pairs) const {
  std::vector<int>& found = near_.mine();
  found.clear();
  if (properties(options.rule).corrects_near) near_field.list(target, self_pairs, found);
  return found;
}

void LayerSurface::set_sources_of(TreeSum& tree, std::span<const Vec3> targets) const {
  std::vector<int> starts{0};
  std::vector<double> place[3];
  for (const int e : fundamental_.element) {
    const auto first = panels[e].first_node, last = first + panels[e].table->n_nodes;
    for (int c = 0; c < 3; ++c) place[c].insert(place[c].end(), node[c].begin() + first, node[c].begin() + last);
    starts.push_back(starts.back() + last - first);
  }
  tree.set_sources(place, starts, targets, images_.reflections);
}

}  // namespace tanktread::stokes
