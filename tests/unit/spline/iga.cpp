#include "spline/iga.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "base/errors.hpp"
#include "samples.hpp"
#include "sequences.hpp"
#include "spline/polar.hpp"

namespace tanktread::spline {
namespace {

void write(const std::string& path, const Space& space, const Net& net) { std::ofstream(path) << iga_text(space, net); }

/// A temporary file that is deleted at the end of the test.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tanktread_iga_" + std::to_string(std::random_device{}()) + ".iga");
  ~Scratch() { std::filesystem::remove(path); }
  std::string text() const {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& text) const { std::ofstream(path) << text; }
};

/// Returns the control points at the positions of their anchors, projected to the unit sphere.
Net ball(const TMesh& mesh) {
  const auto anchor = anchors(mesh);
  Net net(Eigen::Index(anchor.size()), 3);
  for (std::size_t i = 0; i < anchor.size(); ++i) net.row(Eigen::Index(i)) = mesh.lattice->position[anchor[i]].normalized();
  return net;
}

TEST(Iga, AWrittenSurfaceIsReadUnchanged) {
  std::mt19937 generator(3);
  const TMesh uniform = cube(3, 2), cut = refine(uniform, random_marks(uniform, 4, 0, generator)).mesh;
  for (const TMesh& mesh : {uniform, cut})
    for (auto rule : {ExtraordinaryRule::g1, ExtraordinaryRule::catmull_clark}) {
      const Space s = space(mesh, rule);
      const Net net = ball(mesh);
      const Scratch file;
      write(file.path, s, net);
      const SplineSurface read = read_iga(file.path);
      ASSERT_EQ(read.space.elements.size(), s.elements.size());
      EXPECT_EQ(read.net, net);
      for (std::size_t k = 0; k < s.elements.size(); ++k) {
        EXPECT_EQ(read.space.elements[k].degree, s.elements[k].degree);
        EXPECT_EQ(read.space.elements[k].points, s.elements[k].points);
        EXPECT_LT((*read.space.elements[k].extraction - *s.elements[k].extraction).cwiseAbs().maxCoeff(), 1e-15);
      }
    }
}

TEST(Iga, EveryFunctionOfAnImportedSurfaceHasASeparateSite) {
  const TMesh mesh = cube(4);
  const Scratch file;
  write(file.path, space(mesh, ExtraordinaryRule::g1), ball(mesh));
  const SplineSurface read = read_iga(file.path);
  EXPECT_LT(collocation_condition(read.space), 15);  // on a uniform mesh the collocation points are the vertices
  for (const auto& sites : read.space.collocation) {
    EXPECT_GE(sites.size(), 3u);
    for (const Site& site : sites)
      EXPECT_LT((value_at(read.space, read.net, site) - value_at(read.space, read.net, sites[0])).norm(), 1e-7);
  }
}

TEST(Iga, SurfacesWithPolesAreClosedToo) {
  const Space s = space(polar(8, 4), PoleRule::plain);
  Net net(s.n_points, 3);
  for (int i = 0; i < s.n_points; ++i) {
    const Site& site = s.collocation[i][0];
    const Element& e = s.elements[site.element];
    const double longitude = 2 * M_PI * (e.origin[0] + site.s * e.size[0]), latitude = M_PI * (e.origin[1] + site.t * e.size[1] - 0.5);
    net.row(i) << std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude), std::sin(latitude);
  }
  const Scratch file;
  write(file.path, s, net);
  EXPECT_EQ(read_iga(file.path).space.n_points, s.n_points);
}

/// Returns the error message of read_iga for a file, or "read" if there is none.
std::string refusal(const std::filesystem::path& file) {
  try {
    read_iga(file);
  } catch (const UserError& e) {
    return e.what();
  }
  return "read";
}

bool says(const std::string& message, const std::string& part) { return message.find(part) != std::string::npos; }

/// Returns the error message for the text of a cube after a change.
std::string complaint(const std::function<void(std::string&)>& change) {
  const TMesh mesh = cube(3);
  const Scratch file;
  write(file.path, space(mesh, ExtraordinaryRule::g1), ball(mesh));
  std::string text = file.text();
  change(text);
  file.write(text);
  return refusal(file.path);
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, from.size(), to);
}

