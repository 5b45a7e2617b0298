#pragma once
// Storage for arrays of SIMD registers whose width is known only at run time, because the kernels are compiled for several instruction sets.

namespace tanktread {

/// Largest number of doubles in a register of any instruction set.
constexpr int most_lanes = 8;

/// Storage for one register of the largest width. An array of packs stores its registers without gaps. If the registers are narrower than a pack, the
/// end of the array is not used.
struct alignas(sizeof(double) * most_lanes) Pack {
  double lanes[most_lanes];
};

/// Returns the number of doubles in a register of the instruction set in use.
int pack_lanes();

/// Returns the components of an array of packs as doubles. Lane l of register k has the index k * pack_lanes() + l.
inline double* numbers(Pack* packs) { return reinterpret_cast<double*>(packs); }
inline const double* numbers(const Pack* packs) { return reinterpret_cast<const double*>(packs); }

}  // namespace tanktread
