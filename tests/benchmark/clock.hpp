#pragma once
// The clock of the benchmarks.

#include <ctime>

/// Seconds of processor time: a busy machine does not count.
inline double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
