#pragma once
// Loops over independent items by the threads of this process. The results do not depend on the number of threads.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace tanktread {

constexpr int most_threads = 1024;

/// Sets the number of threads of all later loops, from 1 to most_threads. Without a call it is 1. Must be called outside loops, and before the
/// objects whose loops are to use more threads are constructed (see PerThread).
void set_threads(int n);

/// Returns the number of threads that the variable OMP_NUM_THREADS requests (the first of its numbers), or `otherwise` if it requests none.
int requested_threads(int otherwise);

int n_threads();      ///< number of threads of a loop
int thread_number();  ///< number of the calling thread: 0 for the thread that starts the loops, 1 .. n_threads() - 1 for the others in a loop

/// A loop with its body as plain pointers. Use each_item(). `seconds`: expected seconds per item, which are measured and updated at every call.
void run_items(std::ptrdiff_t n, void (*body)(const void* work, std::ptrdiff_t item), const void* work, double& seconds);

/// Calls work(i) for i = 0 .. n - 1, on all threads if the loop is expected to take longer than their start. The calls begin in ascending order.
/// They must not write to what another call reads or writes. If calls throw, rethrows the exception of the lowest i after the loop, as a loop on
/// one thread would; later calls may not be made. A loop inside a loop runs on the calling thread. Calls must not use MPI, Teuchos, Tpetra, HDF5 or
/// YAML. `any_thread`: false if only the calling thread may make the calls, for example of functions from outside the library that do not say
/// otherwise.
template <class Work>
void each_item(std::integral auto n, const Work& work, bool any_thread = true) {
  if (n_threads() == 1 || n <= 1 || !any_thread) {
    for (decltype(n) i = 0; i < n; ++i) work(i);
    return;
  }
  static double seconds = 0;  // per item of this loop of the code
  run_items(
      static_cast<std::ptrdiff_t>(n), [](const void* of, std::ptrdiff_t i) { (*static_cast<const Work*>(of))(static_cast<decltype(n)>(i)); }, &work,
      seconds);
}

/// Calls work(first, last) for the blocks of `size` successive indices, or fewer in the last block, into which 0 .. n - 1 are divided. For loops
/// whose single indices take less than a microsecond. A loop of one block runs on the calling thread.
template <class Work>
void each_block(std::integral auto n, std::type_identity_t<decltype(n)> size, const Work& work) {
  each_item((n + size - 1) / size, [&](auto block) { work(block * size, std::min(n, (block + 1) * size)); });
}

/// One object per thread, for example memory for intermediate results, or a counter of integers. Sums of floating-point numbers must not be added up
/// per thread, because the result would depend on the number of threads.
template <class T>
class PerThread {
 public:
  T& mine() { return all_.at(static_cast<std::size_t>(thread_number())).value; }  ///< returns the object of the calling thread

  /// Returns the sum of the objects of all threads. Must not be called in a loop.
  T sum() const {
    T total{};
    for (const Slot& slot : all_) total += slot.value;
    return total;
  }

 private:
  struct alignas(64) Slot {  // one cache line, so that threads do not write to the same one
    T value{};
  };
  std::vector<Slot> all_ = std::vector<Slot>(static_cast<std::size_t>(n_threads()));
};

}  // namespace tanktread
