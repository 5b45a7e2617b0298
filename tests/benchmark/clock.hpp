#pragma once
// The clock of the benchmarks.

#include <ctime>

/// Returns the seconds of processor time, which do not depend on other processes of the machine.
inline double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
