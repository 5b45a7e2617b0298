#include "spline/iga.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

#include "base/errors.hpp"
#include "base/text_file.hpp"
#include "deck/words.hpp"
#include "spline/closed_surface.hpp"

namespace tanktread::spline {

namespace {

/// What the integrals over the surface and the membrane have rules and room for.
constexpr int least_degree = 2, largest_degree = 6, most_functions = 64;

/// Words of the file, with the number of the line for messages.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : name_(deck::shortened(file.string(), 80)), stream_(text_of_file(file, "Surface file " + name_, 1'000'000'000)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw UserError("Surface file " + name_ + ", line " + std::to_string(line_) + ": " + what);
  }

  /// The next line with something on it; false at the end of the file.
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
  e.extraction.resize(functions, n);
  for (int i = 0; i < functions; ++i) {
    in.need("coefficients");
    for (int b = 0; b < n; ++b) e.extraction(i, b) = in.word<double>("coefficient " + std::to_string(b + 1) + " of " + std::to_string(n));
  }
  const Eigen::RowVectorXd sum = e.extraction.colwise().sum();
  if (!((sum.array() - 1).abs().maxCoeff() < 1e-6))
    in.fail("the functions of this element do not sum to 1, so it is not a partition of unity.");
  e.extraction = e.extraction.array().rowwise() / sum.array();
  return e;
}

}  // namespace

SplineSurface read_iga(const std::filesystem::path& file) {
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
      if (n_elements >= 0 && int(out.space.elements.size()) == n_elements) break;  // a list after the elements
      in.fail("`" + key + "` is no keyword here; type, nodeN, elemN, node, belem, set and domain are.");
    }
  }
  if (n_elements < 1 || int(out.space.elements.size()) != n_elements)
    in.fail("elemN says " + std::to_string(n_elements) + " elements, the file has " + std::to_string(out.space.elements.size()) + ".");
  out.space.n_points = nodes;
  out.net.resize(nodes, 3);
  for (int i = 0; i < nodes; ++i) out.net.row(i) = points[i];
  if (const std::string fault = fault_of_closed_surface(out.space, out.net); !fault.empty())
    throw UserError("Surface file " + file.string() + ": " + fault);
  out.space.collocation = largest_value_sites(out.space, out.net);
  out.space.description =
      std::to_string(n_elements) + " Bezier elements, " + std::to_string(nodes) + " control points, from " + file.filename().string();
  return out;
}

void write_iga(const std::filesystem::path& file, const Space& space, const Net& net) {
  std::ofstream out(file);
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << "type surface\nnodeN " << space.n_points << "\nelemN " << space.elements.size() << "\n";
  for (int i = 0; i < space.n_points; ++i) out << "node " << net(i, 0) << " " << net(i, 1) << " " << net(i, 2) << " 1\n";
  for (const Element& e : space.elements) {
    out << "belem " << e.points.size() << " " << e.degree << " " << e.degree << "\n";
    for (std::size_t i = 0; i < e.points.size(); ++i) out << (i ? " " : "") << e.points[i];
    out << "\n";
    for (Eigen::Index i = 0; i < e.extraction.rows(); ++i)
      for (Eigen::Index b = 0; b < e.extraction.cols(); ++b) out << e.extraction(i, b) << (b + 1 < e.extraction.cols() ? " " : "\n");
  }
  if (!out.flush()) throw UserError("Surface file " + file.string() + " cannot be written.");
}

}  // namespace tanktread::spline
