#include "spline/iga.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/groups.hpp"
#include "base/text_file.hpp"
#include "deck/words.hpp"
#include "spline/basis.hpp"
#include "spline/lattice.hpp"
#include "spline/limits.hpp"
#include "spline/point_search.hpp"

namespace tanktread::spline {

namespace {

/// Reads the file word by word and keeps the line number for messages.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : name_(deck::shortened(file.string(), 80)), stream_(text_of_file(file, "Surface file " + name_, 1'000'000'000)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw UserError("Surface file " + name_ + ", line " + std::to_string(line_) + ": " + what);
  }

  /// Moves to the next line that contains more than blanks and a comment. Returns false at the end of the file.
  bool next() {
    std::string text;
    while (std::getline(stream_, text)) {
      ++line_;
      if (const auto comment = text.find('#'); comment != std::string::npos) text.erase(comment);
      if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
      words_ = std::istringstream(text);
      return true;
    }
    return false;
  }
  void need(const std::string& what) {
    if (!next()) fail("the file ends where " + what + " should follow.");
  }

  template <class T>
  T word(const std::string& what) {
    T value{};
    if (!(words_ >> value)) fail(what + " expected.");
    return value;
  }
  std::string key() {
    std::string k;
    words_ >> k;
    return k;
  }

 private:
  std::string name_;
  std::istringstream stream_;
  std::istringstream words_;
  int line_ = 0;
};

Element read_element(Reader& in, int n_points) {
  Element e;
  const int functions = in.word<int>("the number of functions"), ps = in.word<int>("a degree"), pt = in.word<int>("a degree");
  if (ps != pt || ps < least_degree || ps > largest_degree)
    in.fail("degrees must be equal and between " + std::to_string(least_degree) + " and " + std::to_string(largest_degree) + ", but are " +
            std::to_string(ps) + " and " + std::to_string(pt) + ".");
  if (functions < 1 || functions > std::min(n_points, most_functions))
    in.fail("the number of functions must be between 1 and " + std::to_string(std::min(n_points, most_functions)) + ", but is " +
            std::to_string(functions) + ".");
  e.degree = ps;
  in.need("a list of nodes");
  for (int i = 0; i < functions; ++i) {
    e.points.push_back(in.word<int>("node " + std::to_string(i + 1) + " of " + std::to_string(functions)));
    if (e.points.back() < 0 || e.points.back() >= n_points)
      in.fail("node " + std::to_string(e.points.back()) + " does not exist; there are 0 to " + std::to_string(n_points - 1) + ".");
  }
  const int n = (ps + 1) * (ps + 1);
  Eigen::MatrixXd extraction(functions, n);
  for (int i = 0; i < functions; ++i) {
    in.need("coefficients");
    for (int b = 0; b < n; ++b) extraction(i, b) = in.word<double>("coefficient " + std::to_string(b + 1) + " of " + std::to_string(n));
  }
  const Eigen::RowVectorXd sum = extraction.colwise().sum();
  if (!((sum.array() - 1).abs().maxCoeff() < 1e-6))
    in.fail("the functions of this element do not sum to 1, so it is not a partition of unity.");
  e.extraction = std::make_shared<const Eigen::MatrixXd>(extraction.array().rowwise() / sum.array());
  return e;
}

struct Frame {
  Vec3 x, s, t;
};
Frame frame(const Space& space, const Net& net, const Site& site) {
  const Element& e = space.elements[site.element];
  const Basis b = basis(e, site.s, site.t, 1);
  const Net own = net(e.points, Eigen::all);
  return {own.transpose() * b.value, own.transpose() * b.s, own.transpose() * b.t};
}

/// Returns the point at the fraction x of an edge of `element`: edge 0 (t = 0), 1 (s = 1), 2 (t = 1) or 3 (s = 0). The edge is traversed with the
/// element on its left.
Site on_edge(int element, int edge, double x) {
  const auto [s, t] = turned(x, 0., 1., edge);
  return {element, s, t};
}

