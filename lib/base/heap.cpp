#include "base/heap.hpp"

#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace tanktread {

void settle_heap() {
#ifdef __GLIBC__
  constexpr int step = 256 << 20, largest_on_heap = 32 << 20;
  constexpr std::uintptr_t huge_page = 2 << 20;
  mallopt(M_MMAP_THRESHOLD, largest_on_heap);
  mallopt(M_TRIM_THRESHOLD, 2 * step);
  mallopt(M_TOP_PAD, step);
  const auto end = [] { return reinterpret_cast<std::uintptr_t>(sbrk(0)); };
  const std::uintptr_t before = end();
  void* volatile grown = std::malloc(huge_page);  // volatile: or it would be left out
  std::free(grown);
  const std::uintptr_t first = (before + huge_page - 1) / huge_page * huge_page;
  if (first < end()) madvise(reinterpret_cast<void*>(first), end() - first, MADV_HUGEPAGE);
#endif
}

}  // namespace tanktread
