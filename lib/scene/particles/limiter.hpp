#pragma once
// The limiter of gaps between particles: `Contact/limiter`.

#include <memory>
#include <vector>

#include "motion/integrator.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "system/capsule.hpp"
#include "system/contact.hpp"
#include "system/ranks.hpp"

namespace tanktread {

/// After a step, moves the particles so that no gap of two is below `limit`, by non-negative forces along the normals at their nearest places, which
/// act for the time of the step: the complementarity problem (4.23) of the linearised gaps, repeated until the true ones hold. A pair that is below
/// the limit in other places too has contacts there, which, less than 1 % below it, go back at the rate of the motion. The forces of the step
/// before, which acted in this one, are changed by what it takes, and left to act in the next one: then contacts that last cost a step the square of
/// its length. Mobilities are those of the system, of what deforms after an implicit step with its stiffness.
class Limiter {
 public:
  /// `limit`: a length. `unit`: a force of the order of those in the fluid. `rate`: of the motion. What is given by reference outlives this.
  Limiter(const std::vector<Member>& members, coupling::Capsule& capsule, const coupling::Ranks& ranks, double limit, double unit,
          double rate)
      : members_(members), capsule_(capsule), ranks_(ranks), limit_(limit), unit_(unit), rate_(rate) {}

  /// At the end of a step. Where gaps are below half of the limit, or cannot be held, nothing is changed but the system's memory, and the step is to
  /// be shorter. Collective.
  bool hold(motion::State& state, double step, coupling::Contacts& contacts);

 private:
  /// A contact, its force in units, and what a unit of force does in the step.
  struct Held {
    coupling::Contact contact;
    double gap, target;  // it is to be this
    double before, force;
    Net work, response;
  };

  bool find(const Net& x);
  Held held(const Approach& found, double target) const;
  Held* beside(const coupling::Contact& contact, const Net& x);
  double target(const Approach& found) const;
  double error() const;
  bool respond(const motion::State& state);
  Net moved(const Net& start);
  coupling::Contacts with_forces(const Net& x, double impulse) const;

  const std::vector<Member>& members_;
  coupling::Capsule& capsule_;
  const coupling::Ranks& ranks_;
  double limit_, unit_, rate_;
  double step_ = 0;
  std::vector<Held> held_;
  Net load_;                                  // the contacts' so far
  std::shared_ptr<coupling::Evaluation> base_;  // with it
};

}  // namespace tanktread
