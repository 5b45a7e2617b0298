#include "app/deck_files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "surface/walls/outline.hpp"

namespace tanktread {

namespace {

/// Returns the path of a file or directory that a deck names, or `name` if it does not exist. Looks for the copy `kept` in the directory of a resumed
/// run (or in its folder `level_0`, if several Accuracy levels are resumed), then in the working directory, then in the directory of each deck.
std::string found(const std::string& name, const std::filesystem::path& kept, const DeckPlaces& at) {
  const std::filesystem::path path(name);
  std::vector<std::filesystem::path> places;
  if (!at.resume.empty() && !kept.empty())
    places = {std::filesystem::path(at.resume) / kept, std::filesystem::path(at.resume) / output::level_folder("0") / kept};
  places.push_back(path);
  for (const std::string& deck : at.decks) places.push_back(std::filesystem::path(deck).parent_path() / path);
  for (const auto& place : places)
    if (std::error_code error; std::filesystem::exists(place, error)) return place.string();
  return name;
}

/// Replaces `file` by its path, as returned by `found`. Registers it, or the newest snapshot of a run with this directory, to be copied into the
/// results directory under the name `kept`, after `other_` if another file has this name.
void find_and_keep(std::string& file, std::string kept, const DeckPlaces& at, Scene& scene) {
  while (std::ranges::find(scene.files, kept, &std::pair<std::string, std::string>::second) != scene.files.end()) kept.insert(0, "other_");
  file = found(file, kept, at);
  scene.files.emplace_back(output::newest_file(file), kept);
}

/// Returns the start of the names of copies of a particle's files.
std::string start_of_names(const ParticleKind& kind) { return kind.name.empty() ? "particle" : kind.name; }

/// Returns the name of the copy of a file with an outline or with a channel's points: the name of the original file without its folder.
std::string own_name(const std::string& file) { return std::filesystem::path(file).filename(); }

/// Finds the files (shapes, positions of copies) that the deck names in the section of a particle, and reads the shape.
void find_shapes(ParticleKind& kind, const DeckPlaces& at, Scene& scene) {
  surface::ParticleShape& shape = kind.particle.shape;
  if (kind.copies.file) find_and_keep(kind.copies.file->path, kind.name + ".csv", at, scene);
  if (shape.file) find_and_keep(*shape.file, start_of_names(kind) + ".iga", at, scene);
  if (auto& file = kind.membrane.stress_free_file) find_and_keep(*file, start_of_names(kind) + "_stress_free.iga", at, scene);
  shape.read();
  if (auto& initial = shape.initial; initial && (initial->file || initial->run))
    find_and_keep(initial->file ? *initial->file : *initial->run, start_of_names(kind) + "_initial" + (initial->file ? ".iga" : ".h5"), at, scene);
}

}  // namespace

void prepare(deck::Document& deck, const DeckPlaces& places, Scene& scene) {
  deck.declare(scene);
  if (auto& outline = scene.tube.outline) find_and_keep(outline->path, own_name(outline->path), places, scene);
  if (auto& channel = scene.tube.channel; channel && channel->points)
    find_and_keep(channel->points->path, own_name(channel->points->path), places, scene);
  if (scene.tube.present && scene.flow.flow_rate) {
    scene.tube.check();
    scene.flow.complete(surface::outline(scene.tube).area());
  }
  if (auto& history = scene.flow.history; history && history->file) {
    find_and_keep(history->file->path, "flow_history.csv", places, scene);
    history->read();
  }
  for (ParticleKind& kind : scene.particles) find_shapes(kind, places, scene);
  if (scene.domain.present) scene.domain.check(scene.flow, scene.tube.present ? scene.tube.list() : "");
  scene.particles = with_copies(scene.particles, scene.domain);
  scene.check();
}

}  // namespace tanktread
