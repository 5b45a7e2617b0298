#pragma once

namespace tanktread::accuracy {

/// Part of the warning text of a run whose compressed membrane forms wrinkles that its mesh does not represent. No error is estimated for such a run.
constexpr const char* wrinkles = "waves as short as its elements can have grown a hundredfold";

/// Part of the warning text of a run whose mesh has reached its largest size. The meshes of finer levels then do not differ, so no error is
/// estimated.
constexpr const char* full_mesh = "Adaptation/largest number of points = ";

}  // namespace tanktread::accuracy
