#pragma once
// Reading and writing of surfaces as Bezier-extraction text (.iga), the format of the Rhino and Autodesk T-spline plug-ins.

#include <filesystem>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// A spline space and a control net in it.
struct SplineSurface {
  Space space;
  Net net;
};

/// Reads a surface. The format: `#` begins a comment; `type surface`; `nodeN n`, `elemN m`; n lines `node x y z w`; m blocks of `belem nfun ps pt`,
/// a line of nfun control points counted from 0, and nfun lines of (ps + 1)(pt + 1) Bernstein coefficients, s fastest. Later lines (`set`,
/// `domain`) are skipped.
///
/// Throws UserError, which names the file and the line or element, if the text does not have this format, a weight is not 1, ps and pt differ or
/// are not 2 to 6, an element has more than 64 functions, the functions of an element do not sum to 1 within 1e-6, a control point has no function,
/// the surface is not closed or has separate parts, one or all of its elements are inside out, an element folds, the volume exceeds the volume of
/// the box around the control points, or the name of the file is that of a triangulated mesh. Files have few digits, so the functions are divided
/// by their sum.
///
/// Every element is a macro face of its own (positions in the element are positions in the face). Candidates for collocation points are the
/// corners, mid-sides and centres of the elements. Pairs of a function and a candidate are visited in descending order of the value of the function
/// at the candidate. If neither the function nor the candidate has been assigned yet, the candidate becomes the collocation point of the function.
SplineSurface read_iga(const std::filesystem::path& file);

/// Returns a surface as text of this format with 17 digits, so that reading it returns the same numbers.
std::string iga_text(const Space& space, const Net& net);

}  // namespace tanktread::spline
