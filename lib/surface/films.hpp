#pragma once
// How narrow the films between surfaces are.

#include <span>
#include <vector>

#include "surface/patch.hpp"

namespace tanktread::surface {

/// Of each element of a surface the width of the film between it and others: the smallest of its distances, at 3 x 3 places, from the tangent plane
/// of the nearest of 5 x 5 places of each element there. Right to the square of a quarter of the others' elements, times their curvature, over eight.
/// Infinite where no other is within `reach`.
std::vector<double> film_widths(const Patches& surface, std::span<const Patches* const> others, double reach);

}  // namespace tanktread::surface
