// A program that adds an ambient flow: a rotlet, the flow around a small rotating body.

#include <Eigen/Geometry>

#include "app/program.hpp"

using namespace tanktread;

struct RotletOptions {
  Vec3 position{0, 0, -3}, strength{0, 1, 0};

  void declare(deck::Section& section) {
    section.key("position", position, deck::any(), "length", "of the rotlet, outside of the particles");
    section.key("strength", strength, deck::any(), "length^3/time", "torque on the fluid over 8 pi viscosity");
  }
};

/// The flow of a rotlet, v = g x r/|r|^3 with r = x - position.
class Rotlet : public stokes::UserFlow {
 public:
  explicit Rotlet(const RotletOptions& options) : options_(options) {}

  Vec3 velocity(const Vec3& x) const override {
    const Vec3 r = x - options_.position;
    return options_.strength.cross(r) / std::pow(r.norm(), 3);
  }
  Mat3 gradient(const Vec3& x) const override {
    const Vec3 r = x - options_.position, &g = options_.strength;
    Mat3 cross;
    cross << 0, -g[2], g[1], g[2], 0, -g[0], -g[1], g[0], 0;
    return cross / std::pow(r.norm(), 3) - 3 * g.cross(r) * r.transpose() / std::pow(r.norm(), 5);
  }
  double rate() const override { return options_.strength.norm() / std::pow(options_.position.norm(), 3); }

 private:
  RotletOptions options_;
};

int main(int argc, char** argv) {
  Registry registry;
  registry.flows.add<RotletOptions>("rotlet", "the flow of a rotlet", [](const RotletOptions& options) { return std::make_shared<Rotlet>(options); });
  return tanktread::main(argc, argv, registry);
}
