// A program that adds an equation: tethers of constant length between two particles, whose tensions are unknowns.

#include "app/program.hpp"
#include "spline/basis.hpp"
#include "surface/closest_points.hpp"
#include "system/contact.hpp"
#include "system/equations/user_equation.hpp"

using namespace tanktread;

struct TetherOptions {
  std::string from, to;

  void declare(deck::Section& section) {
    section.key("from", from, deck::Choice{}, "name of the first particle");
    section.key("to", to, deck::Choice{}, "name of the second particle. The tether keeps the distance of the points that are closest at rest");
  }
};

/// Keeps the distance |d| of two material points: t.(v_2 - v_1) = 0, t = d/|d|. The tension T draws the points together: its virtual work is
/// T t.(dx_2 - dx_1).
class Tether : public coupling::UserEquation {
 public:
  Tether(const TetherOptions& options, const coupling::ParticlesAtRest& at) : particles_(at.particles.begin(), at.particles.end()) {
    const std::size_t first = at.named(options.from, "Equations/tether/from"), second = at.named(options.to, "Equations/tether/to");
    const coupling::Particle &a = particles_[first], &b = particles_[second];
    if (first == second || (a.rigid && a.rigid->prescribed && b.rigid && b.rigid->prescribed) || a.slides() || b.slides())
      throw UserError("Equations/tether must join two particles of which one moves freely and none has an interface whose points slide.");
    ends_.particle = {first, second};
    const auto patches = [&](std::size_t p) {
      return surface::Patches(surface::BezierMap(*particles_[p].space), particles_[p].block.rows(at.rest));
    };
    const surface::Patches on_first = patches(first), on_second = patches(second);
    const surface::ClosestPoints near = surface::closest_points(surface::ElementBoxes(on_first), surface::ElementBoxes(on_second), 1e-3, 1e9);
    ends_.site = surface::nearest_points(on_first[near.sites[0].element], on_second[near.sites[1].element], near).sites;
    length_ = apart(at.rest).norm();
    unit_ = at.viscosity * particles_[first].radius;
  }

  std::vector<coupling::Block> unknowns() const override {
    return {{.name = "tension", .rows = 1, .components = 1, .parity = coupling::Parity::scalar, .unit = unit_}};
  }

  std::unique_ptr<const coupling::Equation> at(const Net& x, const coupling::Layout& all) const override;

  /// The tension keeps its size and turns with d.
  void add_work_change(const Net& x, const coupling::BlockVector& solution, const Net& dx, Net& change) const override {
    const Vec3 d = apart(x), t = d.normalized(), by = apart(dx);
    coupling::Contact ends = ends_;
    ends.normal = (by - t.dot(by) * t) / d.norm();
    add_work(particles_, ends, tension(solution), change);
  }

  /// Moves both particles by half of the error of the length.
  void restore(Net& x) const override {
    const Vec3 d = apart(x), half = (1 - length_ / d.norm()) / 2 * d;
    particles_[ends_.particle[0]].block.rows(x).rowwise() += half.transpose();
    particles_[ends_.particle[1]].block.rows(x).rowwise() -= half.transpose();
  }

  std::vector<double> values(const Net& x, const coupling::BlockVector& solution) const override { return {tension(solution), apart(x).norm()}; }

 private:
  friend class TetherAtShape;
  double tension(const coupling::BlockVector& solution) const { return solution.value(solution.layout()->id("tension", -1))(0, 0); }

  /// Returns the values at the second end minus those at the first.
  Vec3 apart(const Net& net) const {
    const auto at = [&](std::size_t k) {
      const coupling::Particle& particle = particles_[ends_.particle[k]];
      const spline::Element& element = particle.space->elements[static_cast<std::size_t>(ends_.site[k].element)];
      const Net own = particle.block.rows(net);
      return Vec3(own(element.points, Eigen::all).transpose() * spline::basis(element, ends_.site[k].s, ends_.site[k].t, 0).value);
    };
    return at(1) - at(0);
  }

  std::vector<coupling::Particle> particles_;
  coupling::Contact ends_;
  double length_, unit_;
};

class TetherAtShape : public coupling::Equation {
 public:
  TetherAtShape(const Tether& tether, const Net& x, coupling::BlockId tension) : tether_(tether), tension_(tension), work_(Net::Zero(x.rows(), 3)) {
    coupling::Contact ends = tether.ends_;
    t_ = ends.normal = tether.apart(x).normalized();
    add_work(tether.particles_, ends, tether.unit_, work_);
  }

  std::string plan() const override { return "tension of a tether"; }
  void add_sources(const coupling::BlockVector& x, coupling::Given, coupling::Sources& to) const override { to.add_work(x(tension_)(0, 0) * work_); }
  void add_residual(const coupling::BlockVector&, const coupling::Sources&, const coupling::SurfaceVelocity& u, coupling::Given,
                    coupling::BlockVector& r) const override {
    r(tension_)(0, 0) += t_.dot(tether_.apart(u.of_points()));
  }

 private:
  const Tether& tether_;
  coupling::BlockId tension_;
  Net work_;
  Vec3 t_;
};

std::unique_ptr<const coupling::Equation> Tether::at(const Net& x, const coupling::Layout& all) const {
  return std::make_unique<TetherAtShape>(*this, x, all.id("tension", -1));
}

int main(int argc, char** argv) {
  Registry registry;
  registry.equations.add<TetherOptions>(
      "tether", "a tether of constant length between two particles",
      [](const TetherOptions& options, const coupling::ParticlesAtRest& at) { return std::make_shared<const Tether>(options, at); },
      {{"tension", "force", "tension of the tether"}, {"tether_length", "length", "distance of the ends of the tether"}});
  return tanktread::main(argc, argv, registry);
}
