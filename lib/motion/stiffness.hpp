#pragma once

#include "coupling/dynamics.hpp"

namespace tanktread::motion {

/// The stiffness rho of the system at x, where the velocity is v: the spectral radius of J by power iteration (4.7). It approaches rho from
/// below: from a random direction eight iterations find 0.9 of it or more, two from the direction of an earlier call as much.
/// `direction` is where the iteration starts and ends, of norm 1; of another size than x: it starts at random, the same on every run.
/// An iteration costs one product with the frozen operator, or one velocity evaluation where nothing is assembled.
double stiffness(coupling::Dynamics& dynamics, const Net& x, const Net& v, Net& direction, int iterations);

}  // namespace tanktread::motion
