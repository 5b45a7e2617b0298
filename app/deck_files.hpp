#pragma once
// Scene of a deck, with the files that the deck names.

#include <string>
#include <vector>

#include "deck/document.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Places in which files that a deck names are searched for.
struct DeckPlaces {
  std::vector<std::string> decks;  ///< paths of the deck and its overlays
  std::string resume;              ///< directory of the run that is resumed; empty for a new run
};

/// Declares the keys of the scene, reads the files that the deck names, and checks the scene. Registers the files, so that the run copies them into
/// its directory and can be resumed without the originals. Throws UserError.
void prepare(deck::Document& deck, const DeckPlaces& places, Scene& scene);

}  // namespace tanktread
