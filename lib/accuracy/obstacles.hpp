#pragma once

namespace tanktread::accuracy {

/// Words of the warning of a run whose compressed membrane forms wrinkles that its mesh does not represent. No error is estimated for such a run.
constexpr const char* wrinkles = "waves as short as its elements can have grown a hundredfold";

}  // namespace tanktread::accuracy
