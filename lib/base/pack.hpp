#pragma once
// Numbers that kernels work on together, as the rest of the program keeps them.

namespace tanktread {

/// The most doubles that fit a register.
constexpr int most_lanes = 8;

/// Room for one register's worth of numbers, however wide registers are. Registers lie one behind the other from the start of an array of packs:
/// where they are narrower than a pack, its end is idle.
struct alignas(sizeof(double) * most_lanes) Pack {
  double room[most_lanes];
};

/// Doubles in a register of the instructions in use.
int pack_lanes();

/// The numbers in an array of packs: lane l of register k is number pack_lanes() k + l.
inline double* numbers(Pack* packs) { return reinterpret_cast<double*>(packs); }
inline const double* numbers(const Pack* packs) { return reinterpret_cast<const double*>(packs); }

}  // namespace tanktread
