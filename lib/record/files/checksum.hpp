#pragma once
// A short number for what has been written, to be compared with what is read.

#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>

namespace tanktread::output {

/// Mixes words into one number that every bit of them changes (a chain of invertible steps, the constants of FNV-1a).
class Checksum {
 public:
  void add(std::uint64_t word) { sum_ = std::rotl((sum_ ^ word) * 0x00000100000001b3u, 29); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }

  /// Sixteen hexadecimal ones.
  std::string digits() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, sum_);
    return text;
  }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

}  // namespace tanktread::output
