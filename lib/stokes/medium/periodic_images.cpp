#include "stokes/medium/periodic_images.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {

namespace {

using std::numbers::pi;

double delta(int i, int j) { return i == j ? 1 : 0; }

/// Reduces a lattice basis: adds multiples of the other lattice vectors to each lattice vector as long as it becomes shorter.
void reduce(Mat3& vectors, int n) {
  for (bool changed = true; changed;) {
    changed = false;
    for (int d = 0; d < n; ++d) {
      Vec3 best = vectors.col(d);
      for (int a = n > 1 ? -1 : 0; a <= (n > 1 ? 1 : 0); ++a)
        for (int b = n > 2 ? -1 : 0; b <= (n > 2 ? 1 : 0); ++b) {
          const Vec3 other = vectors.col(d) + a * vectors.col((d + 1) % n) + (n > 2 ? Vec3(b * vectors.col((d + 2) % n)) : Vec3::Zero());
          if (other.squaredNorm() < best.squaredNorm() * (1 - 1e-12)) best = other;
        }
      changed = changed || best != vectors.col(d);
      vectors.col(d) = best;
    }
  }
}

/// Coefficients of the smooth parts of the kernels in Ewald's sum at the distance r, with A, g and xi of (2.25). Stokeslet: G - A = a I + b r r.
/// Stresslet: the smooth part of T_ijk is -2 xi^2 g (r_k I_ij + r_j I_ik) + 2 slope r_i r_j r_k.
struct Smooth {
  double a, b, g, slope;

  Smooth(double xi, double r) {
    const double x = xi * r, square = x * x;
    g = 2 * xi / std::sqrt(pi) * std::exp(-square);
    if (x < 0.7) {
      double phi = 0, first = 0, second = 0, power = 1;  // power: (-x^2)^m/m!
      for (int m = 0; m < 16; ++m) {
        phi += power / (2 * m + 1);
        first += power * 2 / (2 * m + 3);
        second -= power * 4 / (2 * m + 5);  // first = -phi'/x and second = first'/x. The derivative of the constant term of a series is 0, so that
                                            // term m + 1 is differentiated here; its factor (m + 1)/(m + 1)! is 1/m!
        power *= -square / (m + 1);
      }
      const double scale = 2 * xi / std::sqrt(pi);
      a = scale * phi + g;
      b = scale * xi * xi * first;
      slope = scale * std::pow(xi, 4) * second;
    } else {
      const double phi = std::erf(x) / r;
      a = phi + g;
      b = (phi - g) / (r * r);
      slope = (2 * xi * xi * g - 3 * b) / (r * r);
    }
  }
};

/// Multiplies an array by a matrix, shape (n, m), along the first index of the array, which has length m. Moves this index to the end.
template <class Number>
void contract(const Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>& by, std::vector<Number>& array) {
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index rest = static_cast<Eigen::Index>(array.size()) / by.cols();
  const Matrix result = by * Eigen::Map<const Matrix>(array.data(), rest, by.cols()).transpose();
  array.assign(result.data(), result.data() + result.size());
}

}  // namespace

PeriodicCell::PeriodicCell(const Mat3& vectors, int n, double reference) : vectors_(vectors), n_(n), reference_(reference) {
  reduce(vectors_, n);
  if (n == 1) vectors_.col(1) = vectors_.col(0).unitOrthogonal();
  if (n < 3) vectors_.col(2) = vectors_.col(0).cross(vectors_.col(1)).normalized();
  volume_ = std::abs(vectors_.determinant());
  inverse_ = vectors_.inverse();
}

