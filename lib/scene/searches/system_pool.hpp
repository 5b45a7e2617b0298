#pragma once
// The systems that a search for steady shapes uses.

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "record/files/checkpoint.hpp"
#include "scene/searches/searches.hpp"
#include "scene/searches/steady_system.hpp"
#include "scene/series/run_totals.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread {

/// Builds systems: the system of the deck, the systems along a branch, and variants of a system. Counts the operations of all of them. Keeps the
/// three systems of a branch that were used last, because one point of the branch needs several. All systems of a branch have the same mesh.
class SystemPool {
 public:
  /// Builds the system of `scene`. `scene`, `ranks` and `phases` must outlive this object, and this object must outlive the systems that it returns.
  /// Collective.
  SystemPool(const Scene& scene, ChangedScene changed, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), changed_(std::move(changed)), ranks_(ranks), phases_(phases) {
    systems_.emplace_front(Parameters(), make_system(scene));
  }
  SystemPool(const SystemPool&) = delete;

  /// Returns the system of the branch that was used last; at first, the system of the deck.
  const std::shared_ptr<SteadySystem>& latest() const { return systems_.front().second; }

  /// Begins a branch. `first`: values of the parameters in the deck, from first_parameters().
  void begin_branch(const Parameters& first) {
    systems_.front().first = first;
    rest_ = latest()->particles->body().rest, unstressed_ = latest()->particles->body().unstressed;
  }

  /// Returns the system for these values of the parameters. A new system starts from the initial shape of the deck or, once the mesh has adapted,
  /// from x. If the deck does not allow the values, throws RunFailure instead of UserError, so that the points of the branch computed so far are
  /// kept. Collective.
  std::shared_ptr<SteadySystem> at(const Parameters& parameters, const coupling::State& x) try {
    const auto known = std::ranges::find(systems_, parameters, &std::pair<Parameters, std::shared_ptr<SteadySystem>>::first);
    if (known != systems_.end()) {
      std::rotate(systems_.begin(), known, known + 1);
      return latest();
    }
    const auto clock = phases_.time("set-up");
    const std::shared_ptr<SteadySystem> made = make_system(scene_of_branch(scene_, changed_, parameters));
    if (mesh_ && !(made->particles->body().rest == rest_ && made->particles->body().unstressed == unstressed_))
      throw UserError("the mesh has adapted, but the resting or unstressed shape depends on this key: set Adaptation/enabled to false");
    if (mesh_) made->move_to(*mesh_, x);
    const int points = made->particles->body().space.n_points, expected = latest()->particles->body().space.n_points;
    if (points != expected)
      throw UserError("Continuation needs one mesh, but " + text(parameters) + formatted(" has %d control points, not %d.", points, expected));
    systems_.emplace_front(parameters, made);
    if (systems_.size() > 3) systems_.pop_back();
    return made;
  } catch (const UserError& error) {
    throw RunFailure(formatted("%s cannot be computed (%s)", text(parameters).c_str(), error.what()));
  }

  /// Uses the mesh of latest(), which has been adapted, for all systems of the branch from now on.
  void adapted() {
    mesh_ = latest()->mesh();
    systems_.resize(1);
  }

  /// Returns a new system with another scene, on the mesh of the system `like` and with the shape x. Collective.
  std::shared_ptr<SteadySystem> variant(const SteadySystem& like, Scene scene, const coupling::State& x) {
    std::shared_ptr<SteadySystem> made = make_system(std::move(scene));
    made->move_to(like.mesh(), x);
    return made;
  }

  /// Sets in `totals` the operation counts and kernel evaluations of all systems, including deleted ones. Collective.
  void count(RunTotals& totals) const {
    totals.counts = counts_, totals.kernel = kernel_;
    for (const std::weak_ptr<SteadySystem>& one : built_)
      if (const std::shared_ptr<SteadySystem> system = one.lock())
        totals.counts = totals.counts + system->particles->counts(), totals.kernel += system->particles->kernel_evaluations();
    totals.kernel = ranks_.of_all(totals.kernel + walls_->evaluations());
  }

 private:
  /// Builds a system. When the system is deleted, its numbers of operations are added to `counts_` and `kernel_`.
  std::shared_ptr<SteadySystem> make_system(Scene scene) {
    scene.walls = walls_;
    std::shared_ptr<SteadySystem> made(new SteadySystem(std::move(scene), ranks_, phases_), [this](SteadySystem* system) {
      counts_ = counts_ + system->particles->counts(), kernel_ += system->particles->kernel_evaluations();
      delete system;
    });
    built_.push_back(made);
    return made;
  }

  std::string text(const Parameters& parameters) const { return scene_.continuation.text(parameters[0], parameters[1]); }

  const Scene& scene_;
  ChangedScene changed_;
  coupling::Ranks& ranks_;
  Phases& phases_;
  coupling::OperationCounts counts_;           // operation counts of deleted systems
  stokes::Evaluations kernel_;                 // kernel evaluations of deleted systems on this rank
  std::vector<std::weak_ptr<SteadySystem>> built_;   // all systems
  std::shared_ptr<coupling::SharedWalls> walls_ = std::make_shared<coupling::SharedWalls>();  // walls of all systems
  std::deque<std::pair<Parameters, std::shared_ptr<SteadySystem>>> systems_;  // parameters and systems of the branch, last used first
  Net rest_, unstressed_;                      // resting and unstressed shapes of the branch on the mesh of the deck
  std::optional<output::Checkpoint> mesh_;     // mesh of the branch; not set if it is the mesh of the deck
};

}  // namespace tanktread
