#pragma once

#include <string>

namespace tanktread {

/// Returns the text that printf would print.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

}  // namespace tanktread