std::array<Vec3, 2> PeriodicCell::range(const Net& x) const {
  std::array<Vec3, 2> extent{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (const auto row : x.rowwise()) {
    const Vec3 s = coordinates(row.transpose());
    extent[0] = extent[0].cwiseMin(s), extent[1] = extent[1].cwiseMax(s);
  }
  return extent;
}

Vec3 PeriodicCell::shift(const Vec3& x) const {
  Vec3 shift = Vec3::Zero();
  const Vec3 s = coordinates(x);
  for (int d = 0; d < n_; ++d) shift += std::floor(s[d] + 0.5) * vectors_.col(d);
  return shift;
}

std::vector<Vec3> PeriodicCell::around(const std::array<int, 3>& most) const {
  std::vector<Vec3> all;
  const auto steps = [&](std::size_t d) { return static_cast<int>(d) < n_ ? most[d] : 0; };
  for (int i = -steps(0); i <= steps(0); ++i)
    for (int j = -steps(1); j <= steps(1); ++j)
      for (int k = -steps(2); k <= steps(2); ++k) all.push_back(vectors_ * Vec3(i, j, k));
  return all;
}

PeriodicKernel::PeriodicKernel(Kind kind, const PeriodicCell& cell, const Mat3& box, const std::array<int, 3>& near, double tolerance)
    : kind_(kind), cell_(cell), box_(box), periods_(cell.vectors()), near_(near), images_(cell.around(near)) {
  if (cell.n() == 1) return;
  const double digits = std::log(100 / tolerance);
  double nearest = 1e300;
  for (int d = 0; d < cell.n(); ++d) nearest = std::min(nearest, near[static_cast<std::size_t>(d)] * cell.spacing(d));
  if (cell.n() == 2) {
    const double waves = digits * std::max(cell.vectors().col(0).norm(), cell.vectors().col(1).norm()) / (2 * pi);
    periods_.col(2) *= box.col(2).norm() + 1.3 * waves;  // sets the length of the third period. Modes with an in-plane wave number k != 0 decay with
                                                         // the distance z like |k| z e^{-|k| z} and do not reach across this length
  }
  xi_ = std::sqrt(digits) / nearest;
  longest_wave_number_ = 2 * xi_ * std::sqrt(digits);
}

/// Returns the sum over wave vectors k != 0 in (2.25), or the corresponding sum for the stresslet (2.26).
std::vector<double> PeriodicKernel::waves(const std::array<std::vector<double>, 3>& s) const {
  using Complex = std::complex<double>;
  using Matrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic>;
  const double volume = std::abs(periods_.determinant());
  const Mat3 reciprocal = 2 * pi * periods_.inverse().transpose();
  int most[3];
  for (int d = 0; d < 3; ++d) most[d] = static_cast<int>(std::ceil(longest_wave_number_ * periods_.col(d).norm() / (2 * pi)));
  std::vector<Complex> sums;
  for (int i = -most[0]; i <= most[0]; ++i)
    for (int j = -most[1]; j <= most[1]; ++j)
      for (int l = -most[2]; l <= most[2]; ++l) {
        const Vec3 k = reciprocal * Vec3(i, j, l);
        const double square = k.squaredNorm(), quarter = square / (4 * xi_ * xi_);
        const double e = square > 0 ? 8 * pi / volume * std::exp(-quarter) / square : 0, w = square > 0 ? (1 + quarter) * e / square : 0;
        if (kind_ == Kind::stokeslet) {
          for (const auto& [a, b] : upper) sums.emplace_back(w * (square * delta(a, b) - k[a] * k[b]));
          continue;
        }
        for (int a = 0; a < 3; ++a)
          for (const auto& [b, c] : stresses) {
            const double t = -delta(b, c) * k[a] * e - w * square * (k[c] * delta(a, b) + k[b] * delta(a, c)) + 2 * w * k[a] * k[b] * k[c];
            sums.emplace_back(0, b == c ? -t : -2 * t);
          }
      }
  for (int d = 0; d < 3; ++d) {
    const double scale = 2 * pi * box_.col(d).norm() / periods_.col(d).norm();
    const std::vector<double>& at = s[static_cast<std::size_t>(d)];
    Matrix phase(at.size(), 2 * most[d] + 1);
    for (int m = -most[d]; m <= most[d]; ++m)
      for (std::size_t i = 0; i < at.size(); ++i) phase(static_cast<Eigen::Index>(i), m + most[d]) = std::polar(1., m * scale * at[i]);
    contract(phase, sums);
  }
  std::vector<double> real;
  for (const Complex& sum : sums) real.push_back(sum.real());
  return real;
}

void PeriodicKernel::add_smooth_images(const Vec3& r0, double* values) const {
  for (const Vec3& image : images_) {
    const Vec3 r = r0 + image;
    const Smooth of(xi_, r.norm());
    if (kind_ == Kind::stokeslet) {
      for (int c = 0; c < 6; ++c) values[c] -= of.a * delta(upper[c][0], upper[c][1]) + of.b * r[upper[c][0]] * r[upper[c][1]];
      continue;
    }
    const double straight = -2 * xi_ * xi_ * of.g;
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 6; ++c) {
        const auto& [j, k] = stresses[c];
        const double t = straight * (r[k] * delta(a, j) + r[j] * delta(a, k)) + 2 * of.slope * r[a] * r[j] * r[k];
        values[6 * a + c] -= j == k ? t : 2 * t;
      }
  }
}

