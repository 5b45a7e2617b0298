#pragma once
// Periodic lattices, and the kernel that sums all periodic images except the near ones.

#include <array>
#include <vector>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Periodic cell with n = 1, 2 or 3 lattice vectors, reduced to the shortest vectors of the lattice. The other directions have unit vectors normal to
/// the lattice vectors.
class PeriodicCell {
 public:
  /// `vectors`: the first n columns are linearly independent lattice vectors. `reference`: distance from a row of unit forces at which the axial
  /// velocity changes sign (2.43). It fixes the constant up to which the Stokeslet with one period is defined. If it is 0, the constant is arbitrary.
  PeriodicCell(const Mat3& vectors, int n, double reference = 0);

  int n() const { return n_; }
  const Mat3& vectors() const { return vectors_; }  ///< lattice vectors as columns
  double volume() const { return volume_; }         ///< volume of the cell; its area if there are n = 2 lattice vectors, its length if n = 1
  double reference() const { return reference_; }

  /// Returns the lattice coordinates of a position. Along directions that are not periodic, the coordinates are lengths.
  Vec3 coordinates(const Vec3& x) const { return inverse_ * x; }

  /// Returns the lowest and highest lattice coordinates of the rows of x.
  std::array<Vec3, 2> range(const Net& x) const;

  /// Returns the lattice vector that must be subtracted from x to move it into the cell around the origin.
  Vec3 shift(const Vec3& x) const;

  /// Returns the distance between neighbouring lattice planes that are parallel to all lattice vectors except vector d. d: index of one of the n
  /// lattice vectors.
  double spacing(int d) const { return 1 / inverse_.row(d).norm(); }

  /// Returns the lattice vectors with up to `most[d]` steps along vector d in both directions.
  std::vector<Vec3> around(const std::array<int, 3>& most) const;

  bool operator==(const PeriodicCell& other) const {
    return n_ == other.n_ && vectors_ == other.vectors_ && reference_ == other.reference_;
  }

 private:
  Mat3 vectors_, inverse_;
  int n_;
  double volume_ = 0, reference_;
};

/// Sum of the Stokeslet G or the stresslet T over all images of a lattice except the near ones, at positions r = x - x0 in a box. An image is near if
/// it is at most `near[d]` steps along each lattice vector d from the cell at the origin. The formulas below are for the sum over all images.
///
/// With three periods, the sum is an Ewald sum with Hasimoto's splitting of G into a short-range part A and a smooth part G - A (Lindbo & Tornberg
/// 2010). The mean over the cell is zero, and a uniform pressure gradient balances the force (Hasimoto 1959):
///
///   G^P(r) = sum_n A(xi, r + Hn) + (8 pi/V) sum_{k != 0} (1 + k^2/4 xi^2) e^{-k^2/4 xi^2} (k^2 I - k k)/k^4 cos k.r             (2.25)
///   A = I (erfc(xi r)/r - g) + r r (erfc(xi r)/r^3 + g/r^2),   g = (2 xi/sqrt(pi)) e^{-xi^2 r^2}
///   T_ijk = -delta_jk p_i + dG_ij/dx_k + dG_ik/dx_j,   p the pressure of G                                                      (2.26)
///
/// The columns of H are the lattice vectors, and n has integer components. xi is just large enough that A is negligible for all images that are not
/// near. A near image contributes A to the sum (2.25). If its G is subtracted, only A - G remains, which is smooth.
///
/// With two periods, the sum is computed with a third period. The third period is so long that only the mode with the in-plane wave vector k = 0
/// reaches across it. (2.27) replaces this mode by the mode without a third period, -(4 pi/S) |z| (I - e e). With the coordinate z along the unit
/// vector e normal to the two periods, the area S of the cell and the third period L3,
///
///   G = G^P - (4 pi/(S L3)) (z^2 + L3^2/6) (I - e e),   p_i = p^P_i + (8 pi/(S L3)) z e_i                                       (2.27)
///
/// With one period of length h along the unit vector e, the tail of the sum is computed by the Euler-Maclaurin formula. With one or two periods, G is
/// defined up to a constant. With two periods, (2.27) fixes the constant. With one period, the reference distance l of the cell fixes the constant:
/// far from the row of images, the axial velocity depends on the distance rho from the row like -ln(rho/l):
///
///   G^P = sum_n G(r + n h e) - sum_{n != 0} (I + e e)/|n h| + (2/h) (ln(l/2h) + gamma + 1/2) (I + e e),
///   e.G^P e -> -(4/h) ln(rho/l)                                                                                           (2.43)
class PeriodicKernel {
 public:
  enum class Kind { stokeslet, stresslet };

  /// Positions are r = box s with |s_d| <= 1. `box`: columns are the vectors of the cell, or multiples of them in directions that do not repeat.
  /// `tolerance`: error of the Stokeslet sum times the length of the cell, or error of the stresslet sum times the square of this length.
  PeriodicKernel(Kind kind, const PeriodicCell& cell, const Mat3& box, const std::array<int, 3>& near, double tolerance);

  /// Returns the number of components. Stokeslet: 11, 12, 13, 22, 23, 33. Stresslet: T_ijk at index 6 i + jk, where jk = 11, 22, 33, 12, 13, 23, and
  /// components with j != k are doubled.
  int components() const { return kind_ == Kind::stokeslet ? 6 : 18; }

  /// Returns the kernel sum at all positions (s[0][k_0], s[1][k_1], s[2][k_2]) of a grid. Component c is at index ((c n_0 + k_0) n_1 + k_1) n_2 +
  /// k_2, where n_d is the size of s[d].
  std::vector<double> values(const std::array<std::vector<double>, 3>& s) const;

 private:
  std::vector<double> waves(const std::array<std::vector<double>, 3>& s) const;
  void add_smooth_images(const Vec3& r, double* values) const;  // adds for each near image the smooth part of (2.25): kernel A of the lattice sum
                                                                // minus Stokeslet G; for the stresslet, the corresponding difference
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
