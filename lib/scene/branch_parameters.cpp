#include "scene/branch_parameters.hpp"

#include <cstdlib>
#include <vector>

#include "base/errors.hpp"
#include "deck/document.hpp"
#include "deck/words.hpp"

namespace tanktread {

namespace {

/// The number that the deck gives to the key at `path`, of which the key `of` tells. Throws UserError where it has none.
double number_of(const Scene& scene, const std::string& deck, const std::string& path, const std::string& of) {
  deck::Document read = deck::read_text(deck);
  Scene again = scene;
  again.particles.clear(), again.expect.all.clear();
  read.declare(again);
  const auto values = read.values();
  const auto found = values.find(path);
  if (found == values.end()) throw UserError(of + " must be the path of a key that this deck gives, but is " + deck::in_quotes(path) + ".");
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  if (end == found->second.c_str() || *end != 0) throw UserError(of + " must be the path of a number, but " + path + " is " + found->second + ".");
  return value;
}

}  // namespace

Scene at_parameters(const Scene& scene, const std::string& deck, const Parameters& values) {
  Scene other = scene;
  other.particles.clear(), other.expect.all.clear();
  std::vector<std::string> settings{scene.continuation.parameter + "=" + deck::real_text(values[0])};
  if (scene.continuation.second_parameter) settings.push_back(*scene.continuation.second_parameter + "=" + deck::real_text(values[1]));
  deck::Document changed = deck::read({}, settings, deck);
  changed.declare(other);
  other.particles = with_copies(other.particles, other.domain);
  other.check();
  return other;
}

Parameters first_parameters(const Scene& scene, const std::string& deck) {
  const motion::ContinuationOptions& branch = scene.continuation;
  const double first = number_of(scene, deck, branch.parameter, "Continuation/parameter");
  if (first == branch.to) throw UserError("Continuation/to must differ from " + branch.parameter + ", where the branch begins.");
  return {first, branch.second_parameter ? number_of(scene, deck, *branch.second_parameter, "Continuation/second parameter") : 0};
}

}  // namespace tanktread