/// Applies the correction (2.27) for two periods to the Fourier mode with the in-plane wave vector k = 0.
void PeriodicKernel::add_mode_across(const Vec3& r, double* values) const {
  const Vec3 e = cell_.vectors().col(2);
  const double z = e.dot(r), scale = 4 * pi / std::abs(periods_.determinant());
  if (kind_ == Kind::stokeslet) {
    const double mode = scale * (z * z + periods_.col(2).squaredNorm() / 6);
    for (int c = 0; c < 6; ++c) values[c] -= mode * (delta(upper[c][0], upper[c][1]) - e[upper[c][0]] * e[upper[c][1]]);
    return;
  }
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 6; ++c) {
      const auto& [j, k] = stresses[c];
      const double t = delta(j, k) * e[i] + e[k] * (delta(i, j) - e[i] * e[j]) + e[j] * (delta(i, k) - e[i] * e[k]);
      values[6 * i + c] -= 2 * scale * z * (j == k ? t : 2 * t);
    }
}

void PeriodicKernel::add_free(const Vec3& r, double factor, double* values) const {
  const double over = 1 / r.norm();
  if (kind_ == Kind::stokeslet) {
    for (int c = 0; c < 6; ++c)
      values[c] += factor * over * (delta(upper[c][0], upper[c][1]) + over * over * r[upper[c][0]] * r[upper[c][1]]);
    return;
  }
  const double scale = -6 * factor * std::pow(over, 5);
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 6; ++c) values[6 * a + c] += (c < 3 ? 1 : 2) * scale * r[a] * r[stresses[c][0]] * r[stresses[c][1]];
}

/// Adds all images along the single lattice vector h, with the direction e, except the near images. Images are added in pairs at +n h and -n h, and
/// (I + e e)/|n h| is subtracted from each Stokeslet (2.43). The first `direct` pairs are summed directly. The sum over the other pairs is replaced
/// by an integral over the variable 1/n and the first term of the Euler-Maclaurin formula.
void PeriodicKernel::add_row(const Vec3& r, double* values) const {
  constexpr int direct = 60, nodes = 12;
  const Vec3 h = cell_.vectors().col(0), e = h.normalized();
  const auto add = [&](double n, double factor) {
    add_free(r + n * h, factor, values);
    add_free(r - n * h, factor, values);
    if (kind_ == Kind::stresslet) return;
    for (int c = 0; c < 6; ++c) values[c] -= 2 * factor / (n * h.norm()) * (delta(upper[c][0], upper[c][1]) + e[upper[c][0]] * e[upper[c][1]]);
  };
  const double end = near_[0] + direct + 0.5;
  for (int n = near_[0] + 1; n < end; ++n) add(n, 1);
  const auto& rule = quadrature::gauss(nodes);
  for (int k = 0; k < nodes; ++k) {
    const double u = rule.nodes[static_cast<std::size_t>(k)] / end;
    add(1 / u, rule.weights[static_cast<std::size_t>(k)] / (end * u * u));
  }
  add(end + 1, 1 / 48.), add(end - 1, -1 / 48.);
}

/// Adds the constant term of (2.43) and subtracts (I + e e)/|n h| for each near image. h e is the period, and n h e the position of the image.
void PeriodicKernel::add_constant(double* values) const {
  if (kind_ == Kind::stresslet || cell_.reference() == 0) return;
  const double h = cell_.vectors().col(0).norm();
  const Vec3 e = cell_.vectors().col(0) / h;
  double factor = 2 / h * (std::log(cell_.reference() / (2 * h)) + std::numbers::egamma + 0.5);
  for (int n = 1; n <= near_[0]; ++n) factor -= 2 / (n * h);
  for (int c = 0; c < 6; ++c) values[c] += factor * (delta(upper[c][0], upper[c][1]) + e[upper[c][0]] * e[upper[c][1]]);
}

std::vector<double> PeriodicKernel::values(const std::array<std::vector<double>, 3>& s) const {
  const std::size_t n = s[0].size() * s[1].size() * s[2].size();
  std::vector<double> all = cell_.n() == 1 ? std::vector<double>(n * static_cast<std::size_t>(components()), 0.) : waves(s);
  double own[18];
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t plane = s[1].size() * s[2].size();
    const Vec3 r = box_ * Vec3(s[0][k / plane], s[1][k / s[2].size() % s[1].size()], s[2][k % s[2].size()]);
    std::fill_n(own, 18, 0.);
    if (cell_.n() == 1) add_row(r, own), add_constant(own);
    if (cell_.n() > 1) add_smooth_images(r, own);
    if (cell_.n() == 2) add_mode_across(r, own);
    for (std::size_t c = 0; c < static_cast<std::size_t>(components()); ++c) all[n * c + k] += own[c];
  }
  return all;
}

}  // namespace tanktread::stokes
