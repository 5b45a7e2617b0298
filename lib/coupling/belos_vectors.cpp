#include "coupling/belos_vectors.hpp"

#include <ostream>

namespace tanktread::coupling {

Vectors::Vectors(Eigen::Index length, int columns)
    : Vectors(std::make_shared_for_overwrite<double[]>(static_cast<std::size_t>(length * columns)), length) {
  for (int c = 0; c < columns; ++c) columns_.push_back(memory_.get() + c * length);
}

Vectors Vectors::view(const std::vector<int>& some) const {
  Vectors result(memory_, length_);
  for (const int c : some) result.columns_.push_back(columns_[static_cast<std::size_t>(c)]);
  return result;
}

void Vectors::set(const Vectors& other) const {
  for (int c = 0; c < columns(); ++c) column(c) = other.column(c);
}

Vectors* Vectors::copy(const Vectors& other) {
  auto* result = new Vectors(other.length_, other.columns());
  result->set(other);
  return result;
}

void Vectors::MvTimesMatAddMv(double alpha, const Base& a, const Small& b, double beta) {
  for (int j = 0; j < columns(); ++j) {
    Column to = column(j);
    if (beta == 0) to.setZero();
    if (beta != 0 && beta != 1) to *= beta;
    for (int i = 0; i < a.GetNumberVecs(); ++i) to += alpha * b(i, j) * of(a).column(i);
  }
}

void Vectors::MvAddMv(double alpha, const Base& a, double beta, const Base& b) {
  for (int c = 0; c < columns(); ++c) column(c) = alpha * of(a).column(c) + beta * of(b).column(c);
}

void Vectors::MvScale(double alpha) {
  for (int c = 0; c < columns(); ++c) column(c) *= alpha;
}

void Vectors::MvScale(const std::vector<double>& alpha) {
  for (int c = 0; c < columns(); ++c) column(c) *= alpha[static_cast<std::size_t>(c)];
}

void Vectors::MvTransMv(double alpha, const Base& a, Small& b) const {
  for (int j = 0; j < columns(); ++j)
    for (int i = 0; i < a.GetNumberVecs(); ++i) b(i, j) = alpha * of(a).column(i).dot(column(j));
}

void Vectors::MvDot(const Base& a, std::vector<double>& b) const {
  for (int c = 0; c < columns(); ++c) b[static_cast<std::size_t>(c)] = column(c).dot(of(a).column(c));
}

void Vectors::MvNorm(std::vector<double>& norms, Belos::NormType type) const {
  for (int c = 0; c < columns(); ++c) {
    const Column v = column(c);
    norms[static_cast<std::size_t>(c)] = type == Belos::TwoNorm   ? v.norm()
                                         : type == Belos::OneNorm ? v.lpNorm<1>()
                                                                  : v.lpNorm<Eigen::Infinity>();
  }
}

void Vectors::MvRandom() {
  for (int c = 0; c < columns(); ++c) column(c).setRandom();
}

void Vectors::MvInit(double alpha) {
  for (int c = 0; c < columns(); ++c) column(c).setConstant(alpha);
}

void Vectors::MvPrint(std::ostream& out) const {
  for (int c = 0; c < columns(); ++c) out << column(c).transpose() << "\n";
}

}  // namespace tanktread::coupling
