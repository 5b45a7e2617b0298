#include "surface/symmetry.hpp"

#include <algorithm>
#include <cmath>

#include "base/indices.hpp"
#include "spline/point_search.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

Vec3 middle(const Net& net) { return (net.colwise().maxCoeff() + net.colwise().minCoeff()).transpose() / 2; }

namespace {

constexpr double exact = 1e-10, close = 1e-9;

constexpr Turn turns[8] = {{false, {false, false}}, {false, {true, false}}, {false, {false, true}}, {false, {true, true}},
                           {true, {false, false}},  {true, {true, false}},  {true, {false, true}},  {true, {true, true}}};

Vec3 reflected(const Vec3& x, const Vec3& centre, const Vec3& signs) { return centre + signs.cwiseProduct(x - centre); }

using Keeps = std::function<bool(const Image&)>;

/// Searches for reflections that map a space and its nets onto themselves. Data that all searches need are computed once.
class ImageSearch {
 public:
  ImageSearch(const spline::Space& space, std::span<const Net* const> nets)
      : space_(space), nets_(nets), centre_(middle(*nets[0])),
        size_((nets[0]->colwise().maxCoeff() - nets[0]->colwise().minCoeff()).maxCoeff()), map_(space), bezier_(space.elements.size()),
        points_(rows(*nets[0]), exact * size_), centres_(centres(), close * size_) {}

  /// Returns the reflection with these signs of the coordinates, with its permutations of points and elements, if it maps the surface onto itself and
  /// `keeps` accepts it; otherwise nothing.
  std::optional<Image> image(const Vec3& signs, const Keeps& keeps) {
    image_ = {signs, {}, {}, {}};
    if (!points() || !keeps(image_) || !elements() || !sites()) return {};
    return std::move(image_);
  }

 private:
  static std::vector<Vec3> rows(const Net& net) {
    std::vector<Vec3> places;
    for (Eigen::Index a = 0; a < net.rows(); ++a) places.push_back(net.row(a).transpose());
    return places;
  }

  std::vector<Vec3> centres() {
    std::vector<Vec3> places;
    for (int e = 0; e < map_.n_elements(); ++e) {
      bezier_[e].resize(map_.n_bezier(e), 3);
      map_.points(e, *nets_[0], bezier_[e].data());
      places.push_back(bezier_[e].colwise().mean().transpose());
    }
    return places;
  }

  bool points() {
    for (const Vec3& x : points_.all()) {
      image_.point.push_back(points_.at(reflected(x, centre_, image_.signs)));
      if (image_.point.back() < 0) return false;
    }
    for (const Net* other : nets_.subspan(1)) {
      const Vec3 centre = middle(*other);
      for (Eigen::Index a = 0; a < other->rows(); ++a)
        if ((reflected(other->row(a).transpose(), centre, image_.signs) - other->row(image_.point[a]).transpose()).norm() > exact * size_)
          return false;
    }
    return true;
  }

  bool elements() {
    for (int e = 0; e < map_.n_elements(); ++e) {
      const int other = centres_.at(reflected(centres_.all()[e], centre_, image_.signs));
      if (other < 0 || map_.degree(e) != map_.degree(other)) return false;
      const auto turn = std::ranges::find_if(turns, [&](const Turn& t) { return same_places(t, e, other) && same_basis(t, e, other); });
      if (turn == std::end(turns)) return false;
      image_.element.push_back(other);
      image_.turn.push_back(*turn);
    }
    return true;
  }

  bool same_places(const Turn& turn, int e, int other) const {
    for (int b = 0; b < map_.n_bezier(e); ++b) {
      const Vec3 x = bezier_[e].row(b).transpose(), y = bezier_[other].row(turn.bernstein(b, map_.degree(e))).transpose();
      if ((reflected(x, centre_, image_.signs) - y).norm() > close * size_) return false;
    }
    return true;
  }

  /// Finds, for each control point of element e, its image on the element `other`. Returns false if a control point has no image there. Compares
  /// basis functions in addition to positions, because control points coincide where two sides of a wall meet at a corner.
  bool same_basis(const Turn& turn, int e, int other) {
    const spline::Element &from = space_.elements[e], &to = space_.elements[other];
    if (from.points.size() != to.points.size()) return false;
    std::vector<int> images;
    for (std::size_t a = 0; a < from.points.size(); ++a) {
      const Vec3 there = reflected(points_.all()[from.points[a]], centre_, image_.signs);
      const auto same = [&](std::size_t b) {
        if ((points_.all()[to.points[b]] - there).norm() > exact * size_) return false;
        for (int k = 0; k < map_.n_bezier(e); ++k) {
          const int turned = turn.bernstein(k, map_.degree(e));
          const double of_one = (*from.extraction)(static_cast<Eigen::Index>(a), k);
          const double of_other = (*to.extraction)(static_cast<Eigen::Index>(b), turned);
          if (std::abs(of_one - of_other) > exact) return false;
        }
        return true;
      };
      std::size_t b = 0;
      while (b < to.points.size() && !same(b)) ++b;
      if (b == to.points.size()) return false;
      images.push_back(to.points[b]);
    }
    for (std::size_t a = 0; a < images.size(); ++a) image_.point[from.points[a]] = images[a];
    return true;
  }

