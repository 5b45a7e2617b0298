#pragma once
// Who computes which rows, and how every rank gets all of them.

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
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

  /// Fills in the rows of other ranks and those of images. Collective.
  void replicate(Net& net) const;

  /// The rank that is to do item k of n equal ones that come in a row.
  int owner(int k, int n) const { return k * size() / n; }

  /// Adds up the nets of all ranks, whose rows of fundamental points count. Sums of one number and zeros are exact. Collective.
  void add(std::span<Net* const> nets) const;

  /// Adds up the numbers of all ranks, in place. Sums of one number and zeros are exact. Collective.
  void add(std::span<double> numbers) const;
  void add_all(std::initializer_list<std::span<double>> several) const;

  /// Which of n items that come in a row this rank is to do; see owner. Ascending.
  std::vector<int> share(int n) const;

  /// Whether any rank says so (a signal, a limit). Collective.
  bool any(bool mine) const;

  /// Rank 0's value, on every rank (a clock, places in a file). Collective.
  double first(double mine) const;
  void first(std::span<std::int64_t> numbers) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
