// Time/tolerance bounds the error of a whole run for every scheme and viscosity ratio. A capsule in simple shear, Ca = 0.3, is compared with an
// explicit scheme with a much smaller tolerance on the same mesh. The error of D is evaluated at times half a unit apart.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/formatted.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

struct Scene {
  int n = 4;         ///< elements per side
  double end = 2.5;
  std::string ratio = "1";
  std::string more = "";  ///< another setting
};

std::vector<double> deformations(const Scene& scene, const std::string& scheme, double tolerance) {
  std::vector<std::string> settings = {"Flow/type=simple shear", "Membrane/law=neo-Hookean", "Membrane/capillary number=0.3",
                                       "Surface/elements per side=" + std::to_string(scene.n), "Particle/viscosity ratio=" + scene.ratio,
                                       "Time/scheme=" + scheme, formatted("Time/tolerance=%g", tolerance), "Quadrature/tolerance=1e-6"};
  if (!scene.more.empty()) settings.push_back(scene.more);
  Evolution run(settings);
  std::vector<double> found;
  for (double time = 0.5; time <= scene.end; time += 0.5) {
    run.to(time);
    found.push_back(run.deformation().taylor_inertia);
  }
  return found;
}

/// Returns the largest difference from the reference, divided by the tolerance.
double error_over_tolerance(const Scene& scene, const std::vector<double>& reference, const std::string& scheme, double tolerance) {
  const std::vector<double> found = deformations(scene, scheme, tolerance);
  double largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::abs(found[i] - reference[i]));
  return largest / tolerance;
}

// The error of the reference, bs3 with the tolerance 1e-6, is 1e-6: less than a twentieth of each bound.
TEST(TimeTolerance, BoundsTheErrorOfARunForEveryViscosityRatio) {
  for (const char* ratio : {"0.2", "1", "5", "20"}) {
    const Scene scene{.ratio = ratio};
    const std::vector<double> reference = deformations(scene, "bs3", 1e-6);
    for (const char* scheme : {"tr-bdf2", "bdf3", "auto"}) {
      EXPECT_LT(error_over_tolerance(scene, reference, scheme, 1e-4), 2) << scheme << " " << ratio;
      if (scene.ratio == "1") continue;
      EXPECT_LT(error_over_tolerance(scene, reference, scheme, 1e-5), 4) << scheme << " " << ratio;
    }
  }
}

TEST(TimeTolerance, BoundsTheErrorOfAViscousMembrane) {
  const Scene scene{.ratio = "5", .more = "Membrane/shear viscosity=2"};
  const std::vector<double> reference = deformations(scene, "bs3", 1e-6);
  for (const char* scheme : {"tr-bdf2", "bdf3"}) EXPECT_LT(error_over_tolerance(scene, reference, scheme, 1e-4), 2) << scheme;
}

TEST(TimeTolerance, BoundsTheErrorOfExplicitSchemes) {
  const Scene scene;
  const std::vector<double> reference = deformations(scene, "bs3", 1e-6);
  for (const char* scheme : {"bs3", "rkc2"}) EXPECT_LT(error_over_tolerance(scene, reference, scheme, 1e-4), 2) << scheme;
}

TEST(TimeToleranceLong, BoundsTheErrorOverThreeDecades) {
  for (const char* ratio : {"0.05", "0.2", "1", "2", "5", "10", "50"}) {
    const Scene scene{.n = 6, .end = 7.5, .ratio = ratio};
    const std::vector<double> reference = deformations(scene, "bs3", 1e-7);  // its error is 4e-7, a hundredth of the smallest bound
    for (const char* scheme : {"tr-bdf2", "bdf3", "auto"})
      for (const auto& [tolerance, bound] : {std::pair(1e-3, 2.0), {1e-4, 2.0}, {1e-5, 4.0}})
        EXPECT_LT(error_over_tolerance(scene, reference, scheme, tolerance), bound) << scheme << " " << ratio << " " << tolerance;
  }
}

}  // namespace
}  // namespace tanktread