  bool sites() const {
    for (int a = 0; a < space_.n_points; ++a) {
      const spline::Site& site = space_.collocation[a].front();
      const auto place = image_.turn[site.element](site.s, site.t);
      const auto same = [&](const spline::Site& other) {
        return other.element == image_.element[site.element] && std::abs(other.s - place[0]) < close && std::abs(other.t - place[1]) < close;
      };
      if (std::ranges::none_of(space_.collocation[image_.point[a]], same)) return false;
    }
    return true;
  }

  const spline::Space& space_;
  std::span<const Net* const> nets_;
  Vec3 centre_;
  double size_;
  BezierMap map_;
  std::vector<Eigen::MatrixX3d> bezier_;  // Bezier points of each element
  spline::PointSearch points_, centres_;
  Image image_;
};

Image product(const Image& a, const Image& b) {
  Image result{a.signs.cwiseProduct(b.signs), b.point, b.element, b.turn};
  for (int& p : result.point) p = a.point[p];
  for (std::size_t e = 0; e < result.turn.size(); ++e) result.turn[e] = a.turn[b.element[e]].after(b.turn[e]);
  for (int& e : result.element) e = a.element[e];
  return result;
}

bool contains(const std::vector<Image>& group, const Vec3& signs) {
  return std::ranges::any_of(group, [&](const Image& g) { return g.signs == signs; });
}

/// Returns the group generated by a group of reflections and one more reflection.
std::vector<Image> joined(std::vector<Image> group, const Image& more) {
  const std::size_t n = group.size();
  if (!contains(group, more.signs))
    for (std::size_t k = 0; k < n; ++k) group.push_back(product(more, group[k]));
  return group;
}

std::vector<Image> identity(std::size_t n_points, std::size_t n_elements) {
  return {{Vec3::Ones(), indices(n_points), indices(n_elements), std::vector<Turn>(n_elements)}};
}

/// Signs of the reflections, in the order in which they are tried as generators of the group: mirror planes first, because the description should
/// name them; then the point symmetry, then half turns.
const std::array<Vec3, 7> candidates = {Vec3(-1, 1, 1),   Vec3(1, -1, 1),  Vec3(1, 1, -1), Vec3(-1, -1, -1),
                                        Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};

std::string name(const Vec3& signs) {
  const auto minus = (signs.array() < 0).count();
  if (minus == 3) return "point symmetry";
  for (int c = 0; c < 3; ++c)
    if ((signs[c] < 0) == (minus == 1)) return (minus == 1 ? "mirror x" : "half turn about x") + std::to_string(c + 1);
  return {};
}

}  // namespace

std::array<double, 2> Turn::operator()(double s, double t) const {
  if (exchanged) std::swap(s, t);
  return {turned[0] ? 1 - s : s, turned[1] ? 1 - t : t};
}

int Turn::bernstein(int b, int p) const {
  int i = b % (p + 1), j = b / (p + 1);
  if (exchanged) std::swap(i, j);
  return (p + 1) * (turned[1] ? p - j : j) + (turned[0] ? p - i : i);
}

Turn Turn::after(const Turn& first) const {
  const auto of = [&](int k) { return turned[k] != first.turned[exchanged ? 1 - k : k]; };
  return {exchanged != first.exchanged, {of(0), of(1)}};
}

std::optional<Image> image(const spline::Space& space, std::span<const Net* const> nets, const Vec3& signs) {
  return ImageSearch(space, nets).image(signs, [](const Image&) { return true; });
}

Symmetry::Symmetry(int n_points) : fundamental_(indices(n_points)), source_(fundamental_), signs_(Net::Ones(n_points, 3)) {}

Symmetry::Symmetry(const std::vector<Image>& generators, const Net& net) : Symmetry(static_cast<int>(net.rows())) {
  if (generators.empty()) return;
  std::vector<Image> group = identity(generators[0].point.size(), generators[0].element.size());
  std::vector<std::string> names;
  for (const Image& g : generators) {
    if (!contains(group, g.signs)) names.push_back(name(g.signs));
    group = joined(std::move(group), g);
  }
  order_ = static_cast<int>(group.size());
  if (order_ == 1) return;
  images_.assign(group.begin() + 1, group.end());
  const Vec3 centre = middle(net), size = (net.colwise().maxCoeff() - net.colwise().minCoeff()).transpose();
  const auto rank = [&](int a) { return (net.row(a).transpose() - centre).dot(Vec3(1, 1e-3, 1e-6)) / size.maxCoeff(); };
  fundamental_.clear();
  for (int a = 0; a < net.rows(); ++a) {
    int first = a;
    for (const Image& g : group)
      if (const int b = g.point[a]; rank(b) > rank(first) + exact || (rank(b) > rank(first) - exact && b < first)) first = b;
    source_[a] = first;
    if (first == a) fundamental_.push_back(a);
  }
  signs_ = Parity(*this).signs();
  description_ = names[0];
  for (std::size_t k = 1; k < names.size(); ++k) description_ += (k + 1 == names.size() ? " and " : ", ") + names[k];
}

