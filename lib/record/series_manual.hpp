#pragma once
// The page of the manual about the results of a run.

#include <string>

#include "base/columns.hpp"
#include "scene/registry.hpp"

namespace tanktread {

/// Returns a page in Markdown with the series and fields of the results, the entries of the summary and the derived and dimensionless numbers of a
/// scene, each with its unit.
std::string series_manual(const Registry& registry);

/// Returns the columns of all kinds of runs and particles, without values, in the order of the manual. A name that several kinds have occurs once.
Columns columns_of_all_runs();

}  // namespace tanktread
