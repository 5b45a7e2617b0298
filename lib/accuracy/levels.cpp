#include "accuracy/levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "base/errors.hpp"
#include "deck/words.hpp"
#include "motion/adaptation.hpp"

namespace tanktread::accuracy {

namespace {

constexpr std::array<int, last_level + 1> sides{3, 4, 5, 7, 9, 12, 16, 21, 28, 37, 50, 66};
constexpr double least_quadrature = 1e-6;  // smallest Quadrature/tolerance of a level: the smallest error of near-singular quadrature

/// Collects the settings `Section/key=value` of a level in `all`, computed from the values of the deck.
class Setter {
 public:
  explicit Setter(const Values& deck) : deck_(deck) {}

  bool has_section(const std::string& name) const {
    const auto first = deck_.lower_bound(name + "/");
    return first != deck_.end() && first->first.starts_with(name + "/");
  }
  bool has(const std::string& path) const { return deck_.contains(path) && !deck_.at(path).empty(); }
  double number(const std::string& path, double otherwise) const { return has(path) ? std::strtod(deck_.at(path).c_str(), nullptr) : otherwise; }
  std::string text(const std::string& path) const {
    if (!has(path)) return {};
    std::string value = deck_.at(path);
    std::erase(value, '"');
    return value;
  }

  void set(const std::string& path, double value) { all.push_back(path + "=" + deck::number_text(value)); }
  void set_whole(const std::string& path, double value, double least, double most) { set(path, std::clamp(std::round(value), least, most)); }
  /// Multiplies the value of a key by `factor` if the deck has the key.
  void scale(const std::string& path, double factor) {
    if (has(path)) set(path, number(path, 0) * factor);
  }
  /// Sets the whole number `value` x n/6 at a level with n elements per side, limited to `least` ... `most`. If level 0 would have less than `least`,
  /// every level has proportionally more, so that all levels differ.
  void refine(const std::string& path, double value, int level, double least, double most) {
    const double at_first = value * elements_per_side(0) / 6;
    set_whole(path, value * std::max(1., least / at_first) * elements_per_side(level) / 6, least, most);
  }
  /// Refines the value of a key if the deck has the key.
  void refine(const std::string& path, int level, double least, double most) {
    if (has(path)) refine(path, number(path, 0), level, least, most);
  }
  /// Sets a tolerance to `most` if the deck has a larger value.
  void lower(const std::string& path, double most) {
    if (has(path) && number(path, 0) > most) set(path, most);
  }

  std::vector<std::string> all;

