#include "scene/particles/limiter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/particles/gaps.hpp"
#include "spline/basis.hpp"

namespace tanktread {

namespace {

constexpr double tolerance = 1e-6;  // largest permitted deviation of a gap from its required value, divided by the limit
constexpr int most_rounds = 40;
constexpr double slack = ContactOptions::slack;

bool of_same_pair(const coupling::Contact& a, const coupling::Contact& b) { return a.particle == b.particle && a.beyond.isApprox(b.beyond, 1e-6); }

Vec3 place(const std::vector<Member>& members, const Net& x, const coupling::Contact& contact) {
  const Member& member = members[contact.particle[0]];
  return surface::value(member.body->space, member.own(x), contact.site[0]);
}

}  // namespace

bool Limiter::hold(Net& shapes, bool stiff, double step, coupling::Contacts& contacts) {
  const Net start = shapes;
  step_ = step, held_.clear(), base_.reset();
  load_ = coupling::work(capsule_.particles(), contacts, start.rows());
  for (const coupling::Contact& one : contacts.all) {
    const Approach now = approach(members_, start, one);
    held_.push_back(held(now, target(now)));
  }
  Net x = start;
  bool holds = find(x);
  if (!held_.empty()) set_loads_();
  for (int round = 0; holds && error() > tolerance; ++round) {
    holds = round < most_rounds && respond(start, stiff) && (x = moved(start)).allFinite() && find(x);
  }
  if (!holds || (held_.empty() && contacts.all.empty())) {
    capsule_.set_forces(&coupling::Capsule::Forces::contacts, load_);
    return holds;
  }
  contacts = with_forces(x, contacts.impulse);
  shapes = x;
  capsule_.set_forces(&coupling::Capsule::Forces::contacts, coupling::work(capsule_.particles(), contacts, x.rows()));
  return capsule_.velocity(x).allFinite();
}

Limiter::Held Limiter::held(const Approach& found, double target) const {
  const double force = found.contact.force / unit_;
  return {found.contact, found.gap, target, force, force, {}, {}};
}

/// Updates the gaps of known contacts in the shape x. Adds a contact at every other position where the gap is below (1 - slack/10) times the limit.
/// Near a known contact, adds one only if the gap is smaller than at that contact and below (1 - slack) times its required gap, because the contact
/// force dents a soft drop. Returns false if a gap is below ContactOptions::reach times the limit.
bool Limiter::find(const Net& x) {
  for (Held& one : held_) one.gap = approach(members_, x, one.contact).gap;
  for (Approach found : approaches(members_, x, limit_, ranks_, capsule_.cell())) {
    if (!(found.gap >= ContactOptions::reach * limit_)) return false;
    Held* const known = known_near(found.contact, x);
    if (known && known->response.size() == 0) {
      if (found.gap >= known->gap) continue;
      found.contact.force = known->contact.force;
      *known = held(found, known->target);
    } else if (found.gap < (known ? std::min(known->gap - slack / 10 * limit_, (1 - slack) * known->target) : (1 - slack / 10) * limit_)) {
      held_.push_back(held(found, target(found)));
    }
  }
  return true;
}

/// Returns the known contact of smallest gap that is between the same two particles and nearer to `contact` than half an element size; null if there
/// is none.
Limiter::Held* Limiter::known_near(const coupling::Contact& contact, const Net& x) {
  const Body& body = *members_[contact.particle[0]].body;
  const double element = body.radius * std::sqrt(4 * std::numbers::pi / static_cast<double>(body.space.elements.size()));
  const Vec3 here = place(members_, x, contact);
  Held* found = nullptr;
  for (Held& one : held_)
    if (of_same_pair(one.contact, contact) && (place(members_, x, one.contact) - here).norm() < element / 2 && (!found || one.gap < found->gap))
      found = &one;
  return found;
}

/// Returns the gap that a contact must restore. This is the smallest allowed gap `limit_`, unless the pair already has another contact and the gap is
/// below `limit_`. In this case, the required gap is between (1 - slack) limit_ and limit_, so that the gap opens gradually.
double Limiter::target(const Approach& found) const {
  const bool first = std::ranges::none_of(held_, [&](const Held& one) { return of_same_pair(one.contact, found.contact); });
  if (first || found.gap > limit_) return limit_;
  return std::max((1 - slack) * limit_, found.gap + std::min(1., rate_ * step_) * (limit_ - found.gap));
}

/// Returns the largest error of a gap at a contact, divided by the smallest allowed gap `limit_`. The error is the deviation from the required gap
/// (see `target`). At a contact without force, only a smaller gap counts as an error.
double Limiter::error() const {
  double most = 0;
  for (const Held& one : held_) most = std::max(most, (one.force > 0 ? std::abs(one.gap - one.target) : one.target - one.gap) / limit_);
  return most;
}

/// Computes the displacement that a unit contact force causes in the step, for each contact whose displacement is not known yet. Returns false if the
/// evaluation fails.
bool Limiter::respond(const Net& start, bool stiff) {
  for (Held& one : held_) {
    if (one.response.size() > 0) continue;
    if (!base_) {
      capsule_.set_forces(&coupling::Capsule::Forces::contacts, load_);
      base_ = capsule_.evaluate(start);
      if (stiff && base_->velocity().allFinite()) capsule_.linearise(start);
    }
    one.work = Net::Zero(start.rows(), 3);
    coupling::add_work(capsule_.particles(), one.contact, unit_, one.work);
    const Net rate = capsule_.response(*base_, one.work);
    if (!rate.allFinite()) return false;
    one.response = step_ * rate;
    if (stiff) {
      const coupling::State response = shapes_.solve(step_, shapes_.state_of(rate), 1e-6, {});
      one.response = step_ * shapes_.shape(response);
    }
  }
  return true;
}

/// Computes the contact forces from the complementarity problem (4.23). Returns the shape `start` displaced by the changes of these forces.
Net Limiter::moved(const Net& start) {
  const auto n = static_cast<Eigen::Index>(held_.size());
  Eigen::MatrixXd a(n, n);
  Eigen::VectorXd gaps(n), forces(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Held& one = held_[static_cast<std::size_t>(k)];
    gaps[k] = one.gap - one.target, forces[k] = one.force;
    for (Eigen::Index j = 0; j < n; ++j) a(k, j) = one.work.cwiseProduct(held_[static_cast<std::size_t>(j)].response).sum() / unit_;
  }
  forces = coupling::complementary(a, gaps - a * forces);
  Net x = start;
  for (Eigen::Index k = 0; k < n; ++k) {
    Held& one = held_[static_cast<std::size_t>(k)];
    one.force = forces[k];
    x += (one.force - one.before) * one.response;
  }
  if (x.allFinite()) capsule_.restore_constraints(x);
  return x;
}

/// Returns the contacts with a positive force, at their nearest points in the shape x.
coupling::Contacts Limiter::with_forces(const Net& x, double impulse) const {
  coupling::Contacts contacts{{}, impulse};
  for (const Held& one : held_) {
    if (!(one.force > 0)) continue;
    contacts.all.push_back(approach(members_, x, one.contact).contact);
    contacts.all.back().force = one.force * unit_;
  }
  contacts.impulse += step_ * contacts.force();
  return contacts;
}

}  // namespace tanktread
