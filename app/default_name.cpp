#include "app/default_name.hpp"

#include <algorithm>
#include <filesystem>

#include "output/checksum.hpp"

namespace tanktread {
namespace {

bool portable(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '='; }

std::string stem(const std::string& path) { return std::filesystem::path(path).stem(); }

}  // namespace

std::string default_name(const std::vector<std::string>& decks, const std::vector<std::string>& settings) {
  constexpr std::size_t longest = 100;
  std::string laid_over;
  output::Checksum sum;
  for (const std::string& deck : decks) {
    sum.add(deck);
    if (&deck != &decks.front()) laid_over += "_" + stem(deck);
  }
  for (const std::string& setting : settings) {
    sum.add(setting);
    const std::size_t key = setting.substr(0, setting.find('=')).rfind('/') + 1;
    laid_over += "_" + setting.substr(key);
  }
  std::ranges::replace_if(laid_over, [](char c) { return !portable(c); }, '_');
  const std::string name = stem(decks.front()) + laid_over;
  if (laid_over.empty() || name.size() <= longest) return name;
  const std::string end = "_" + sum.digits();
  return name.substr(0, longest - end.size()) + end;
}

}  // namespace tanktread
