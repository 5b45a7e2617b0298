#pragma once
// Steady problem of a rigid body, solved in memory, for comparisons with exact solutions.

#include <string>
#include <vector>

#include "deck/document.hpp"
#include "scene/particles/prescribed.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Solves a deck of inputs/ with settings `Section/key=value`, as for `--set`.
inline RigidSolution rigid_solution(const std::string& deck_name, const std::vector<std::string>& settings) {
  Scene whole;
  deck::Document deck = deck::read({std::string(SOURCE_DIRECTORY) + "/inputs/" + deck_name}, settings);
  deck.declare(whole);
  whole.check();
  const ParticleScene particle_scene = whole.first();
  coupling::Ranks ranks;
  Phases phases;
  const Body body = make_body(particle_scene);
  coupling::RigidTractions tractions = make_tractions(particle_scene, body, ranks, nullptr);
  return rigid_solution(particle_scene, body, tractions, phases);
}

}  // namespace tanktread
