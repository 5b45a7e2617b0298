#include "system/solids/plates/plate_factors.hpp"

#include <complex>
#include <numbers>

#include <Eigen/LU>

namespace tanktread::coupling {

namespace {

using Complex = Eigen::MatrixXcd;

/// Returns the Fourier matrix with the entries exp(-2 pi i k s/n) in row k and column s; shape (n, n).
Complex waves(int n) {
  Complex all(n, n);
  for (int k = 0; k < n; ++k)
    for (int s = 0; s < n; ++s) all(k, s) = std::polar(1., -2 * std::numbers::pi * (k * s % n) / n);
  return all;
}

}  // namespace

PlateFactors::PlateFactors(const Eigen::MatrixXd& rows, const std::array<int, 2>& grid, const std::array<int, 2>& point,
                           const Eigen::MatrixXd& regular)
    : grid_(grid), plates_(static_cast<int>(rows.rows() / 3)), waves_{waves(grid[0]), waves(grid[1])} {
  const auto [n1, n2] = grid;
  const int size = 3 * plates_;
  inverse_.assign(static_cast<std::size_t>(n1 * n2), Complex::Zero(size, size));
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c) {
      Complex g(n1, n2);  // entry (r, c) of the blocks g(d) (2.50), for each difference d of grid indices
      for (int i = 0; i < n1; ++i)
        for (int j = 0; j < n2; ++j)
          g((i - point[0] + n1) % n1, (j - point[1] + n2) % n2) = rows(r, 3 * ((c / 3) * n1 * n2 + i * n2 + j) + c % 3);
      const Complex m = waves_[0].conjugate() * g * waves_[1].conjugate();
      for (int i = 0; i < n1; ++i)
        for (int j = 0; j < n2; ++j) inverse_[static_cast<std::size_t>(i * n2 + j)](r, c) = m(i, j);
    }
  uniform_ = inverse_.front().real() + regular;
  inverse_.front().setZero();
  for (std::size_t k = 1; k < inverse_.size(); ++k) inverse_[k] = inverse_[k].inverse().eval();
}

/// Returns the discrete Fourier transform of a net on the plates, shape (3 plates, n1 n2).
Eigen::MatrixXcd PlateFactors::transformed(const Net& u) const {
  const auto [n1, n2] = grid_;
  Complex all(3 * plates_, n1 * n2);
  for (int r = 0; r < 3 * plates_; ++r) {
    const Complex field = u.col(r % 3).segment((r / 3) * n1 * n2, n1 * n2).reshaped<Eigen::RowMajor>(n1, n2).cast<std::complex<double>>();
    const Complex waves = waves_[0] * field * waves_[1];
    all.row(r) = waves.reshaped<Eigen::RowMajor>().transpose();
  }
  return all;
}

Net PlateFactors::solve(const Net& u, Net& uniform) const {
  const auto [n1, n2] = grid_;
  Complex all = transformed(u);
  uniform.resize(plates_, 3);
  for (int r = 0; r < 3 * plates_; ++r) uniform(r / 3, r % 3) = all(r, 0).real() / (n1 * n2);
  for (int k = 0; k < n1 * n2; ++k) all.col(k) = (inverse_[static_cast<std::size_t>(k)] * all.col(k)).eval();
  Net f(u.rows(), 3);
  for (int r = 0; r < 3 * plates_; ++r) {
    const Eigen::VectorXcd row = all.row(r);  // contiguous, because Eigen 3.4 reshapes a row of a matrix incorrectly
    const Complex field = row.reshaped<Eigen::RowMajor>(n1, n2);
    const Complex values = waves_[0].conjugate() * field * waves_[1].conjugate() / (n1 * n2);
    f.col(r % 3).segment((r / 3) * n1 * n2, n1 * n2) = values.reshaped<Eigen::RowMajor>().real();
  }
  return f;
}

}  // namespace tanktread::coupling
