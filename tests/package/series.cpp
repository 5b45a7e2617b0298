// A program that adds two series: for each particle its length along a direction, and for the run the largest speed of the particles' surfaces.

#include <algorithm>

#include "app/program.hpp"

using namespace tanktread;

struct StretchOptions {
  Vec3 direction{1, 0, 1};

  void declare(deck::Section& section) { section.key("direction", direction, deck::any(), "1", "along which the extent is measured, of any length"); }
};

/// Computes the extent of the control net along `direction`.
struct Stretch {
  Vec3 direction;

  std::vector<double> operator()(double, const RecordedParticle& particle) const {
    const Eigen::VectorXd along = particle.x * direction.normalized();
    return {along.maxCoeff() - along.minCoeff()};
  }
};

struct FastestOptions {
  void declare(deck::Section&) {}
};

std::vector<double> fastest(double time, std::span<const RecordedParticle> particles) {
  double speed = 0;
  for (const RecordedParticle& one : particles) speed = std::max(speed, one.velocity.rowwise().norm().maxCoeff());
  return {speed, speed * time};
}

int main(int argc, char** argv) {
  Registry registry;
  registry.series.add<StretchOptions>("stretch", "extent of each particle along a direction",
                                               [](const StretchOptions& options) { return ParticleSeries(Stretch{options.direction}); },
                                               {{"stretch", "length", "extent of the control net along Output/series/stretch/direction"}});
  registry.series.add<FastestOptions>("fastest", "largest speed of control points", [](const FastestOptions&) { return RunSeries(fastest); },
                                          {{"fastest", "length/time", "largest speed of control points"},
                                           {"fastest_way", "length", "this times time"}});
  return tanktread::main(argc, argv, registry);
}
