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

State GuardedDynamics::tried(const State& like, const std::function<State()>& evaluate) {
  State result;
  const bool had = coupling::finite(like.numbers()) && done([&] { return (result = evaluate()).allFinite(); });
  return had ? result : coupling::not_a_number(like);
}

State GuardedDynamics::velocity(const State& x) {
  coupling::stop_together();
  return tried(x, [&] { return motion_.velocity(x); });
}

void GuardedDynamics::freeze(const State& x) {
  const auto freeze = [&] {
    motion_.freeze(x);
    return true;
  };
  if (!done(freeze)) throw RunFailure("the Jacobian's operators cannot be assembled: " + failure_);
}

void GuardedDynamics::linearise(const State& x) {
  linearised_ = done([&] {
    motion_.linearise(x);
    return true;
  });
}

State GuardedDynamics::solve(double shift, const State& r, double tolerance, const coupling::Secants& secants) {
  if (!linearised_) return coupling::not_a_number(r);
  return tried(r, [&] { return motion_.solve(shift, r, tolerance, secants); });
}

State GuardedDynamics::defect(const State& x, const State& u) {
  coupling::stop_together();
  return tried(x, [&] { return motion_.defect(x, u); });
}

State GuardedDynamics::correction(double shift, const State& defect, double tolerance, const coupling::Secants& secants) {
  if (!linearised_) return coupling::not_a_number(defect);
  return tried(defect, [&] { return motion_.correction(shift, defect, tolerance, secants); });
}

State GuardedDynamics::jacobian_error(const State& change, const State& delta, double shift) {
  return tried(change, [&] { return motion_.jacobian_error(change, delta, shift); });
}

State GuardedDynamics::derivative(const State& x, const State& v, const State& delta) {
  return tried(delta, [&] { return motion_.derivative(x, v, delta); });
}

void GuardedDynamics::restore_constraints(State& x) {
  x = tried(x, [&] {
    State restored = x;
    motion_.restore_constraints(restored);
    return restored;
  });
}

void GuardedDynamics::improve_start(State& y, const State& before, double shift) {
  y = tried(y, [&] {
    State improved = y;
    motion_.improve_start(improved, before, shift);
    return improved;
  });
}

double GuardedDynamics::distance(const State& from, const State& to) const {
  return coupling::decided([&] { return std::vector{motion_.distance(from, to)}; }).front();
}

double GuardedDynamics::norm(const State& displacement) const {
  return coupling::decided([&] { return std::vector{motion_.norm(displacement)}; }).front();
}

}  // namespace tanktread::motion
