#pragma once
// Modes of small changes of a steady shape or of a periodic motion, as requested by the section Spectrum of the deck.

#include <functional>
#include <memory>
#include <vector>

#include "motion/periodic.hpp"
#include "motion/spectrum.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/searches/system_pool.hpp"

namespace tanktread {

/// Function that receives warnings for the user. It is to show each kind of warning only once.
using Warn = std::function<void(const Warning&)>;

/// Throws UserError if the scene has no symmetry that Spectrum/parity could refer to.
void check_parity(const SteadySystem& system);

/// Returns the modes of the shape x of `system`. Their rates are growth rates if x is steady. If `returns` is not null, it is the return map of the
/// periodic motion through x, and the rates are Floquet exponents; modes that errors of time steps hide are left out. `pool` builds a system without
/// symmetry if the modes may have another parity than the shape. Afterwards, x is the latest shape that `system` has evaluated. Throws UserError if
/// Spectrum/parity does not suit the scene. Collective.
std::vector<motion::Mode> shape_modes(SystemPool& pool, const std::shared_ptr<SteadySystem>& system, const coupling::State& x,
                                      motion::ReturnMap* returns, const Warn& warn);

}  // namespace tanktread
