#include "surface/quality.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

Quality whole_quality(const BezierMap& map, const Net& net) { return quality(map, net, indices(map.n_elements())); }

TEST(Quality, AFittedSphereIsEven) {
  const CubeMesh cube(6);
  const BezierMap map(cube.space);
  const Quality q = whole_quality(map, cube.sphere());
  EXPECT_GT(q.jacobian_ratio, 0.4);  // the elements at the corners of the cube are the most uneven
  EXPECT_LT(q.aspect_ratio, 1.5);
  EXPECT_NEAR(q.tilt, 0.16, 0.01);   // an element subtends 15 degrees: half its diagonal, to the outermost Gauss points; elements are not equal
  EXPECT_NO_THROW(require_sound(q));
}

TEST(Quality, OfAUnionIsTheWorstOfItsParts) {
  const CubeMesh cube(6);
  const BezierMap map(cube.space);
  const Net net = cube.crumpled(0.05);
  std::vector<int> first, second;
  for (int e = 0; e < map.n_elements(); ++e) (e % 3 ? first : second).push_back(e);
  const Quality whole = whole_quality(map, net), together = worse(quality(map, net, first), quality(map, net, second));
  EXPECT_EQ(together.jacobian_ratio, whole.jacobian_ratio);
  EXPECT_EQ(together.folded_element, whole.folded_element);
  EXPECT_EQ(together.folded_place, whole.folded_place);
  EXPECT_EQ(together.aspect_ratio, whole.aspect_ratio);
  EXPECT_EQ(together.stretched_element, whole.stretched_element);
  EXPECT_EQ(together.tilt, whole.tilt);
}

TEST(Quality, StretchingIncreasesTheAspectRatio) {
  const CubeMesh cube(6);
  const BezierMap map(cube.space);
  Net net = cube.sphere();
  const double before = whole_quality(map, net).aspect_ratio;
  net.col(0) *= 5;
  const double after = whole_quality(map, net).aspect_ratio;
  EXPECT_GT(after, 4);
  EXPECT_LT(after, 5 * before);
}

TEST(Quality, TheSurfaceTurnsWithinAnElementAtATipWhateverItsSize) {
  const CubeMesh cube(6);
  const BezierMap map(cube.space);
  Net net = cube.sphere();
  const double round = whole_quality(map, net).tilt;
  net.col(0) *= 5;
  // at the tip of an ellipsoid 5 : 1 : 1 the normal turns five times as fast as on the sphere, and slower away from it
  EXPECT_GT(whole_quality(map, net).tilt, 3 * round);
  EXPECT_LT(whole_quality(map, net).tilt, 5 * round);
  EXPECT_NEAR(whole_quality(map, 7 * net).tilt, whole_quality(map, net).tilt, 1e-9);  // round-off of acos
}

TEST(Quality, AFoldedElementIsReportedWithItsPosition) {
  const CubeMesh cube(6);
  const BezierMap map(cube.space);
  Net net = cube.sphere();
  // If a control point is moved past its neighbour, the surface has a fold between them.
  const spline::Element& element = cube.space.elements[14];
  const Net before = net;
  net.row(element.points[5]) += 3 * (net.row(element.points[6]) - net.row(element.points[5]));
  const Quality q = whole_quality(map, net);
  ASSERT_LT(q.jacobian_ratio, 0);
  EXPECT_LT((q.folded_place - Vec3(before.row(element.points[5]))).norm(), 1);
  try {
    require_sound(q);
    FAIL() << "a folded surface passed";
  } catch (const RunFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("element " + std::to_string(q.folded_element) + " is folded at ("), std::string::npos)
        << failure.what();
  }
}

TEST(Quality, AControlPointThatIsNotANumberEndsTheRun) {
  const CubeMesh cube(3);
  Net net = cube.sphere();
  net(7, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(whole_quality(BezierMap(cube.space), net), RunFailure);
}

}  // namespace
}  // namespace tanktread::surface
