#pragma once
// Who computes which rows, and how every rank gets all of them.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/kernels.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::coupling {

/// MPI, where a launcher started this process, and what Trilinos needs beside it, for as long as it lives: the first object of main.
class Session {
 public:
  /// Takes the arguments `--kokkos-...` away.
  Session(int* argc, char*** argv);
  ~Session();
  int rank() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The ranks of the run. Control nets are replicated; work is split by their rows. A rank fills the rows of its own control points, which
/// `replicate` gives to all by a Tpetra import. Far sums by clusters alone are added up (`share` of the layers), and depend on the ranks by rounding.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  int rank() const;
  int size() const;

  /// Counts the time of all that waits for others, the waiting included, to the phase `exchange` from now on; `phases` outlives this.
  void measure(Phases& phases);

  /// States the rows that this rank fills, of nets with n rows; each row has one owner. Collective.
  void own(const std::vector<int>& rows, int n);

  /// The same where only the rows of fundamental control points have owners, and the others are their images.
  void own(const std::vector<int>& rows, surface::Symmetry symmetry);

  /// Divides the control points of a space among the ranks: returns the points whose rows this rank fills. Collective.
  std::vector<int> divide_points(const spline::Space& space, const surface::Symmetry& symmetry);
  std::vector<int> divide_in_order(const surface::Symmetry& symmetry);  ///< the fundamental points in equal parts, whatever their neighbours

  /// Fills in the rows of other ranks and those of images. Collective.
  void replicate(Net& net) const;

  /// Returns a net of n rows on every rank. `fill` sets the rows of own points in a net of zeros. Collective.
  template <class Fill>
  Net filled(Eigen::Index n, const Fill& fill) const {
    Net net = Net::Zero(n, 3);
    fill(net);
    replicate(net);
    return net;
  }

  /// Returns a matrix of that size that all ranks assemble together: the sum of what each adds to a matrix of zeros. Collective.
  template <class Matrix, class Assemble>
  Matrix assembled(Eigen::Index rows, Eigen::Index columns, const Assemble& assemble) const {
    Matrix matrix = Matrix::Zero(rows, columns);
    assemble(matrix);
    add(std::span<double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
    return matrix;
  }

  /// Returns n rows of numbers on every rank. `evaluate(own, rows)` sets the rows of items that are this rank's share in a matrix of zeros.
  /// Collective.
  template <class Matrix, class Evaluate>
  Matrix divided(int n, Eigen::Index width, const Evaluate& evaluate) const {
    return assembled<Matrix>(n, width, [&](Matrix& rows) { evaluate(share(n), rows); });
  }

  /// Returns the numbers of each rank, in their order. Collective.
  template <std::size_t n>
  std::vector<std::array<double, n>> gathered(const std::array<double, n>& mine) const {
    std::vector<std::array<double, n>> all(static_cast<std::size_t>(size()), std::array<double, n>{});
    all[static_cast<std::size_t>(rank())] = mine;
    add(std::span<double>(all.front().data(), n * all.size()));
    return all;
  }

  /// Returns the sums over all ranks of their parts of several arrays of numbers. Collective.
  template <std::size_t n>
  std::array<std::vector<double>, n> of_all(std::array<std::vector<double>, n> parts) const {
    std::vector<std::span<double>> all(parts.begin(), parts.end());
    add_all(all);
    return parts;
  }

  /// Returns the kernel evaluations of all ranks together. Collective.
  stokes::Evaluations of_all(const stokes::Evaluations& own) const;

  /// The rank that is to do item k of n equal ones that come in a row.
  int owner(int k, int n) const { return k * size() / n; }

  /// Adds up the nets of all ranks, whose rows of fundamental points count. Sums of one number and zeros are exact. Collective.
  void add(std::span<Net* const> nets) const;

  /// Adds up the numbers of all ranks, in place. Sums of one number and zeros are exact. Collective.
  void add(std::span<double> numbers) const;

  /// Which of n items that come in a row this rank is to do; see owner. Ascending.
  std::vector<int> share(int n) const;

  /// Whether any rank says so (a signal, a limit). Collective.
  bool any(bool mine) const;

  /// Rank 0's value, on every rank (places in a file). Collective.
  double first(double mine) const;
  void first(std::span<std::int64_t> numbers) const;

  /// Returns the seconds since `start` by the clock of rank 0. Collective.
  double seconds_since(std::chrono::steady_clock::time_point start) const {
    return first(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  void add_all(std::span<const std::span<double>> several) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
