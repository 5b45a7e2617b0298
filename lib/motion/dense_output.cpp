#include "motion/dense_output.hpp"

namespace tanktread::motion {

DenseOutput::DenseOutput(const State& before, const State& after)
    : start_(before.time), step_(after.time - before.time), x0_(before.x), x1_(after.x), v0_(before.history.front()), v1_(after.history.front()) {}

Net DenseOutput::place(double time) const {
  const double s = (time - start_) / step_, r = 1 - s;
  return r * r * (1 + 2 * s) * x0_ + s * s * (1 + 2 * r) * x1_ + step_ * s * r * (r * v0_ - s * v1_);
}

Net DenseOutput::slope(double time) const {
  const double s = (time - start_) / step_, r = 1 - s;
  return 6 * s * r / step_ * (x1_ - x0_) + r * (r - 2 * s) * v0_ + s * (s - 2 * r) * v1_;
}

}  // namespace tanktread::motion
