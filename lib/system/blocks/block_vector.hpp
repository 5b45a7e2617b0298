#pragma once
// Vectors of the unknowns of all blocks of a layout.

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include "system/blocks/layout.hpp"

namespace tanktread::coupling {

/// Linear combination of vectors of blocks, evaluated when it is assigned to a BlockVector. Refers to the vectors, as expressions of Eigen do.
template <class Numbers>
struct Combination {
  const std::shared_ptr<const Layout>& layout;
  Numbers numbers;
};

/// The numbers of all blocks of a layout. Copies copy the numbers. An absent vector has no layout and no numbers. The numbers are stored in a Tpetra
/// vector on a locally replicated map (system/solvers/vectors.hpp): every rank holds all of them.
class BlockVector {
 public:
  using Rows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  using ConstRows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  using Numbers = Eigen::Map<Eigen::VectorXd>;
  using ConstNumbers = Eigen::Map<const Eigen::VectorXd>;

  BlockVector();                                             ///< an absent vector
  explicit BlockVector(std::shared_ptr<const Layout> layout);  ///< zeros
  BlockVector(const BlockVector& other);
  BlockVector(BlockVector&& other) noexcept;
  BlockVector& operator=(BlockVector other) noexcept;
  ~BlockVector();
  template <class Expression>
  BlockVector(const Combination<Expression>& sum) : BlockVector(sum.layout) { numbers() = sum.numbers; }

  bool empty() const { return !layout_; }  ///< true if the vector is absent
  const std::shared_ptr<const Layout>& layout() const { return layout_; }

  /// Return views of the rows of a block: numbers as stored, that is, values divided by the unit of the block.
  Rows operator()(BlockId id) { return {numbers_ + layout_->first(id), (*layout_)[id].rows, (*layout_)[id].components}; }
  ConstRows operator()(BlockId id) const { return {numbers_ + layout_->first(id), (*layout_)[id].rows, (*layout_)[id].components}; }

  Eigen::MatrixXd value(BlockId id) const { return (*layout_)[id].unit * (*this)(id); }
  void set(BlockId id, const Eigen::MatrixXd& value) { (*this)(id) = value / (*layout_)[id].unit; }

  /// Return a view of the numbers of all blocks, as stored.
  Numbers numbers() { return {numbers_, empty() ? 0 : layout_->size()}; }
  ConstNumbers numbers() const { return {numbers_, empty() ? 0 : layout_->size()}; }

  template <class Sum>
  BlockVector& operator+=(const Sum& other);
  template <class Sum>
  BlockVector& operator-=(const Sum& other);
  BlockVector& operator*=(double factor) { numbers() *= factor; return *this; }

  /// Returns the inner product of the numbers of two vectors; 0 if one of them is absent.
  friend double dot(const BlockVector& a, const BlockVector& b) {
    return a.empty() || b.empty() ? 0 : a.numbers().cwiseProduct(b.numbers()).sum();
  }
  double norm() const { return numbers().norm(); }
  bool allFinite() const { return numbers().allFinite(); }
  bool operator==(const BlockVector& other) const { return numbers().size() == other.numbers().size() && numbers() == other.numbers(); }

  struct Storage;  ///< the Tpetra vector, see tpetra_of() in system/blocks/tpetra.hpp
  Storage* storage() { return storage_.get(); }
  const Storage* storage() const { return storage_.get(); }

 private:
  void swap(BlockVector& other) noexcept;

  std::shared_ptr<const Layout> layout_;
  std::unique_ptr<Storage> storage_;
  double* numbers_ = nullptr;  // first number of the Tpetra vector
};

/// Unknowns that have a rate, and their rates (Dynamics).
using State = BlockVector;

/// Return a vector as a linear combination, and a linear combination itself.
inline Combination<BlockVector::ConstNumbers> combination(const BlockVector& vector) { return {vector.layout(), vector.numbers()}; }
template <class Numbers>
const Combination<Numbers>& combination(const Combination<Numbers>& sum) { return sum; }

/// Returns `map`, a linear map of vectors of this layout, as a map of their numbers.
inline std::function<void(const double*, double*)> on_blocks(std::shared_ptr<const Layout> layout,
                                                             std::function<BlockVector(const BlockVector&)> map) {
  return [layout = std::move(layout), map = std::move(map)](const double* in, double* out) {
    BlockVector x(layout);
    x.numbers() = BlockVector::ConstNumbers(in, layout->size());
    BlockVector::Numbers(out, layout->size()) = map(x).numbers();
  };
}

template <class Sum>
concept Combinable = requires(const Sum& sum) { combination(sum); };

template <class Sum>
BlockVector& BlockVector::operator+=(const Sum& other) {
  numbers() += combination(other).numbers;
  return *this;
}

template <class Sum>
BlockVector& BlockVector::operator-=(const Sum& other) {
  numbers() -= combination(other).numbers;
  return *this;
}

template <Combinable A, Combinable B>
auto operator+(const A& a, const B& b) {
  const auto sum = combination(a).numbers + combination(b).numbers;
  return Combination<std::remove_const_t<decltype(sum)>>{combination(a).layout, sum};
}

template <Combinable A, Combinable B>
auto operator-(const A& a, const B& b) {
  const auto difference = combination(a).numbers - combination(b).numbers;
  return Combination<std::remove_const_t<decltype(difference)>>{combination(a).layout, difference};
}

template <Combinable A>
auto operator*(double factor, const A& a) {
  const auto multiple = factor * combination(a).numbers;
  return Combination<std::remove_const_t<decltype(multiple)>>{combination(a).layout, multiple};
}

template <Combinable A>
auto operator/(const A& a, double divisor) {
  const auto quotient = combination(a).numbers / divisor;
  return Combination<std::remove_const_t<decltype(quotient)>>{combination(a).layout, quotient};
}

}  // namespace tanktread::coupling
