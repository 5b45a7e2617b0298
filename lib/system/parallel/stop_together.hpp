#pragma once
// Points at which all ranks answer a request to stop the program.

#include <functional>

#include "base/stop.hpp"

namespace tanktread::coupling {

/// Throws Stopped on all ranks if any rank is to stop. If `work` is given, calls it first; it must make no collective calls, and its calls of
/// stop_here() may end it early. Collective.
void stop_together(const std::function<void()>& work = {});

}  // namespace tanktread::coupling
