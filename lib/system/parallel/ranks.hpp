#pragma once
// Distribution of rows among the MPI ranks, and exchange of the results.

#include <array>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/kernels.hpp"
#include "surface/symmetry.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread::coupling {

/// Session of MPI and Kokkos, which ends with this object. Starts MPI only if an MPI launcher started this process. Must be the first object of main.
class Session {
 public:
  /// Starts the session. Removes the arguments `--kokkos-...` from the command line.
  Session(int* argc, char*** argv);
  ~Session();
  int rank() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the number of cores of this node on which its ranks may run, divided by the number of these ranks; at least 1. Collective.
int cores_per_rank();

/// Returns a warning if more ranks than there are cores share the cores of a node; otherwise an empty text. A rank may run on the cores of its CPU
/// affinity mask, which cpusets and the binding by the launcher limit. Ranks share the cores of a mask if their masks are subsets of it. Collective.
std::string crowding();

/// The ranks of the run. Control nets are replicated, and the work is divided by their rows. A rank computes the rows of its rank-owned control
/// points, and `replicate` distributes them to all ranks. Only treecode sums (TreeSum) are divided in another way: every rank
/// computes some terms of each row, and the results are summed over the ranks (see Layer::share). Treecode sums on different numbers of ranks
/// therefore differ by round-off.
///
/// Which call to use: filled() for a net whose rows this rank owns; divided() for rows of other matrices, divided evenly among the ranks;
/// assembled() for sums to which every rank adds; add() for sums in place; of_all() and gathered() for a few numbers. Calls that set the rows of
/// symmetry images treat a net as a field of polar vectors: scalars and axial vectors need divided().
///
/// An object divides the rows of one set of points. RowShare has one for the control points, and the walls of ducts, plates and posts, single rigid
/// bodies and the run have others. A class that needs one with the same points receives it.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  int rank() const;
  int size() const;

  /// Records the time of all later exchanges, including the time spent waiting for other ranks, in the phase `exchange` of `phases`, which must
  /// outlive this object.
  void measure(Phases& phases);

  /// Sets the rows that this rank computes, if only the rows of fundamental control points have owners and the other rows are their symmetry images.
  /// Collective.
  void set_owned_rows(const std::vector<int>& rows, surface::Symmetry symmetry);

  /// Divides the control points of a space among the ranks, and returns the points whose rows this rank computes. Collective.
  std::vector<int> divide_points(const spline::Space& space, const surface::Symmetry& symmetry);
  std::vector<int> divide_in_order(const surface::Symmetry& symmetry);  ///< divides fundamental points in their order; returns the part of this rank

  /// Copies the rows that other ranks own from these ranks, and sets the rows of symmetry images. set_owned_rows(), divide_points() or
  /// divide_in_order() must have been called. Collective.
  void replicate(Net& net) const;

  /// Returns a net of n rows on every rank. `fill` sets the rank-owned rows in a net of zeros, see replicate(). Collective.
  template <class Fill>
  Net filled(Eigen::Index n, const Fill& fill) const {
    Net net = Net::Zero(n, 3);
    fill(net);
    replicate(net);
    return net;
  }

  /// Returns, on every rank, a matrix of this size that is the sum of the contributions of all ranks. `assemble` adds the contribution of this rank
  /// to a matrix of zeros. Collective.
  template <class Matrix, class Assemble>
  Matrix assembled(Eigen::Index rows, Eigen::Index columns, const Assemble& assemble) const {
    Matrix matrix = Matrix::Zero(rows, columns);
    assemble(matrix);
    add(std::span<double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
    return matrix;
  }

  /// Returns a matrix of n rows on every rank. `evaluate(items, rows)` sets the rows with the indices `items`, the share of this rank, in the matrix
  /// `rows` of zeros. Collective.
  template <class Matrix, class Evaluate>
  Matrix divided(int n, Eigen::Index width, const Evaluate& evaluate) const {
    return assembled<Matrix>(n, width, [&](Matrix& rows) { evaluate(share(n), rows); });
  }

  /// Returns the values of all ranks, in the order of the ranks. Collective.
  template <std::size_t n>
  std::vector<std::array<double, n>> gathered(const std::array<double, n>& mine) const {
    std::vector<std::array<double, n>> all(static_cast<std::size_t>(size()), std::array<double, n>{});
    all[static_cast<std::size_t>(rank())] = mine;
    add(std::span<double>(all.front().data(), n * all.size()));
    return all;
  }

  /// Returns the sums of several arrays over all ranks. Collective.
  template <std::size_t n>
  std::array<std::vector<double>, n> of_all(std::array<std::vector<double>, n> parts) const {
    std::vector<std::span<double>> all(parts.begin(), parts.end());
    add_all(all);
    return parts;
  }

  /// Returns the number of kernel evaluations of all ranks together. Collective.
  stokes::Evaluations of_all(const stokes::Evaluations& own) const;

  /// Returns the rank that processes item k of n consecutive items of equal cost.
  int owner(int k, int n) const { return k * size() / n; }

  /// Sums nets over all ranks in place. Only rows of fundamental points are summed; the rows of their images are set from them. If all ranks but one
  /// add zero, the result is exact. Collective.
  void add(std::span<Net* const> nets) const;

  /// Sums values over all ranks in place. If all ranks but one add zero, the result is exact. Collective.
  void add(std::span<double> numbers) const;

  /// Returns, in ascending order, the items k among 0 .. n - 1 that this rank processes, for which owner(k, n) is this rank.
  std::vector<int> share(int n) const;

  /// Returns the seconds since `start` by the clock of rank 0. Collective.
  double seconds_since(std::chrono::steady_clock::time_point start) const {
    return of_first(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  void add_all(std::span<const std::span<double>> several) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