double extent(const Net& net) { return (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm(); }

/// Returns candidate collocation point p. Every element has nine candidates: its corners, mid-sides and centre, numbered with s fastest.
Site place_of_element(std::size_t p) { return {int(p / 9), p % 3 / 2.0, p % 9 / 3 / 2.0}; }

/// Returns for each candidate point the index of the first candidate at the same position in space.
std::vector<int> numbered_places(const Space& space, const Net& net) {
  std::vector<Vec3> all;
  for (std::size_t p = 0; p < 9 * space.elements.size(); ++p) all.push_back(frame(space, net, place_of_element(p)).x);
  const PointSearch places(std::move(all), 1e-7 * extent(net));
  std::vector<int> numbers;
  for (const Vec3& x : places.all()) numbers.push_back(places.at(x));
  return numbers;
}

// Nodes and weights of the five-point Gauss rule on [0, 1].
constexpr double gauss_x[5] = {0.046910077030668004, 0.230765344947158454, 0.5, 0.769234655052841546, 0.953089922969331996};
constexpr double gauss_w[5] = {0.118463442528094544, 0.239314335249683234, 0.284444444444444444, 0.239314335249683234,
                               0.118463442528094544};

/// Returns an element that is not connected with element 0, or -1 if there is none. Elements are connected if they share control points or candidate
/// points. `places`: candidate points, as numbered_places() returns them.
int separate_element(const Space& space, const std::vector<int>& places) {
  Groups connected(space.n_points + places.size());
  for (std::size_t k = 0; k < space.elements.size(); ++k) {
    const std::vector<int>& points = space.elements[k].points;
    for (const int point : points) connected.join(point, points[0]);
    for (std::size_t p = 9 * k; p < 9 * (k + 1); ++p) connected.join(space.n_points + places[p], points[0]);
  }
  for (std::size_t k = 1; k < space.elements.size(); ++k)
    if (connected.of(space.elements[k].points[0]) != connected.of(space.elements[0].points[0])) return int(k);
  return -1;
}

/// If a surface is not closed, has an inverted element or has several parts, returns a description of this fault, for the end of an error message.
/// Otherwise returns an empty text.
///
/// Sides of elements are matched by their end points and midpoints. Sides without a matching side (at T-junctions or holes) must cancel as curves:
/// the sum of the line integrals of a few smooth fields along them must be 0. If there is a hole, or an element is missing or inverted, the sum is
/// not 0.
std::string fault_of_closed_surface(const Space& space, const Net& net, const std::vector<int>& places) {
  constexpr int along_edge[4][3] = {{0, 1, 2}, {2, 5, 8}, {8, 7, 6}, {6, 3, 0}};
  // Element sides for which no matching side has been found yet, by the indices of their end points and midpoint. The matching side runs in the
  // opposite direction.
  std::map<std::array<int, 3>, std::pair<int, int>> open;
  int once = -1, twice = -1;
  for (int k = 0; k < int(space.elements.size()); ++k)
    for (int e = 0; e < 4; ++e) {
      const int a = places[9 * k + along_edge[e][0]], m = places[9 * k + along_edge[e][1]], b = places[9 * k + along_edge[e][2]];
      if (a == m && m == b) continue;  // skips sides that are collapsed to a single point (a pole)
      if (open.erase({b, m, a})) continue;
      const auto [side, is_new] = open.try_emplace({a, m, b}, k, e);
      if (!is_new && twice < 0) once = side->second.first, twice = k;
    }
  if (twice >= 0)
    return "element " + std::to_string(twice) + " traverses one of its sides in the same direction as its neighbour, element " +
           std::to_string(once) + ", so one of them is inverted.";

  // Line integrals (vectors) of cos(k_i . x) dx and sin(k_i . x) dx, with fixed wave vectors k_i, along all sides without a matching side. They are 0
  // if these sides cancel as curves, which means that both directions cover each curve equally often.
  Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
  double length = 0;
  const double size = extent(net);
  const Vec3 wave[3] = {Vec3(1.3, 0.7, -0.4) / size, Vec3(-0.5, 1.9, 1.1) / size, Vec3(2.1, -1.7, 2.3) / size};
  for (const auto& [ends, side] : open)
    for (int g = 0; g < 5; ++g) {
      const Frame f = frame(space, net, on_edge(side.first, side.second, gauss_x[g]));
      const Vec3 dx = gauss_w[g] * (side.second == 0 ? f.s : side.second == 1 ? f.t : side.second == 2 ? Vec3(-f.s) : Vec3(-f.t));
      length += dx.norm();
      for (int i = 0; i < 3; ++i) {
        sum.col(2 * i) += std::cos(wave[i].dot(f.x)) * dx;
        sum.col(2 * i + 1) += std::sin(wave[i].dot(f.x)) * dx;
      }
    }
  if (!open.empty() && sum.cwiseAbs().maxCoeff() > 1e-5 * length)
    return "the surface is not closed: element " + std::to_string(open.begin()->second.first) + " is next to a hole.";
  if (const int other = separate_element(space, places); other >= 0)
    return "the surface has separate parts, but a particle has one closed surface: element " + std::to_string(other) +
           " is not connected with element 0.";

  return {};
}

/// If the surface folds or encloses no possible volume, returns a description of this fault, for the end of an error message. Otherwise returns an
/// empty text.
///
/// At a fold the normal turns over. Therefore it must turn by less than 120 degrees between neighbouring quadrature points of an element (an edge
/// turns it by up to 90), and the Jacobian must not vanish (1e-6 of its mean in the element; next to a pole it is 1e-2). The volume must be positive
/// and below the volume of the box around the control points, which contains the convex hull of a surface with non-negative functions.
std::string fault_of_shape(const Space& space, const Net& net) {
  double volume = 0;
  for (int k = 0; k < int(space.elements.size()); ++k) {
    std::array<Vec3, 25> normals;
    double mean = 0;
    for (int p = 0; p < 25; ++p) {
      const Frame f = frame(space, net, {k, gauss_x[p % 5], gauss_x[p / 5]});
      normals[p] = f.s.cross(f.t);
      volume += gauss_w[p % 5] * gauss_w[p / 5] * f.x.dot(normals[p]) / 3;
      mean += normals[p].norm() / 25;
    }
    for (int p = 0; p < 25; ++p) {
      const auto turns = [&](int q) { return normals[p].dot(normals[q]) < -0.5 * normals[p].norm() * normals[q].norm(); };
      const bool turned = (p % 5 && turns(p - 1)) || (p >= 5 && turns(p - 5));
      if (turned || !(normals[p].norm() > 1e-6 * mean))
        return "the surface folds in element " + std::to_string(k) + ", where its normal turns over: make the file with more elements, or from a "
               "smoother shape.";
    }
  }
  if (!(volume > 0)) return "the surface is inside out: all its elements must be seen counter-clockwise from outside.";
  if (volume > (net.colwise().maxCoeff() - net.colwise().minCoeff()).prod())
    return "the surface crosses itself, because its volume exceeds the volume of the box around it.";
  return {};
}

/// Returns a collocation point for each control point, at which the basis function of this control point is large. A point is given by its local
/// coordinates on every element that contains it. Candidate points are assigned in descending order of the value of the function, each to one
/// function. Throws UserError if no candidate is left for a function.
std::vector<std::vector<Site>> largest_value_sites(const Space& space, const std::vector<int>& places) {
  std::vector<std::vector<Site>> at_place(places.size());
  struct Candidate {
    double value;
    int point, place;
  };
  std::vector<Candidate> candidates;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const Site site = place_of_element(p);
    std::vector<Site>& sites = at_place[places[p]];
    // skips a second occurrence of the element, on a side that is collapsed to a pole
    if (!sites.empty() && sites.back().element == site.element) continue;
    sites.push_back(site);
    if (sites.size() > 1) continue;
    const Element& e = space.elements[site.element];
    const Basis b = basis(e, site.s, site.t, 0);
    for (std::size_t i = 0; i < e.points.size(); ++i)
      if (b.value[Eigen::Index(i)] > 0.02) candidates.push_back({b.value[Eigen::Index(i)], e.points[i], places[p]});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return std::llround(a.value * 1e10) > std::llround(b.value * 1e10); });
  std::vector<int> place_of(space.n_points, -1);
  std::vector<char> taken(at_place.size(), 0);
  for (const Candidate& c : candidates) {
    if (place_of[c.point] >= 0 || taken[c.place]) continue;
    place_of[c.point] = c.place;
    taken[c.place] = 1;
  }
  std::vector<std::vector<Site>> out(space.n_points);
  for (int i = 0; i < space.n_points; ++i) {
    if (place_of[i] < 0)
      throw UserError("Control point " + std::to_string(i) +
                      " of the surface has no collocation site, because its basis function is small everywhere.");
    out[i] = at_place[place_of[i]];
  }
  return out;
}