 private:
  const Values& deck_;
};

/// Returns the prefixes of the keys of all particles: empty for a single particle, otherwise `Particles/<name>/`.
std::vector<std::string> particles(const Values& deck) {
  std::vector<std::string> prefixes;
  for (const auto& [path, value] : deck)
    if (path.starts_with("Particles/")) {
      const std::string prefix = path.substr(0, path.find('/', std::string("Particles/").size()) + 1);
      if (prefix.size() > std::string("Particles/").size() && prefix != "Particles/defaults/" &&
          std::ranges::find(prefixes, prefix) == prefixes.end())
        prefixes.push_back(prefix);
    }
  if (prefixes.empty()) prefixes.emplace_back();
  return prefixes;
}

/// Returns the key of the particle with this prefix: `Particle/<key>`, or `Particles/<name>/<key>`.
std::string of_particle(const std::string& prefix, const std::string& key) { return (prefix.empty() ? "Particle/" : prefix) + key; }

bool is_post(const Setter& deck, const std::string& prefix) { return deck.text(of_particle(prefix, "shape")) == "cylinder"; }

/// Returns the number of elements per side in the deck; for a polar mesh, half the number of elements from pole to pole.
double side_of(const Setter& deck, const std::string& prefix) {
  if (deck.text(prefix + "Surface/mesh") == "polar") return deck.number(prefix + "Surface/meridional elements", 16) / 2;
  return deck.number(prefix + "Surface/elements per side", 6);
}

void set_adaptation(Setter& to, const std::string& list, double length) {
  const double error = std::pow(length, 4);
  to.scale(list + "surface tolerance", error);
  to.scale(list + "load tolerance", error);
  to.scale(list + "coarsening tolerance", error);
  to.scale(list + "reference length", length);
  if (to.has(list + "film resolution"))
    to.scale(list + "film resolution", length);
  else if (std::ranges::any_of(std::array{"Tube", "Channel", "Wall", "Domain"}, [&](const char* section) { return to.has_section(section); }))
    to.set(list + "film resolution", motion::AdaptationOptions::default_film_resolution * length);
  to.scale(list + "minimum length", std::min(1., length));
}

void set_mesh(Setter& to, const std::string& prefix, double ratio, int level) {
  const double n = std::max(3., std::round(ratio * elements_per_side(level)));
  const double deck_n = side_of(to, prefix);
  const std::string surface = prefix + "Surface/";
  if (to.text(surface + "mesh") == "polar") {
    const double around = to.number(surface + "azimuthal elements", 32) / to.number(surface + "meridional elements", 16);
    to.set_whole(surface + "meridional elements", 2 * n, 4, 200);
    to.set_whole(surface + "azimuthal elements", 4 * std::round(2 * n * around / 4), 4, 400);
  } else {
    to.set_whole(surface + "elements per side", n, 3, 200);
  }
  if (to.text(prefix + "Adaptation/enabled") == "true") set_adaptation(to, prefix + "Adaptation/", deck_n / n);
}

/// Sets the mesh of a post (a particle of the shape `cylinder`).
void set_post(Setter& to, const std::string& surface, int level) {
  to.refine(surface + "azimuthal elements", to.number(surface + "azimuthal elements", 24), level, 8, 400);
  to.refine(surface + "axial elements", level, 4, 400);
}

void set_wall(Setter& to, const std::string& list, int level) {
  if (!to.has(list + "/azimuthal elements")) return;
  to.refine(list + "/azimuthal elements", level, 8, 400);
  to.refine(list + "/axial elements", level, list == "Channel" ? 8 : 4, list == "Channel" ? 1000 : 400);
  to.set_whole(list + "/flow elements", 16 * elements_per_side(level), 8, 4000);
}

double quadrature_tolerance(int level) { return std::max(tolerance(level), least_quadrature); }

void set_time(Setter& to, const Level& level) {
  const double most = tolerance(level.time);
  if (to.has("Time/fixed step"))
    to.scale("Time/fixed step", std::pow(2., 2 - level.time));
  else
    to.set("Time/tolerance", std::max(most, 1e-13));
  to.lower("Time/iteration tolerance", most / 10);
  if (to.has_section("Continuation"))
    to.lower("Steady/tolerance", most / 100);  // never raised: branches accept corrections of up to 30 times the tolerance as converged
  else if (to.has("Steady/tolerance"))  // no smaller value is kept, because quadrature errors prevent smaller corrections
    to.set("Steady/tolerance", std::max(most, quadrature_tolerance(level.quadrature)) / 100);
  to.lower("Periodic/tolerance", std::clamp(10 * most, 1e-10, 1e-2));
  to.lower("Continuation/fold tolerance", std::clamp(most / 100, 1e-12, 1e-2));
}

void set_quadrature(Setter& to, int level) {
  const double most = quadrature_tolerance(level);
  if (to.text("Quadrature/rule") == "adaptive")
    to.set("Quadrature/tolerance", most);
  else
    to.set_whole("Quadrature/points", 4 + 2 * level, 2, 64);
  to.lower("Solvers/tolerance", std::max(most / 100, 1e-15));
}

}  // namespace

double tolerance(int level) { return 2e-3 / std::pow(4., level); }

int elements_per_side(int level) { return sides.at(static_cast<std::size_t>(level)); }

double expected_error(const Level& level) {
  return std::pow(static_cast<double>(elements_per_side(level.mesh)) / elements_per_side(0), -mesh_order);
}

Level balanced(int k, double time, double quadrature) {
  const double whole = expected_error(same(k)) / expected_error(same(2));
  const auto level = [&](double share, double ratio) {
    const double part = share * std::pow(ratio, 2 - k);
    const double looser = part > 0 ? std::floor(std::log(whole / (4 * part)) / std::log(ratio) + 1e-9) : 2;
    return std::max(2, k - static_cast<int>(std::clamp(looser, -2., 2.)));
  };
  return {k, level(time, time_ratio), level(quadrature, quadrature_ratio)};
}

std::vector<std::string> settings(const Values& deck, const Level& level) {
  Setter to(deck);
  std::vector<std::string> all = particles(deck);
  const auto posts = std::ranges::partition(all, [&](const std::string& prefix) { return !is_post(to, prefix); });
  for (const std::string& prefix : posts) set_post(to, prefix + "Surface/", level.mesh);
  all.erase(posts.begin(), posts.end());
  double coarsest = std::numeric_limits<double>::infinity();
  for (const std::string& prefix : all) coarsest = std::min(coarsest, side_of(to, prefix));
  for (const std::string& prefix : all) set_mesh(to, prefix, side_of(to, prefix) / coarsest, level.mesh);
  for (const char* list : {"Tube", "Channel"}) set_wall(to, list, level.mesh);
  to.refine("Wall/elements per period", level.mesh, 4, 200);
  set_time(to, level);
  set_quadrature(to, level.quadrature);
  return to.all;
}

void check_levels(const Values& deck) {
  const Setter reads(deck);
  const bool plates = reads.has("Wall/normal") && (reads.has("Domain/side lengths") || reads.has("Domain/lattice vectors"));
  if (plates && !reads.has("Wall/elements per period"))
    throw UserError("Accuracy needs Wall/elements per period, because the levels refine the walls of a Domain in proportion to it.");
  for (const std::string& prefix : particles(deck))
    for (const std::string& key : {of_particle(prefix, "initial shape/file"), of_particle(prefix, "initial shape/run"),
                                   prefix + "Membrane/stress-free file"})
      if (reads.has(key))
        throw UserError("Accuracy and " + key +
                        " contradict each other: the shape is given on one mesh, and the errors are estimated from several meshes.");
}

std::string without_section(const std::string& deck, const std::string& section) {
  std::istringstream lines(deck);
  std::string text, line;
  bool inside = false;
  while (std::getline(lines, line)) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent != std::string::npos && indent <= 2) inside = line.starts_with("  " + section + ":");
    if (!inside) text += line + "\n";
  }
  return text;
}

}  // namespace tanktread::accuracy
