#include "scene/searches/shape_modes.hpp"

#include <cmath>
#include <complex>
#include <optional>

#include "base/errors.hpp"
#include "base/formatted.hpp"

namespace tanktread {

namespace {

/// Returns the system in which the modes of the shape x of `system` are computed: `system`, or a system without symmetry if the modes may have
/// another parity than the shape, because the velocities of all points are then needed.
std::shared_ptr<SteadySystem> system_of_modes(SystemPool& pool, const std::shared_ptr<SteadySystem>& system, const coupling::State& x) {
  if (!system->scene.spectrum.parity && system->knows_images()) return system;
  check_parity(*system);
  Scene whole = system->scene;
  whole.symmetry.use = "none";
  return pool.variant(*system, std::move(whole), x);
}

/// Returns eigenpairs whose values are Floquet exponents: the logarithms of the multipliers of the return map, divided by `period`.
std::vector<coupling::Eigenpair> floquet_exponents(motion::ReturnMap& returns, double period, const motion::SmallChanges& changes, int number,
                                                   const Warn& warn) {
  const auto derivative = [&](const auto& y) { return changes.shapes.coordinates(returns.derivative(changes.x, changes.shapes.displacement(y))); };
  std::vector<coupling::Eigenpair> pairs = motion::multipliers(derivative, changes.shapes.size(), number);
  const auto lost = [&](const coupling::Eigenpair& pair) { return std::abs(pair.value) < returns.resolution(); };
  if (std::erase_if(pairs, lost) > 0)
    warn({"multipliers", formatted("modes that decay within a period to less than %.2g (Time/tolerance / Periodic/difference) are not "
                                   "reported, because errors of time steps hide them", returns.resolution())});
  for (coupling::Eigenpair& pair : pairs) pair.value = std::log(pair.value) / period;
  return pairs;
}

}  // namespace

void check_parity(const SteadySystem& system) {
  if (!system.scene.spectrum.present || !system.scene.spectrum.parity) return;
  if (!system.knows_images())
    throw UserError("Spectrum/parity needs surface fields with known images: remove the key to find modes of all parities.");
  if (system.particles->body().symmetry.order() == 1)
    throw UserError("Spectrum/parity needs a symmetric scene, and this one has no symmetry: remove the key.");
}

std::vector<motion::Mode> shape_modes(SystemPool& pool, const std::shared_ptr<SteadySystem>& system, const coupling::State& x,
                                      motion::ReturnMap* returns, const Warn& warn) {
  const std::shared_ptr<SteadySystem> all = system_of_modes(pool, system, x);
  motion::SpectrumOptions options = all->scene.spectrum;
  const surface::Symmetry& symmetry = (options.parity ? system : all)->particles->body().symmetry;
  coupling::ShapeCoordinates shapes = all->coordinates(x, symmetry, options.parity.value_or(Vec3::Ones()));
  std::vector<motion::Conserved> kept = conserved_quantities(*all->particles->coupled_motion(), x);
  const motion::SmallChanges changes{*all->motion, shapes, x, kept};
  if (const int n = static_cast<int>(shapes.size()); options.number > n)
    warn({"modes", formatted("Spectrum/number is %d, but the shape has only %d unknowns and modes", options.number, n)});
  std::vector<motion::Mode> modes;
  if (returns) {
    std::optional<motion::ReturnMap> of_all;
    if (all != system) of_all.emplace(returns->with(*all->motion, x));
    std::erase_if(kept, [](const motion::Conserved& one) { return one.kind == motion::ModeKind::volume; });  // because time steps restore the volume
    modes = motion::recognised(changes, floquet_exponents(of_all ? *of_all : *returns, returns->period(), changes, options.number, warn));
  } else {
    shapes.follow(*all->motion, x);
    if (!options.shift) options.shift = all->scene.rate();
    modes = motion::spectrum(changes, options, all->scene.solvers.of(all->scene.solvers.spectrum));
  }
  system->motion->velocity(x);
  return modes;
}

}  // namespace tanktread