/// Throws UserError if the name of the file is that of a triangulated surface, which the package converts.
void refuse_mesh(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) { return char(std::tolower(letter)); });
  if (std::ranges::count(std::array<const char*, 9>{".stl", ".off", ".obj", ".ply", ".vtk", ".vtu", ".msh", ".mesh", ".xyz"}, ending))
    throw UserError("Surface file " + deck::shortened(file.string(), 80) +
                    " is a mesh, not a spline surface (.iga): convert it with `tanktread-surface " +
                    deck::shortened(file.filename().string(), 80) + " -o " + deck::shortened(file.stem().string(), 80) + ".iga`.");
}

}  // namespace

SplineSurface read_iga(const std::filesystem::path& file) {
  refuse_mesh(file);
  Reader in(file);
  SplineSurface out;
  int nodes = -1, n_elements = -1;
  std::vector<Vec3> points;
  while (in.next()) {
    const std::string key = in.key();
    if (key == "type") {
      if (in.word<std::string>("a type") != "surface") in.fail("type `surface` expected.");
    } else if (key == "nodeN") {
      nodes = in.word<int>("the number of nodes");
    } else if (key == "elemN") {
      n_elements = in.word<int>("the number of elements");
    } else if (key == "node") {
      Vec3 x;
      for (int d = 0; d < 3; ++d) x[d] = in.word<double>("a coordinate");
      if (std::abs(in.word<double>("a weight") - 1) > 1e-12) in.fail("weights must be 1, rational surfaces are not supported.");
      if (!(x.cwiseAbs().maxCoeff() < 1e75)) in.fail("coordinates must be below 1e75 in size.");
      points.push_back(x);
    } else if (key == "belem") {
      if (nodes < 0 || int(points.size()) != nodes) in.fail("nodeN and as many nodes must come before the first element.");
      Element e = read_element(in, nodes);
      e.face = int(out.space.elements.size());
      out.space.elements.push_back(std::move(e));
    } else if (key != "set" && key != "domain") {
      if (n_elements >= 0 && int(out.space.elements.size()) == n_elements) break;  // other data after the elements
      in.fail(deck::in_quotes(deck::shortened(key, 60)) + " is not a keyword of the format; the keywords are type, nodeN, elemN, "
              "node, belem, set and domain.");
    }
  }
  if (n_elements < 0) in.fail("the file ends without the keyword elemN.");
  if (n_elements < 1 || int(out.space.elements.size()) != n_elements)
    in.fail("elemN states " + std::to_string(n_elements) + " elements, but the file contains " + std::to_string(out.space.elements.size()) + ".");
  out.space.n_points = nodes;
  out.net.resize(nodes, 3);
  for (int i = 0; i < nodes; ++i) out.net.row(i) = points[i];
  const std::vector<int> places = numbered_places(out.space, out.net);
  for (const std::string& fault : {fault_of_closed_surface(out.space, out.net, places), fault_of_shape(out.space, out.net)})
    if (!fault.empty()) throw UserError("Surface file " + file.string() + ": " + fault);
  out.space.collocation = largest_value_sites(out.space, places);
  out.space.description =
      std::to_string(n_elements) + " Bezier elements, " + std::to_string(nodes) + " control points, from " + file.filename().string();
  return out;
}

std::string iga_text(const Space& space, const Net& net) {
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << "type surface\nnodeN " << space.n_points << "\nelemN " << space.elements.size() << "\n";
  for (int i = 0; i < space.n_points; ++i) out << "node " << net(i, 0) << " " << net(i, 1) << " " << net(i, 2) << " 1\n";
  for (const Element& e : space.elements) {
    out << "belem " << e.points.size() << " " << e.degree << " " << e.degree << "\n";
    for (std::size_t i = 0; i < e.points.size(); ++i) out << (i ? " " : "") << e.points[i];
    out << "\n";
    for (Eigen::Index i = 0; i < e.extraction->rows(); ++i)
      for (Eigen::Index b = 0; b < e.extraction->cols(); ++b) out << (*e.extraction)(i, b) << (b + 1 < e.extraction->cols() ? " " : "\n");
  }
  return out.str();
}

}  // namespace tanktread::spline
