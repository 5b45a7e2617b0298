// A program that adds a load: a trap that pulls the membrane to a point, like optical tweezers.

#include <numeric>

#include "app/program.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

using namespace tanktread;

struct TrapOptions {
  double stiffness = 1;
  Vec3 center = Vec3::Zero();

  void declare(deck::Section& section) {
    section.key("stiffness", stiffness, deck::positive(), "force/length^3", "k of the trap's potential k/2 |x - center|^2 per unstressed area");
    section.key("center", center, deck::any(), "length", "point that the trap draws to");
  }
};

/// E = k/2 int |x - c|^2 dGamma_0, dE/dx_A = k int N_A (x - c) dGamma_0.
class Trap : public membrane::Load {
 public:
  Trap(const TrapOptions& options, const membrane::ParticleSurface& surface) : options_(options), space_(surface.space) {
    middle_ = (surface.rest.colwise().maxCoeff() + surface.rest.colwise().minCoeff()).transpose() / 2;
    for (int e = 0; e < static_cast<int>(space_.elements.size()); ++e) {
      const spline::Element& element = space_.elements[static_cast<std::size_t>(e)];
      const quadrature::TensorRule& rule = quadrature::tensor_gauss(4);
      const auto n = static_cast<Eigen::Index>(element.points.size());
      Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
      for (int q = 0; q < rule.size(); ++q) {
        const Eigen::VectorXd value = spline::basis(element, rule.s[q], rule.t[q]).value;
        mass += rule.weights[q] * surface::point(space_, surface.unstressed, {e, rule.s[q], rule.t[q]}).jacobian * value * value.transpose();
      }
      mass_.push_back(mass);
    }
  }

  void add_work(const Net& x, std::span<const int> elements, Net& work, std::span<Net>) const override {
    add_product(x.rowwise() - options_.center.transpose(), elements, work);
  }
  void linearise(const Net&, std::span<const int> elements, std::span<const Net>) override { elements_.assign(elements.begin(), elements.end()); }
  void add_tangent(const Net& dx, Net& change) const override { add_product(dx, elements_, change); }

  bool admits(const surface::Image& image) const override { return image.signs.cwiseProduct(options_.center - middle_) == options_.center - middle_; }
  membrane::RigidConditions rigid_conditions() const override {  // rotations about the center: U + W x c = 0
    const Vec3& c = options_.center;
    membrane::RigidConditions rows(3, 6);
    rows << 1, 0, 0, 0, c[2], -c[1], 0, 1, 0, -c[2], 0, c[0], 0, 0, 1, c[1], -c[0], 0;
    return rows;
  }

  std::vector<double> values(const Net& x) const override {
    std::vector<int> all(space_.elements.size());
    std::iota(all.begin(), all.end(), 0);
    Net work = Net::Zero(x.rows(), 3);
    add_work(x, all, work, {});
    return {work.cwiseProduct(x.rowwise() - options_.center.transpose()).sum() / 2, work.colwise().sum().norm()};
  }

 private:
  void add_product(const Net& u, std::span<const int> elements, Net& work) const {
    for (const int e : elements) {
      const std::vector<int>& points = space_.elements[static_cast<std::size_t>(e)].points;
      work(points, Eigen::all) += options_.stiffness * mass_[static_cast<std::size_t>(e)] * u(points, Eigen::all);
    }
  }

  TrapOptions options_;
  const spline::Space& space_;
  Vec3 middle_;
  std::vector<Eigen::MatrixXd> mass_;  // int N_A N_B dGamma_0 of each element
  std::vector<int> elements_;
};

int main(int argc, char** argv) {
  Registry registry;
  registry.loads.add<TrapOptions>(
      "trap", "a trap that draws the membrane to a point",
      [](const TrapOptions& options, const membrane::ParticleSurface& surface) { return std::make_unique<Trap>(options, surface); },
      {{"trap_potential", "force length", "potential of the trap"}, {"trap_force", "force", "size of the trap's total force"}});
  return tanktread::main(argc, argv, registry);
}