void Symmetry::complete(Net& field) const {
  if (order_ == 1) return;
  for (const int a : fundamental_) field.row(a).array() *= signs_.row(a).array();
  for (Eigen::Index a = 0; a < field.rows(); ++a)
    if (source_[a] != a) field.row(a) = signs_.row(a).cwiseProduct(field.row(source_[a]));
}

Symmetry symmetry(const spline::Space& space, std::span<const Net* const> nets, const std::function<bool(const Image&)>& keeps) {
  ImageSearch search(space, nets);
  std::vector<Image> generators, group = identity(space.n_points, space.elements.size());
  for (const Vec3& signs : candidates) {
    if (contains(group, signs)) continue;
    const auto found = search.image(signs, keeps);
    if (!found) continue;
    generators.push_back(*found);
    group = joined(std::move(group), *found);
  }
  return {generators, *nets[0]};
}

bool FundamentalElements::whole() const {
  return std::ranges::all_of(weight, [](double w) { return w == 1; });
}

FundamentalElements fundamental_elements(const Symmetry& symmetry, int n_elements, const std::function<std::span<const int>(int)>& points) {
  FundamentalElements result;
  const auto inside = [&](int e) { return std::ranges::count_if(points(e), [&](int a) { return symmetry.source()[a] == a; }); };
  for (int e = 0; e < n_elements; ++e) {
    int same = 1, best = e;
    for (const Image& g : symmetry.images()) {
      const int other = g.element[e];
      same += other == e;
      if (const auto n = inside(other), most = inside(best); n > most || (n == most && other < best)) best = other;
    }
    if (best != e) continue;
    result.element.push_back(e);
    result.weight.push_back(1. / same);
  }
  return result;
}

/// Completes the sums at the fundamental points. `sums` contains the contributions of fundamental elements only. An image of such an element
/// contributes to a fundamental point what the element itself contributes to another point of the orbit, up to a reflection. Therefore the row of
/// every point is reflected to the fundamental point of its orbit and added there. It is multiplied by the number of images that map the fundamental
/// point to this point, which is the order of the group divided by the number of points of the orbit.
void fold(const Symmetry& symmetry, Net& sums) {
  if (symmetry.order() == 1) return;
  const std::vector<int>& source = symmetry.source();
  std::vector<int> images(source.size(), 0);
  for (const int a : source) ++images[a];
  const auto added = [&](int p) -> Eigen::RowVector3d {
    return symmetry.order() / images[source[p]] * symmetry.signs().row(p).cwiseProduct(sums.row(p));
  };
  for (const int a : symmetry.fundamental()) sums.row(a) = added(a);
  for (int p = 0; p < static_cast<int>(source.size()); ++p)
    if (source[p] != p) sums.row(source[p]) += added(p);
}

Parity::Parity(const Symmetry& symmetry, const Vec3& of_planes)
    : source_(symmetry.source()), signs_(Net::Zero(static_cast<Eigen::Index>(source_.size()), 3)),
      scalar_signs_(Eigen::VectorXd::Zero(signs_.rows())) {
  for (const int a : symmetry.fundamental()) signs_.row(a).setOnes(), scalar_signs_[a] = 1;
  for (const Image& g : symmetry.images()) {  // adds, at the image b of each fundamental point a, the factors by which g multiplies a vector (signs_)
                                              // and a scalar (scalar_signs_)
    const double turned = character(g.signs, of_planes);
    for (const int a : symmetry.fundamental()) {
      const int b = g.point[static_cast<std::size_t>(a)];
      signs_.row(b) += turned * g.signs.transpose(), scalar_signs_[b] += turned;
    }
  }
  signs_ = signs_.cwiseSign().eval(), scalar_signs_ = scalar_signs_.cwiseSign().eval();
}

void Parity::complete(Net& field) const {
  const Net known = field;
  for (Eigen::Index a = 0; a < field.rows(); ++a) field.row(a) = signs_.row(a).cwiseProduct(known.row(source_[static_cast<std::size_t>(a)]));
}

void Parity::complete(Eigen::VectorXd& field) const {
  const Eigen::VectorXd known = field;
  for (Eigen::Index a = 0; a < field.size(); ++a) field[a] = scalar_signs_[a] * known[source_[static_cast<std::size_t>(a)]];
}

}  // namespace tanktread::surface
