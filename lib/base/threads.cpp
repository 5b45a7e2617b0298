#include "base/threads.hpp"

#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string_view>
#include <thread>

namespace tanktread {
namespace {

thread_local int number = 0;       // of this thread
thread_local bool in_loop = false;

/// Number of polls before a waiting thread sleeps: some microseconds. On a busy machine a thread that polls takes time from the other programs.
constexpr int polls = 300;

/// Waits until a variable differs from `value`.
template <class T>
void wait_while(const std::atomic<T>& variable, T value) {
  for (int k = 0; k < polls; ++k) {
    if (variable.load(std::memory_order_acquire) != value) return;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }
  variable.wait(value, std::memory_order_acquire);
}

/// Expected seconds below which a loop runs on the calling thread, because the others would not be awake before it ends. Measured with capsules of 98
/// to 3,458 control points.
constexpr double worth_threads = 1.5e-4;

/// Factor by which the expected seconds per item of a loop decrease per call, if they do not increase. Loops with items of different sizes thus use
/// several threads rather than one.
constexpr double kept = 0.95;

/// The threads of this process. Only threads that are awake take part in a loop: a loop does not wait for a thread that has not begun an item.
class Pool {
 public:
  explicit Pool(int threads) : failures_(static_cast<std::size_t>(threads)) {
    for (int k = 1; k < threads; ++k) workers_.emplace_back([this, k] { serve(k); });
  }
  ~Pool() {
    ends_ = true;
    wake();
    for (std::thread& worker : workers_) worker.join();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int size() const { return static_cast<int>(failures_.size()); }

  /// Runs the items first .. n - 1.
  void run(std::ptrdiff_t first, std::ptrdiff_t n, void (*body)(const void*, std::ptrdiff_t), const void* work) {
    n_ = n, body_ = body, work_ = work;
    next_ = first, first_failed_ = std::numeric_limits<std::ptrdiff_t>::max();
    inside_.fetch_add(shut, std::memory_order_release);  // opens the loop
    wake();
    take_items();
    inside_.fetch_sub(shut, std::memory_order_acq_rel);
    for (int still; (still = inside_.load(std::memory_order_acquire)) != -shut;) wait_while(inside_, still);
    rethrow();
  }

 private:
  static constexpr int shut = 1 << 20;  // more than there are threads

  void wake() {
    loops_.fetch_add(1, std::memory_order_release);
    loops_.notify_all();
  }

  void serve(int own_number) {
    number = own_number;
    for (std::uint32_t seen = 0;;) {
      wait_while(loops_, seen);
      seen = loops_.load(std::memory_order_acquire);
      if (ends_) return;
      if (inside_.fetch_add(1, std::memory_order_acquire) >= 0) take_items();
      inside_.fetch_sub(1, std::memory_order_release);
      inside_.notify_one();
    }
  }

  void take_items() {
    in_loop = true;
    for (std::ptrdiff_t i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < n_ && i < first_failed_;) try {
        body_(work_, i);
      } catch (...) {
        failures_[static_cast<std::size_t>(number)] = {i, std::current_exception()};
        for (std::ptrdiff_t first = first_failed_; i < first && !first_failed_.compare_exchange_weak(first, i);) continue;
        break;  // the items that this thread would take next have higher indices
      }
    in_loop = false;
  }

  /// Throws the exception of the lowest item, if there is one.
  void rethrow() {
    std::exception_ptr thrown;
    for (Failure& failure : failures_) {
      const Failure one = std::exchange(failure, {});
      if (one.exception && one.item == first_failed_) thrown = one.exception;
    }
    if (thrown) std::rethrow_exception(thrown);
  }

  struct Failure {
    std::ptrdiff_t item = 0;
    std::exception_ptr exception;
  };

  std::ptrdiff_t n_ = 0;
  void (*body_)(const void*, std::ptrdiff_t) = nullptr;
  const void* work_ = nullptr;
  std::vector<Failure> failures_;  // of each thread
  std::atomic<std::ptrdiff_t> next_ = 0, first_failed_ = 0;
  std::atomic<std::uint32_t> loops_ = 0;  // number of loops that have begun
  std::atomic<int> inside_ = -shut;       // number of the other threads in the loop; minus `shut` while there is none to enter
  std::atomic<bool> ends_ = false;
  std::vector<std::thread> workers_;
};

std::unique_ptr<Pool>& pool() {
  static std::unique_ptr<Pool> all;
  return all;
}

int threads = 1;

}  // namespace

void set_threads(int n) {
  threads = std::max(1, n);
  if (pool() && pool()->size() != threads) pool().reset();
}

int requested_threads(int otherwise) {
  const char* const variable = std::getenv("OMP_NUM_THREADS");
  const std::string_view text = variable ? variable : "";
  int wanted = 0;
  std::from_chars(text.data(), text.data() + text.size(), wanted);
  return wanted > 0 ? std::min(wanted, most_threads) : otherwise;
}

int n_threads() { return threads; }
int thread_number() { return number; }

void run_items(std::ptrdiff_t n, void (*body)(const void*, std::ptrdiff_t), const void* work, double& seconds) {
  const auto serial = [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    for (std::ptrdiff_t i = first; i < last; ++i) body(work, i);
  };
  if (in_loop) return serial(0, n);
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const std::ptrdiff_t first = seconds == 0 ? 1 : 0;  // the first item of the first call is measured
  serial(0, first);
  const double expected = static_cast<double>(n - first) * (first ? passed() : seconds);
  if (expected < worth_threads) {
    serial(first, n);
    seconds = std::max(kept * seconds, passed() / static_cast<double>(n));
    return;
  }
  if (!pool()) pool() = std::make_unique<Pool>(threads);
  pool()->run(first, n, body, work);
  seconds = std::max(kept * seconds, threads * passed() / static_cast<double>(n));
}

}  // namespace tanktread
