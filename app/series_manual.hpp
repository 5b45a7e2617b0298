#pragma once
// The manual of what a run writes: inputs/SERIES.md.

#include <string>

namespace tanktread {

/// Every series, field, array and entry of the results in Markdown, with unit and meaning. Printed by `tanktread --reference-series`.
std::string series_manual();

}  // namespace tanktread
