#pragma once

namespace tanktread::accuracy {

/// Phrase that identifies the warning of a run whose compressed membrane forms wrinkles that its mesh does not represent. No error is estimated for
/// such a run.
constexpr const char* wrinkles = "waves as short as its elements can have grown a hundredfold";

/// Phrase that identifies the warning of a run whose mesh has reached its largest size, so that the meshes of finer levels do not differ. No error is
/// estimated.
constexpr const char* full_mesh = "Adaptation/largest number of points = ";

}  // namespace tanktread::accuracy
