// A program that adds a medium: the fluid above a horizontal plane of perfect slip, for example a flat free surface seen from below.

#include "app/program.hpp"
#include "stokes/flow/ambient_flow.hpp"

using namespace tanktread;

struct SlipOptions {
  double height = 0;

  void declare(deck::Section& section) { section.key("height", height, deck::any(), "length", "x3 on the plane; the fluid is above it"); }
};

Vec3 mirrored(const Vec3& x, double height) { return {x[0], x[1], 2 * height - x[2]}; }
Vec3 flipped(const Vec3& v) { return {v[0], v[1], -v[2]}; }

/// The image of a force f at x is the force M f at the mirrored x, M = diag(1, 1, -1). The velocity at x0 due to
/// the image is M times the velocity due to f at the mirrored x0.
class SlipImages : public stokes::LayerMedium {
 public:
  explicit SlipImages(double height) : height_(height) {}

  void add(stokes::LayerSources& sources, const stokes::LayerTargets& targets, Net& u) override {
    std::vector<Vec3> at;
    for (const Vec3& x : stokes::rows_of(targets.at, targets.far_rows)) at.push_back(mirrored(x, height_));
    const Net sums = sources.direct_sum(sources.surface.node, at, stokes::rows_of(targets.f0, targets.far_rows));
    for (std::size_t k = 0; k < at.size(); ++k) u.row(targets.far_rows[k]) += flipped(sums.row(static_cast<Eigen::Index>(k)).transpose()).transpose();
    for (const int i : targets.rows) {
      const Vec3 x0 = mirrored(targets.at.row(i).transpose(), height_), f0 = targets.f0.row(i).transpose();
      for (const int e : sources.surface.near(x0, {})) {
        const stokes::PointTable& rule = sources.surface.near_field.rule(e, x0, {});
        u.row(i) += flipped(sources.beyond_far_sum(e, rule, nullptr, x0, f0, sources.evaluations.near)).transpose();
      }
    }
  }

  bool add_row(stokes::LayerSources& sources, const Vec3& x0, std::vector<Mat3>& block) override {
    const stokes::Panels& panels = sources.surface.panels;
    const Vec3 at = mirrored(x0, height_);
    for (int e = 0; e < panels.size(); ++e) {
      const int n = panels[e].table->n_bernstein;
      std::vector<double> m(static_cast<std::size_t>(6 * n));
      sources.panel_moments(e, sources.surface.near_field.rule(e, at, {}), nullptr, at, m.data());
      for (int a = 0; a < panels[e].functions; ++a)
        for (int b = 0; b < n; ++b) {
          const double *k = &m[static_cast<std::size_t>(6 * b)], share = panels.extraction(e)[n * a + b];
          Mat3 kernel;
          kernel << k[0], k[1], k[2], k[1], k[3], k[4], -k[2], -k[4], -k[5];
          block[static_cast<std::size_t>(panels.points(e)[a])] += share * kernel;
        }
    }
    return true;
  }

 private:
  double height_;
};

class SlipPlane : public stokes::Medium {
 public:
  explicit SlipPlane(const SlipOptions& options) : height_(options.height) {}

  std::unique_ptr<stokes::LayerMedium> in_layer(const stokes::LayerSources& /*sources*/, bool /*by_clusters*/) const override {
    return std::make_unique<SlipImages>(height_);
  }
  bool contains(const Vec3& x) const override { return x[2] > height_; }
  std::string refusal(const stokes::AmbientFlow& flow) const override {
    for (const Vec3& x : {Vec3(0, 0, height_), Vec3(1, 0, height_), Vec3(0, 1, height_), Vec3(-1, 2, height_)}) {
      const Mat3 strain = flow.gradient(x) + flow.gradient(x).transpose();
      if (std::abs(flow.velocity(x)[2]) + std::abs(strain(0, 2)) + std::abs(strain(1, 2)) > 1e-9 * (flow.velocity(x).norm() + strain.norm()))
        return "a flow must be along the plane of slip and without shear stress on it.";
    }
    return {};
  }
  bool keeps(const Vec3& signs) const override { return signs[2] > 0; }

 private:
  double height_;
};

int main(int argc, char** argv) {
  Registry registry;
  registry.media.add<SlipOptions>("slip plane", "fluid above a plane of perfect slip",
                                  [](const SlipOptions& options) { return std::make_shared<SlipPlane>(options); });
  return tanktread::main(argc, argv, registry);
}
