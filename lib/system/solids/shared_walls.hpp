#pragma once
// Walls, plates and posts that several systems of one run share.

#include <functional>
#include <memory>
#include <vector>

#include "system/solids/ducts/wall.hpp"
#include "system/solids/plates/plates_and_posts.hpp"

namespace tanktread::coupling {

/// Objects of one kind that several systems may use.
template <class Object>
class Shared {
 public:
  /// Returns an object for which `fits` returns true: one that another system uses or that was used last, otherwise a new one, the result of `make`.
  std::shared_ptr<Object> of(const std::function<bool(const Object&)>& fits, const std::function<Object*()>& make) {
    std::erase_if(known_, [](const std::weak_ptr<Object>& one) { return one.expired(); });
    for (const std::weak_ptr<Object>& one : known_)
      if (const std::shared_ptr<Object> known = one.lock(); fits(*known)) return latest_ = known;
    latest_.reset();  // before the new object takes memory
    latest_.reset(make(), [sum = of_deleted_](Object* old) {
      *sum += old->evaluations();
      delete old;
    });
    known_.push_back(latest_);
    return latest_;
  }

  /// Returns the number of kernel evaluations on this rank by all objects, including objects that have been deleted.
  stokes::Evaluations evaluations() const {
    stokes::Evaluations all = *of_deleted_;
    for (const std::weak_ptr<Object>& one : known_)
      if (const std::shared_ptr<Object> object = one.lock()) all += object->evaluations();
    return all;
  }

 private:
  std::shared_ptr<stokes::Evaluations> of_deleted_ = std::make_shared<stokes::Evaluations>();
  std::vector<std::weak_ptr<Object>> known_;
  std::shared_ptr<Object> latest_;  // kept for the next system even if no system uses it
};

/// Walls of ducts, plates and posts of one run. A branch of steady shapes, for example, has one system per value of its parameter, but often one
/// wall, which is then assembled and factored only once. Counts the kernel evaluations of each wall once.
struct SharedWalls {
  Shared<Wall> ducts;
  Shared<PlatesAndPosts> solids;

  stokes::Evaluations evaluations() const { return ducts.evaluations() + solids.evaluations(); }
};

/// Returns the wall for these arguments of the constructor of Wall, shared with the other systems of `walls`; a new one if `walls` is null.
/// Collective.
inline std::shared_ptr<Wall> shared_wall(SharedWalls* walls, const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases,
                                         const surface::Symmetry& symmetry, const WallSolver& solver) {
  const auto make = [&] { return new Wall(wall, quadrature, phases, symmetry, solver); };
  if (!walls) return std::shared_ptr<Wall>(make());
  return walls->ducts.of([&](const Wall& one) { return one.is_for(wall, quadrature, symmetry, solver); }, make);
}

}  // namespace tanktread::coupling