TEST(Iga, EveryErrorIsReportedInOneSentence) {
  EXPECT_EQ(complaint([](std::string&) {}), "read");
  // Removes the last element, first without and then with a change of the number of elements.
  EXPECT_TRUE(says(complaint([](std::string& t) { t.erase(t.rfind("belem")); }), "elemN states 54 elements, but the file contains 53"));
  EXPECT_TRUE(says(complaint([](std::string& t) {
                     t.erase(t.rfind("belem"));
                     replace(t, "elemN 54", "elemN 53");
                   }),
                   "not closed"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "elemN 54", "elemN fifty"); }), "number of elements expected"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "type surface", "type volume"); }), "`surface` expected"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "nodeN 56", "nodeN 57"); }), "nodeN and as many nodes"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "belem 19 4 4", "belem 19 4 3"); }), "degrees must be equal"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "belem 19 4 4", "belem 19 7 7"); }), "between 2 and 6, but are 7 and 7"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "belem 19 4 4", "belem 65 4 4"); }), "between 1 and 56, but is 65"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, "belem", "element"); }), "is not a keyword"));
  EXPECT_TRUE(says(complaint([](std::string& t) { replace(t, " 1\nnode", " 0.5\nnode"); }), "weights must be 1"));
  EXPECT_TRUE(says(complaint([](std::string& t) { t.resize(t.size() / 2); }), "Surface file"));
  EXPECT_TRUE(says(complaint([](std::string& t) { t.clear(); }), "without the keyword elemN"));
  for (const char* far : {"1e308", "2147483648", "1e10"})  // the last two: all other points seem to coincide
    EXPECT_TRUE(says(
        complaint([&](std::string& t) { t.replace(t.find("node ") + 5, t.find(' ', t.find("node ") + 5) - t.find("node ") - 5, far); }),
        "Surface file"))
        << far;
  EXPECT_THROW(read_iga("/nonexistent/surface.iga"), UserError);
  EXPECT_THROW(read_iga(std::filesystem::temp_directory_path()), UserError);
}

/// Returns the element with the direction of s reversed: it has the same functions, with reversed Bernstein columns in s.
Element turned_over(Element e) {
  const int n = e.degree + 1;
  Eigen::MatrixXd c = *e.extraction;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) c.col(n * j + i) = e.extraction->col(n * j + e.degree - i);
  e.extraction = std::make_shared<const Eigen::MatrixXd>(c);
  return e;
}

TEST(Iga, InvertedElementsAndSurfacesAreRejected) {
  const TMesh mesh = cube(3);
  Space s = space(mesh, ExtraordinaryRule::g1);
  const Net net = ball(mesh);
  const Scratch file;
  s.elements[7] = turned_over(s.elements[7]);
  write(file.path, s, net);
  EXPECT_TRUE(says(refusal(file.path), "inverted"));
  s.elements[7] = turned_over(s.elements[7]);
  for (Element& e : s.elements) e = turned_over(e);
  write(file.path, s, net);
  EXPECT_TRUE(says(refusal(file.path), "inside out"));
}

TEST(Iga, FoldsAreRejected) {
  const TMesh mesh = cube(4);
  const Space s = space(mesh, ExtraordinaryRule::g1);
  Net net = ball(mesh);
  const Scratch file;
  net.row(60) *= 0.2;  // a deep dimple is no fold
  write(file.path, s, net);
  EXPECT_EQ(refusal(file.path), "read");
  net = ball(mesh);
  net.row(60) += 2 * Vec3(net.row(60)).cross(Vec3(net.row(0))).transpose();  // along the surface, beyond its neighbours
  write(file.path, s, net);
  EXPECT_TRUE(says(refusal(file.path), "folds in element")) << refusal(file.path);
}

TEST(Iga, AMeshIsRejectedWithTheCommandThatConvertsIt) {
  for (const char* name : {"cell.stl", "CELL.STL", "cell.off"})
    EXPECT_TRUE(says(refusal(name), std::string("tanktread-surface ") + name)) << refusal(name);
}

}  // namespace
}  // namespace tanktread::spline
