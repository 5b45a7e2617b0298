#include "output/summary.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "output/file.hpp"
#include "output/text.hpp"

namespace tanktread::output {
namespace {

std::string scalar(double value) { return number(value); }
std::string scalar(long value) { return std::to_string(value); }
std::string scalar(bool value) { return value ? "true" : "false"; }
std::string scalar(const std::string& value) { return in_quotes(value); }
std::string scalar(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + number(value);
  return text + "]";
}

/// Without quotes where YAML 1.1 can only take it for a word.
std::string key_text(const std::string& name) {
  constexpr std::string_view others[] = {"yes", "no", "on", "off", "y", "n", "true", "false", "null"};
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz";
  const bool plain = std::ranges::find(others, name) == std::end(others) && !name.empty() && letters.find(name.front()) != letters.npos &&
                     name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_- ") == name.npos && name.back() != ' ';
  return plain ? name : in_quotes(name);
}

template <class Value>
std::string lines(const Entries<Value>& entries) {
  std::string text;
  for (const auto& [name, value] : entries) text += "  " + key_text(name) + ": " + scalar(value) + "\n";
  return text;
}

template <class Value>
std::string map(std::string_view key, const Entries<Value>& entries) {
  return std::string(key) + ":" + (entries.empty() ? " {}\n" : "\n") + lines(entries);
}

}  // namespace

std::string yaml(const Summary& summary) {
  std::string text = "status: " + scalar(summary.status) + "\n";
  text += map("final", summary.final) + lines(summary.final_vectors);
  text += summary.expect.empty() ? "expect: []\n" : "expect:\n";
  for (const Expected& one : summary.expect) {
    text += "  - name: " + scalar(one.name) + "\n";
    text += "    value: " + scalar(one.value) + "\n";
    text += "    expected: " + scalar(one.expected) + "\n";
    text += "    error: " + scalar(one.error) + "\n";
    text += "    passed: " + scalar(one.passed) + "\n";
    if (!one.not_binding.empty()) text += "    not binding: " + scalar(one.not_binding) + "\n";
  }
  text += map("counts", summary.counts) + map("seconds", summary.seconds) + map("plan", summary.plan) + map("numbers", summary.numbers);
  text += summary.warnings.empty() ? "warnings: []\n" : "warnings:\n";
  for (const std::string& one : summary.warnings) text += "  - " + scalar(one) + "\n";
  return text;
}

void write_summary(const std::filesystem::path& path, const Summary& summary) { write_whole(path, yaml(summary)); }

}  // namespace tanktread::output
