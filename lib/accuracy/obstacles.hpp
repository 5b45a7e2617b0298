#pragma once
// Warnings because of which no error of a run can be estimated.

#include <string>
#include <string_view>

namespace tanktread::accuracy {

/// Kinds of warnings (Warning::kind). wrinkles: a compressed membrane forms wrinkles that its mesh does not represent. full_mesh: a mesh has reached
/// its largest size, so that the meshes of finer levels do not differ.
constexpr const char *wrinkles = "compression", *full_mesh = "number of points";

/// Returns the reason, as a clause, why no error can be estimated of a run with a warning of this kind, of any particle; empty for other kinds.
std::string obstacle_of(std::string_view kind);

}  // namespace tanktread::accuracy
