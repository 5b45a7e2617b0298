#pragma once
// The heap of the process.

namespace tanktread {

/// Says how the heap is to grow, once, first thing in main: in large steps, whose first lies in huge pages where the system has them, with arrays up
/// to 32 MB on it, and nothing given back before the end. Fewer pages to be asked for one by one: a tenth of a small run. Does nothing where
/// malloc is not glibc's.
void settle_heap();

}  // namespace tanktread
