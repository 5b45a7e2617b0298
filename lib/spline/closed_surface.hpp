#pragma once
// Whether Bezier elements of unknown origin close to a surface, and where to collocate on them.

#include <string>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// What is wrong with a surface that should be closed and seen from outside, as the end of a sentence; empty if nothing.
///
/// Sides of elements are matched by their curves. Those without a partner (at T-junctions, or holes) must cancel as curves: their line integrals
/// of a few smooth fields must sum to 0, which a hole, a missing or an inverted element breaks. Then the volume must be positive.
std::string fault_of_closed_surface(const Space& space, const Net& net);

/// For each control point a place where its function is large, each place for one function: corners, mid-sides and centres of all elements, taken
/// in descending order of the value there. All elements at the place are listed. Throws UserError when a function finds no place.
std::vector<std::vector<Site>> largest_value_sites(const Space& space, const Net& net);

}  // namespace tanktread::spline
