#include "motion/guarded.hpp"

#include <new>

#include "base/errors.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::motion {

namespace {

// outcomes of a call on one rank, from best to worst; the worst outcome of all ranks is the common outcome
enum Outcome { fine, failed, exhausted };

}  // namespace

/// Calls `act` and returns whether it succeeded on all ranks. `act` returns true if its result is finite.
bool GuardedDynamics::done(const std::function<bool()>& act) {
  int mine = fine;
  std::string reason;
  try {
    if (!act()) mine = failed, reason = motion_.why_undefined();
  } catch (const std::bad_alloc&) {
    mine = exhausted, reason = "there is not enough memory";
  } catch (const std::exception& error) {
    mine = failed, reason = error.what();
  }
  const auto [worst, why] = coupling::worst_of_all(mine, reason);
  if (worst >= failed) failure_ = why;
  if (worst == exhausted) throw RunFailure(failure_);
  return worst == fine;
}

Net GuardedDynamics::tried(const Net& like, const std::function<Net()>& evaluate) {
  Net result;
  const bool had = coupling::finite(like) && done([&] { return (result = evaluate()).allFinite(); });
  return had ? result : coupling::not_a_number(like);
}

Net GuardedDynamics::velocity(const Net& x) {
  coupling::stop_together();
  return tried(x, [&] { return motion_.velocity(x); });
}

void GuardedDynamics::freeze(const Net& x) {
  const auto freeze = [&] {
    motion_.freeze(x);
    return true;
  };
  if (!done(freeze)) throw RunFailure("the Jacobian's operators cannot be assembled: " + failure_);
}

void GuardedDynamics::linearise(const Net& x) {
  linearised_ = done([&] {
    motion_.linearise(x);
    return true;
  });
}

Net GuardedDynamics::solve(double shift, const Net& r, double tolerance, const coupling::Secants& secants) {
  if (!linearised_) return coupling::not_a_number(r);
  return tried(r, [&] { return motion_.solve(shift, r, tolerance, secants); });
}

Net GuardedDynamics::defect(const Net& x, const Net& u) {
  coupling::stop_together();
  return tried(x, [&] { return motion_.defect(x, u); });
}

Net GuardedDynamics::correction(double shift, const Net& defect, double tolerance, const coupling::Secants& secants) {
  if (!linearised_) return coupling::not_a_number(defect);
  return tried(defect, [&] { return motion_.correction(shift, defect, tolerance, secants); });
}

Net GuardedDynamics::jacobian_error(const Net& change, const Net& delta, double shift) {
  return tried(change, [&] { return motion_.jacobian_error(change, delta, shift); });
}

Net GuardedDynamics::derivative(const Net& x, const Net& v, const Net& delta) {
  return tried(delta, [&] { return motion_.derivative(x, v, delta); });
}

void GuardedDynamics::restore_constraints(Net& x) {
  x = tried(x, [&] {
    Net restored = x;
    motion_.restore_constraints(restored);
    return restored;
  });
}

void GuardedDynamics::improve_start(Net& y, const Net& before, double shift) {
  y = tried(y, [&] {
    Net improved = y;
    motion_.improve_start(improved, before, shift);
    return improved;
  });
}

double GuardedDynamics::distance(const Net& from, const Net& to) const {
  return coupling::decided([&] { return std::vector{motion_.distance(from, to)}; }).front();
}

double GuardedDynamics::norm(const Net& displacement) const {
  return coupling::decided([&] { return std::vector{motion_.norm(displacement)}; }).front();
}

}  // namespace tanktread::motion
