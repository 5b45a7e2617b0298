#include "system/equations/user_equation.hpp"

#include "base/errors.hpp"

namespace tanktread::coupling {

std::size_t ParticlesAtRest::named(const std::string& name, const std::string& key) const {
  const auto found = std::ranges::find(particles, "Particles/" + name, &Particle::path);
  if (found == particles.end()) throw UserError(key + ": there is no particle `" + name + "` in the section Particles.");
  return static_cast<std::size_t>(found - particles.begin());
}

}  // namespace tanktread::coupling
