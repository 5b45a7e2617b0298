#pragma once
// Limits of the elements of spline spaces, by which kernels dimension their arrays. `spline/iga.cpp` rejects files that exceed them.

namespace tanktread::spline {

constexpr int least_degree = 2, largest_degree = 6;  ///< degree of an element
constexpr int most_functions = 64;                   ///< number of basis functions on an element

}  // namespace tanktread::spline
