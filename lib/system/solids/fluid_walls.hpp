#pragma once
// The walls and other solids that bound the fluid, as seen by particles.

#include <optional>
#include <span>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solids/plates/solid_response.hpp"
#include "system/targets/targets.hpp"

namespace tanktread::coupling {

/// Boundaries of the fluid that are meshed, other than particles. A member is null if there is no such boundary. The boundaries must be set to the
/// shape of the particles before they respond.
struct FluidWalls {
  Tube* tube = nullptr;
  SolidResponse* solids = nullptr;

  bool any() const { return tube || solids; }

  /// Sets the boundaries to the net x of the particles. `targets`: points at which velocities are evaluated. `origin`: see Tube::set_shape.
  /// Collective.
  void set_shape(const Net& x, const Targets& targets, std::optional<double> origin) const;

  void forget() const;  ///< discards what the boundaries keep for the shape that was set last

  /// Returns the first of the points `at` that is outside the tube, behind a plate or in a post. Tests only the rank-owned points of a tube.
  using Crossing = PlatesAndPosts::Crossing;
  Crossing crossing(const Net& at, const RowShare& layout) const;

  /// Responses of the boundaries that exist.
  struct Response {
    Tube::Response tube;
    PlatesAndPosts::Flow solids;
  };

  /// Returns the responses to the load f and the velocity v of the particles; an empty v counts as zero. `with_empty`: whether the flow that solids
  /// cause without particles is included. In a tube this flow is part of the ambient flow. Collective.
  Response respond(const Net& f, const Net& v, bool with_empty) const;

  /// Adds to u the velocity of a response at the targets passed to set_shape(). Collective.
  void add_velocity(const Response& response, const Targets& targets, Net& u) const;

  /// Adds to rows `own` of u the velocity of a response at points on the particles. `values`: values of the basis functions at the points. x: net of
  /// the particles. Collective if Tube::velocity_at() is.
  void add_velocity_at(const Eigen::SparseMatrix<double>& values, const Net& x, const Response& response, std::span<const int> own, Net& u) const;

  /// Returns the number of kernel evaluations: by the layers of the particles at points of the boundaries and, unless TubeParameters::walls is set,
  /// by the wall of the tube.
  stokes::Evaluations evaluations() const;
};

}  // namespace tanktread::coupling
