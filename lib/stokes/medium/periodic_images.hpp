#pragma once
// A lattice of points after which everything repeats, and what its far images do.

#include <array>
#include <vector>

#include "base/types.hpp"

namespace tanktread::stokes {

/// n = 1, 2 or 3 vectors after which everything repeats, the shortest of their lattice, and unit vectors across for the other directions.
class PeriodicCell {
 public:
  /// The first n columns of `vectors` are the lattice's, linearly independent. `reference`: of one period the distance across at which the axial
  /// velocity of a row of unit forces changes its sign (2.43), which fixes the constant of the Stokeslet; 0: the constant is left open.
  PeriodicCell(const Mat3& vectors, int n, double reference = 0);

  int n() const { return n_; }
  const Mat3& vectors() const { return vectors_; }  ///< columns
  double volume() const { return volume_; }         ///< area of two, length of one
  double reference() const { return reference_; }

  /// Lattice coordinates of a place: of directions across lengths.
  Vec3 coordinates(const Vec3& x) const { return inverse_ * x; }

  /// The lattice vector to take from x so that it is in the cell around the origin.
  Vec3 shift(const Vec3& x) const;

  /// Distance between neighbouring planes of the lattice that hold all vectors but number d; of n vectors.
  double spacing(int d) const { return 1 / inverse_.row(d).norm(); }

  /// The lattice vectors with up to `most[d]` steps along vector d, either way.
  std::vector<Vec3> around(const std::array<int, 3>& most) const;

  bool operator==(const PeriodicCell& other) const {
    return n_ == other.n_ && vectors_ == other.vectors_ && reference_ == other.reference_;
  }

 private:
  Mat3 vectors_, inverse_;
  int n_;
  double volume_ = 0, reference_;
};

/// What images of the Stokeslet G or the stresslet T do that are not near: the sum over the lattice, less those of `near`, at places r = x - x0 in a
/// box. Of three periods the mean over the cell is zero (Hasimoto 1959; a uniform pressure gradient balances the force), in Ewald's form with
/// Hasimoto's splitting (Lindbo & Tornberg 2010; Beenakker's for G - A):
///
///   G^P(r) = sum_n A(xi, r + Hn) + (8 pi/V) sum_{k != 0} (1 + k^2/4 xi^2) e^{-k^2/4 xi^2} (k^2 I - k k)/k^4 cos k.r             (2.25)
///   A = I (erfc(xi r)/r - g) + r r (erfc(xi r)/r^3 + g/r^2),   g = (2 xi/sqrt(pi)) e^{-xi^2 r^2}
///   T_ijk = -delta_jk p_i + dG_ij/dx_k + dG_ik/dx_j,   p the pressure of G                                                      (2.26)
///
/// xi is so small that all A beyond those near vanish. Two periods are three, of which the third is so long that nothing but the mode k = 0 reaches
/// across it, which is taken back: with z across and the area S, length L3,
///
///   G = G^P - (4 pi/(S L3)) z^2 (I - e e),   p_i = p^P_i + (8 pi/(S L3)) z e_i                                                  (2.27)
///
/// One period h e is a sum to its end, by Euler and Maclaurin's formula. Of one and two periods G is known up to a constant; that of one period is
/// fixed by the reference distance l of the cell, so that far from the row with rho the distance across
///
///   G^P = sum_n G(r + n h e) - sum_{n != 0} (I + e e)/|n h| + (2/h) (ln(l/2h) + gamma + 1/2) (I + e e),
///   e.G^P e -> -(4/h) ln(rho/l)                                                                                           (2.43)
class PeriodicKernel {
 public:
  enum class Kind { stokeslet, stresslet };

  /// Places are box s, |s_d| <= 1. `box`: columns, the vectors of the cell and for directions across multiples of its. `tolerance`: of the sum, times
  /// a length of the cell, or its square.
  PeriodicKernel(Kind kind, const PeriodicCell& cell, const Mat3& box, const std::array<int, 3>& near, double tolerance);

  /// Stokeslet: 11, 12, 13, 22, 23, 33. Stresslet: T_ijk, jk in the order 11, 22, 33, 2 x 12, 2 x 13, 2 x 23, number 6 i + jk.
  int components() const { return kind_ == Kind::stokeslet ? 6 : 18; }

  /// values[((n_0 n_1 n_2) c + (n_1 n_2) k_0 + n_2 k_1 + k_2] at the places s = (s[0][k_0], s[1][k_1], s[2][k_2]).
  std::vector<double> values(const std::array<std::vector<double>, 3>& s) const;

 private:
  std::vector<double> waves(const std::array<std::vector<double>, 3>& s) const;
  void add_smooth_images(const Vec3& r, double* values) const;  // A - G of those near
  void add_mode_across(const Vec3& r, double* values) const;
  void add_row(const Vec3& r, double* values) const;
  void add_constant(double* values) const;
  void add_free(const Vec3& r, double factor, double* values) const;

  Kind kind_;
  PeriodicCell cell_;
  Mat3 box_, periods_;  // columns
  std::array<int, 3> near_;
  std::vector<Vec3> images_;
  double xi_ = 0, longest_wave_number_ = 0;
};

}  // namespace tanktread::stokes
