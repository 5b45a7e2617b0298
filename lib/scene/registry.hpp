#pragma once
// Registry of user-defined parts (loads, fields, flows, media, series, equations), which a program adds to the parts of the library.

#include <functional>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "membrane/field.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"
#include "stokes/flow/user_flow.hpp"
#include "stokes/medium/medium.hpp"

namespace tanktread::coupling {
class UserEquation;  // system/equations/user_equation.hpp
struct ParticlesAtRest;
}  // namespace tanktread::coupling

namespace tanktread {

/// Particle at a recorded state. Nets have the shape (N, 3).
struct RecordedParticle {
  const spline::Space& space;
  Net x, velocity;  ///< control net, length; control values of the fluid velocity on the surface, length/time
};

/// Functions that return the values of the columns of a registered series, from the time and one particle (ParticleSeries) or all particles
/// (RunSeries). Every rank calls them with the same arguments.
using ParticleSeries = std::function<std::vector<double>(double time, const RecordedParticle&)>;
using RunSeries = std::function<std::vector<double>(double time, std::span<const RecordedParticle>)>;

/// The registered series. Each is computed per particle, or once for all particles together.
using SeriesParts = deck::Parts<std::variant<ParticleSeries, RunSeries>()>;

/// The registered equations, with unknowns of their own.
using EquationParts = deck::Parts<std::shared_ptr<const coupling::UserEquation>(const coupling::ParticlesAtRest&)>;

/// User-defined parts of the program, by name: loads, fields, flows, media, series and equations. Each part declares its keys of the deck. `main`
/// (app/program.hpp) accepts a registry. The section Recipes of lib/README.md shows an example of each kind of part.
struct Registry {
  membrane::LoadParts loads;    ///< `Membrane/loads/<name>`
  membrane::FieldParts fields;  ///< `Interface/fields/<name>`, on interfaces and membranes
  stokes::UserFlows flows;      ///< `Flow/type <name>`, keys in `Flow/<name>`
  stokes::UserMedia media;      ///< `Domain/kind <name>`, keys in `Domain/<name>`
  SeriesParts series;           ///< `Output/series/<name>`
  EquationParts equations;      ///< `Equations/<name>`
};

inline const Registry no_parts;

}  // namespace tanktread
