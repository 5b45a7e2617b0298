#pragma once
// Parts that a program adds to those of the library.

#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "membrane/field.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"
#include "stokes/flow/user_flow.hpp"

namespace tanktread {

/// A particle at a recorded state. Nets have the shape (N, 3).
struct RecordedParticle {
  const spline::Space& space;
  Net x, velocity;  ///< control net, length; velocity of the fluids on the surface, control values, length/time
};

/// The values of the columns with which a series is registered, as a function of time and of what the series is of. Every rank calls it with the same
/// arguments.
using ParticleSeries = std::function<std::vector<double>(double time, const RecordedParticle&)>;
using RunSeries = std::function<std::vector<double>(double time, std::span<const RecordedParticle>)>;

/// A series of each particle or of the run.
using SeriesParts = deck::Parts<std::variant<ParticleSeries, RunSeries>()>;

/// Parts by name, each with its own keys in the deck. `main` (app/program.hpp) takes them. lib/README.md, Recipes, shows an example of each.
struct Registry {
  membrane::LoadParts loads;    ///< `Membrane/loads/<name>`
  membrane::FieldParts fields;  ///< `Interface/fields/<name>`, also of a membrane
  stokes::UserFlows flows;      ///< `Flow/type <name>`, keys in `Flow/<name>`
  SeriesParts series;           ///< `Output/series/<name>`
};

inline const Registry no_parts;

}  // namespace tanktread
