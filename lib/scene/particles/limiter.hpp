#pragma once
// Limiter of the gaps between particles: `Contact/limiter`.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "motion/integrator.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "system/capsule.hpp"
#include "system/contact.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread {

/// Moves the particles after a step by contact forces, so that no gap between two particles is below `limit`. The forces are non-negative and act
/// along the normals at the nearest points for the duration of the step. They solve the complementarity problem (4.23) of the linearised gaps. The
/// problem is linearised again until the true gaps satisfy it. If a pair with a contact is also below the limit at other positions, contacts are
/// added there. If the gap at an added contact is less than 1 % below the limit, it returns to the limit gradually, at the rate of the motion. The
/// forces found after one step act during the next step, and are corrected after it. For lasting contacts, the error per step is then of the order of
/// the squared step size. The displacement due to a contact force is computed with the coupled system of all particles. After an implicit step it
/// includes the effect of the stiffness of deformable particles.
class Limiter {
 public:
  /// `limit`: smallest allowed gap, a length. `unit`: a force of the order of the viscous forces. `rate`: rate of the motion, 1/time. `set_loads`:
  /// function that sets the loads by surface fields in the state that is passed to `hold`; called before the first evaluation of the system. Objects
  /// passed by reference must outlive this object.
  Limiter(const std::vector<Member>& members, coupling::Capsule& capsule, const coupling::Ranks& ranks, double limit, double unit,
          double rate, std::function<void()> set_loads)
      : members_(members), capsule_(capsule), ranks_(ranks), limit_(limit), unit_(unit), rate_(rate), set_loads_(std::move(set_loads)) {}

  /// Moves the particles at the end of a step so that no gap is below the limit. Returns false if a gap is below half of the limit, if no forces
  /// restore the limit, or if an evaluation fails. The caller must then discard the shapes `x` and `contacts`, set the previous contact forces in the
  /// system again, and repeat the step with a smaller size. `stiff`: true after an implicit step. Collective.
  bool hold(Net& x, bool stiff, double step, coupling::Contacts& contacts);

 private:
  /// A contact and its force, as a multiple of `unit`, before and after hold(). `work`: load vector (virtual work per control point) of a contact
  /// force of one `unit`. `response`: displacement of all points in one step by this force; empty until it is computed.
  struct Held {
    coupling::Contact contact;
    double gap, target;  // gap, and its required value
    double before, force;
    Net work, response;
  };

  bool find(const Net& x);
  Held held(const Approach& found, double target) const;
  Held* known_near(const coupling::Contact& contact, const Net& x);
  double target(const Approach& found) const;
  double error() const;
  bool respond(const Net& start, bool stiff);
  Net moved(const Net& start);
  coupling::Contacts with_forces(const Net& x, double impulse) const;

  const std::vector<Member>& members_;
  coupling::Capsule& capsule_;
  coupling::CoupledMotion shapes_{capsule_};  // motion of the shapes without the fields on them
  const coupling::Ranks& ranks_;
  double limit_, unit_, rate_;
  std::function<void()> set_loads_;
  double step_ = 0;
  std::vector<Held> held_;
  Net load_;                                  // load vector (virtual work per control point) of the contact forces that acted during the step
  std::shared_ptr<coupling::Evaluation> base_;  // evaluation of the system under the contact forces `load_`
};

}  // namespace tanktread
