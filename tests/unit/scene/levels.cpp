// Test that the levels of a requested accuracy refine every mesh and every tolerance of a deck.
#include "accuracy/levels.hpp"

#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "deck/document.hpp"
#include "scene/scene.hpp"

namespace tanktread {
namespace {

/// Returns the setting of a key at a level, for a deck with this key; empty if the level does not set it.
std::string at_level(int level, const std::string& path, bool counts_elements) {
  accuracy::Values deck{{"Quadrature/rule", "adaptive"},
                        {"Adaptation/enabled", "true"},
                        {"Tube/azimuthal elements", "24"},
                        {"Channel/azimuthal elements", "24"},
                        {"Surface/mesh", path.starts_with("Surface/") && path != "Surface/elements per side" ? "polar" : "cube"}};
  if (path == "Surface/axial elements") deck["Particle/shape"] = "cylinder";
  deck[path] = counts_elements ? "24" : "1";
  for (const std::string& one : accuracy::settings(deck, {level, level, level}))
    if (one.starts_with(path + "=")) return one;
  return {};
}

TEST(LevelsOfADeck, RefineEveryNumberOfElementsAndEveryTolerance) {
  const std::set<std::string> kept{"Time/newton tolerance", "Time/linear tolerance",  // relative to Time/tolerance
                                   "Time/steady tolerance"};                          // states when a run ends
  std::istringstream lines(deck::manual(Scene()));
  std::string line, section;
  int n = 0;
  while (std::getline(lines, line)) {
    if (line.starts_with("## ")) section = line.substr(3);
    if (!line.starts_with("| `") || section.find('<') != section.npos) continue;
    const std::string key = line.substr(3, line.find('`', 3) - 3), path = section + "/" + key;
    const bool elements = key.find("elements") != key.npos;
    if (!(elements || key.ends_with("tolerance")) || kept.contains(path)) continue;
    EXPECT_NE(at_level(2, path, elements), "") << path;
    EXPECT_NE(at_level(2, path, elements), at_level(4, path, elements)) << path;
    ++n;
  }
  EXPECT_GT(n, 15);
}

}  // namespace
}  // namespace tanktread
