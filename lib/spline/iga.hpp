#pragma once
// Surfaces as Bezier-extraction text (.iga), the format of the Rhino and Autodesk T-spline plug-ins.

#include <filesystem>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// A space and one control net for it.
struct SplineSurface {
  Space space;
  Net net;
};

/// Lines `#`: comments; `type surface`; `nodeN n`, `elemN m`; n lines `node x y z w`; m blocks of `belem nfun ps pt`, a line of nfun control points
/// counted from 0, and nfun lines of (ps + 1)(pt + 1) Bernstein coefficients, s fastest. What follows (`set`, `domain`) is skipped.
///
/// Throws UserError, naming file and line or element, when the text is not that, a weight is not 1, ps and pt differ or are not 2 to 6, an element
/// has more than 64 functions, or they do not sum to 1 (within 1e-6: the format carries few digits; the rest is divided out), a control point is
/// without function, the surface is not closed, or one of its elements is turned inside out, or all of it is.
///
/// Every element is a macro face by itself. Collocation points: the place where a function is largest among corners, mid-sides and centres of the
/// elements, each place given to one function, in the order of the values there.
SplineSurface read_iga(const std::filesystem::path& file);

/// Throws UserError when the file cannot be written. 17 digits: reading it back gives the same numbers.
void write_iga(const std::filesystem::path& file, const Space& space, const Net& net);

}  // namespace tanktread::spline
