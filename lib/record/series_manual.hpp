#pragma once
// The page of the manual about the results of a run.

#include <string>

#include "scene/registry.hpp"

namespace tanktread {

/// Returns a page in Markdown with the series and fields of the results, the entries of the summary and the derived and dimensionless numbers of a
/// scene, each with its unit.
std::string series_manual(const Registry& registry);

}  // namespace tanktread
