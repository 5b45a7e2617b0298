#include "record/files/summary.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "deck/words.hpp"

namespace tanktread::output {
namespace {

std::string scalar(double value) { return deck::real_text(value); }
std::string scalar(long value) { return std::to_string(value); }
std::string scalar(bool value) { return value ? "true" : "false"; }
std::string scalar(const std::string& value) { return deck::in_quotes(value); }
std::string scalar(const Vec3& value) { return "[" + scalar(value[0]) + ", " + scalar(value[1]) + ", " + scalar(value[2]) + "]"; }

template <class Value>
std::string lines(const Entries<Value>& entries) {
  std::string text;
  for (const auto& [name, value] : entries) text += "  " + (deck::is_plain(name) ? name : scalar(name)) + ": " + scalar(value) + "\n";
  return text;
}

template <class Value>
std::string map(const std::string& key, const Entries<Value>& entries) {
  return key + ":" + (entries.empty() ? " {}\n" : "\n") + lines(entries);
}

}  // namespace

std::string yaml(const std::vector<deck::Verdict>& verdicts, const std::vector<double>& estimates) {
  std::string text = verdicts.empty() ? "expect: []\n" : "expect:\n";
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    const deck::Verdict& one = verdicts[k];
    text += "  - name: " + scalar(one.name) + "\n";
    text += "    value: " + scalar(one.value) + "\n";
    text += "    expected: " + scalar(one.expected) + "\n";
    text += "    error: " + scalar(one.error) + "\n";
    if (!estimates.empty()) text += "    estimated error: " + scalar(estimates[k]) + "\n";
    text += "    passed: " + scalar(one.passed) + "\n";
    if (!one.not_binding.empty()) text += "    not binding: " + scalar(one.not_binding) + "\n";
  }
  return text;
}

std::string yaml_status(const std::string& status) { return "status: " + scalar(status) + "\n"; }

std::string yaml(const Summary& summary) {
  std::string text = yaml_status(summary.status);
  text += map("final", summary.final) + lines(summary.final_vectors);
  if (!summary.final_in_si.empty()) text += map("final in SI", summary.final_in_si);
  text += yaml(summary.expect);
  text += map("counts", summary.counts) + map("seconds", summary.seconds);
  if (!summary.memory.empty()) text += map("memory", summary.memory);
  text += map("plan", summary.plan) + map("numbers", summary.numbers);
  if (!summary.errors.empty()) text += map("estimated errors", summary.errors);
  if (!summary.modes.empty()) text += map("modes", summary.modes);
  text += summary.warnings.empty() ? "warnings: []\n" : "warnings:\n";
  for (const std::string& one : summary.warnings) text += "  - " + scalar(one) + "\n";
  if (!summary.obstacles.empty()) text += "obstacles:\n";
  for (const std::string& one : summary.obstacles) text += "  - " + scalar(one) + "\n";
  return text;
}

bool reached_end(std::string_view status) { return status == run_status::done || status == run_status::steady || status == run_status::past; }

std::string status_of(const std::string& summary) {
  const std::string head = "status: \"";
  if (!summary.starts_with(head)) return {};
  return summary.substr(head.size(), summary.find('"', head.size()) - head.size());
}

std::string with_entry(std::string summary, const std::string& name, const std::string& entry) {
  const std::string head = name + ":";
  const auto next_line = [&](std::size_t at) { return std::min(summary.find('\n', at), summary.size() - 1) + 1; };
  std::size_t begin = 0;
  while (begin < summary.size() && summary.compare(begin, head.size(), head) != 0) begin = next_line(begin);
  std::size_t end = begin;
  while (end < summary.size() && (end == begin || summary[end] == ' ')) end = next_line(end);
  return summary.replace(begin, end - begin, entry);
}

std::vector<std::string> listed(const std::string& summary, const std::string& name) {
  std::istringstream lines(summary);
  std::vector<std::string> all;
  std::string line, text;
  while (std::getline(lines, line) && line != name + ":") continue;
  while (std::getline(lines, line) && line.starts_with("  - "))
    if (std::istringstream(line.substr(4)) >> std::quoted(text)) all.push_back(text);
  return all;
}

}  // namespace tanktread::output
