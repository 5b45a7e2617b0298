// A program that adds a field: a membrane that contracts after a stretch.

#include <numeric>

#include "app/program.hpp"
#include "membrane/membrane.hpp"

using namespace tanktread;

struct ReflexOptions {
  double time = 1, tension = 1;

  void declare(deck::Section& section) {
    section.key("response time", time, deck::positive(), "time", "T within which the tension follows the area");
    section.key("tension", tension, deck::not_negative(), "force/length", "t of the tension t q");
  }
};

/// Field with one coefficient q: dq/dt = (A/A0 - 1 - q)/T, where A is the area, A0 the unstressed area and T the response time. The load of the field
/// is t q dA/dx, the load of a surface tension t q with the key `tension` t.
class Reflex : public membrane::Field {
 public:
  Reflex(const ReflexOptions& options, const membrane::ParticleSurface& surface)
      : options_(options), unit_(surface.space, surface.unstressed, membrane::SurfaceTension{1}, 4, {}), tangent_(unit_),
        elements_(surface.space.elements.size()) {
    std::iota(elements_.begin(), elements_.end(), 0);
    set_state(surface.unstressed, start(surface.unstressed));
    area0_ = area_;
  }

  Eigen::Index size() const override { return 1; }
  Eigen::VectorXd start(const Net&) const override { return Eigen::VectorXd::Zero(1); }
  void set_state(const Net& x, const Eigen::VectorXd& q) override {
    x_ = x, q_ = q[0];
    gradient_.resize(x.rows(), 3);
    unit_.load(x, elements_, gradient_);  // dA/dx
    area_ = x.cwiseProduct(gradient_).sum() / 2;
  }

  Net load() const override { return options_.tension * q_ * gradient_; }
  Eigen::VectorXd rate(const Net&) const override { return Eigen::VectorXd::Constant(1, (area_ / area0_ - 1 - q_) / options_.time); }
  double energy() const override { return 0; }

  void linearise(const Net&) override { tangent_.update(x_, elements_); }
  Eigen::VectorXd value_change(const Net&, const Eigen::VectorXd& dq) const override { return dq; }
  Net load_change(const Net& dx, const Eigen::VectorXd& dq) const override {
    Net turned(dx.rows(), 3);
    tangent_.apply(dx, turned);
    return options_.tension * (dq[0] * gradient_ + q_ * turned);
  }
  Eigen::VectorXd rate_change(const Net& dx, const Eigen::VectorXd& dq, const Net&) const override {
    return Eigen::VectorXd::Constant(1, (gradient_.cwiseProduct(dx).sum() / area0_ - dq[0]) / options_.time);
  }
  Eigen::VectorXd solve(double shift, const Eigen::VectorXd& r) const override { return r / (1 + shift / options_.time); }

  Eigen::VectorXd relabelled(const Net&) const override { return Eigen::VectorXd::Zero(1); }
  Eigen::VectorXd transferred(const Field& from, const Net&, const std::function<spline::Site(const spline::Site&)>&) const override {
    return Eigen::VectorXd::Constant(1, static_cast<const Reflex&>(from).q_);
  }

  std::vector<double> values() const override { return {q_}; }
  std::vector<membrane::SurfaceValues> snapshot() const override {
    return {{"reflex tension", Eigen::VectorXd::Constant(x_.rows(), options_.tension * q_)}};
  }

 private:
  ReflexOptions options_;
  membrane::Membrane unit_;  // membrane with the surface tension 1, whose energy is its area
  membrane::Tangent tangent_;
  std::vector<int> elements_;
  Net x_, gradient_;
  double q_ = 0, area_ = 0, area0_ = 0;
};

int main(int argc, char** argv) {
  Registry registry;
  registry.fields.add<ReflexOptions>(
      "reflex", "a tension that follows the area of the surface",
      [](const ReflexOptions& options, const membrane::ParticleSurface& surface) { return std::make_unique<Reflex>(options, surface); },
      {{"reflex", "1", "q, the tension over Interface/fields/reflex/tension"}});
  return tanktread::main(argc, argv, registry);
}
