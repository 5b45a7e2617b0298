// Tests that a value of the wrong type, at any place of a deck, is reported by a sentence about the deck and not by an exception of a library.

#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "deck/document.hpp"
#include "scene/scene.hpp"
#include "system/solvers/options.hpp"

namespace tanktread {
namespace {

/// Returns the paths of all sections and keys in the manual of keys. The name `volume` replaces `<name>`.
std::vector<std::string> paths() {
  const std::regex heading("## `?([^`]*)`?"), row(R"(\| `([^`]+)` \|.*)");
  std::istringstream manual(deck::manual(Scene()));
  std::vector<std::string> all;
  std::string section;
  for (std::string line; std::getline(manual, line);) {
    std::smatch found;
    if (std::regex_match(line, found, heading)) all.push_back(section = found[1]);
    else if (std::regex_match(line, found, row)) all.push_back(section + "/" + found[1].str());
  }
  for (std::string& path : all) path = std::regex_replace(path, std::regex("<name>"), "volume");
  return all;
}

TEST(WrongTypes, AreReportedBySentences) {
  const std::string decks[] = {"Tanktread:\n  Expect: {volume: {value: 1, tolerance: 1}}\n  Particle: {}\n",
                               "Tanktread:\n  Expect: {volume: {value: 1, tolerance: 1}}\n  Particles: {volume: {}}\n"};
  for (const std::string& path : paths())
    for (const std::string value : {"5", "word", "[1, 2]", "[a, 2]", "true", "{a: 1}"})
      for (const std::string& text : decks) try {
          deck::Document document = deck::read({}, {path + "=" + value, "Flow/viscosity=2"}, text, path.size() % 2 ? "" : "--no-expect");
          Scene scene;
          document.declare(scene);
          scene.check();
          coupling::try_solvers(scene.solvers, scene.time.nonlinear_solver);
        } catch (const UserError& error) {
          EXPECT_EQ(std::string(error.what()).find("Teuchos"), std::string::npos) << error.what();
        } catch (const std::exception& error) {
          ADD_FAILURE() << path << " = " << value << ": " << error.what();
        }
}

}  // namespace
}  // namespace tanktread
