#include "app/domain.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"

namespace tanktread {

void DomainOptions::declare(deck::Section& section) {
  section.key("periodic", periodic, deck::Choice{"x1 x2 x3", "x1 x2", "x1 x3", "x2 x3", "x1", "x2", "x3"},
              "directions in which the scene repeats; of three the mean velocity over the cell, particles included, is that of the flow, and a net "
              "force is balanced by a uniform pressure gradient");
  section.key("side lengths", side_lengths, deck::any(), "length", "of a box along x1, x2, x3; of a direction that does not repeat it says nothing");
  section.key("lattice vectors", lattice_vectors, deck::any(), "length",
              "of any other cell at time zero: nine numbers, the vector of x1, that of x2, that of x3. The flow carries them along");
}

int DomainOptions::directions() const { return static_cast<int>(std::ranges::count(periodic, 'x')); }

/// Columns, those that repeat first.
Mat3 DomainOptions::vectors() const {
  Mat3 vectors = Mat3::Zero();
  int n = 0;
  for (int d = 0; d < 3; ++d) {
    if (periodic.find(static_cast<char>('1' + d)) == std::string::npos) continue;
    vectors.col(n++) = side_lengths ? Vec3((*side_lengths)[d] * Vec3::Unit(d)) : Vec3(lattice_vectors.value().row(d).transpose());
  }
  return vectors;
}

void DomainOptions::check(const stokes::FlowOptions& flow) const {
  if (side_lengths.has_value() == lattice_vectors.has_value())
    throw UserError(side_lengths ? "Domain/side lengths and Domain/lattice vectors contradict each other: give one of them."
                                 : "Domain needs Domain/side lengths or Domain/lattice vectors.");
  if (flow.type == "parabolic" || flow.type == "duct")
    throw UserError("Domain and Flow/type `" + flow.type + "` contradict each other: a lattice can follow no flow but one whose gradient is the same "
                    "everywhere.");
  if (flow.history) throw UserError("Domain and Flow/history contradict each other: a lattice can follow no flow but one that stays as it is.");
  const Mat3 all = vectors();
  const auto columns = all.leftCols(directions());
  double product = 1;
  for (int d = 0; d < directions(); ++d) {
    if (side_lengths && !(columns.col(d).sum() > 0)) throw UserError("Domain/side lengths must be positive in the directions of Domain/periodic.");
    product *= columns.col(d).squaredNorm();
  }
  const double volume = std::sqrt(std::max(0., (columns.transpose() * columns).determinant()));
  if (!(volume > 1e-6 * std::sqrt(product)))
    throw UserError(formatted("Domain/lattice vectors must span a cell, but those given have no volume: it is %.3g.", volume));
}

std::optional<stokes::PeriodicCell> DomainOptions::cell() const {
  if (!present) return {};
  return stokes::PeriodicCell(vectors(), directions());
}

}  // namespace tanktread
