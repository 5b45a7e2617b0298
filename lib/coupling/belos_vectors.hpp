#pragma once
// Short vectors that every rank holds whole, for Belos.

#include <memory>
#include <utility>
#include <vector>

#include <BelosMultiVec.hpp>
#include <Eigen/Core>

namespace tanktread::coupling {

/// Columns of equal length, or a view of some columns of others, whose memory it shares. With a few hundred numbers a column, the maps and views of
/// Tpetra would cost more than the sums.
class Vectors : public Belos::MultiVec<double> {
 public:
  using Base = Belos::MultiVec<double>;
  using Column = Eigen::Map<Eigen::VectorXd>;
  using Small = Teuchos::SerialDenseMatrix<int, double>;

  /// Of any numbers: a solver asks for many more columns than it comes to.
  Vectors(Eigen::Index length, int columns);

  Eigen::Index length() const { return length_; }
  int columns() const { return static_cast<int>(columns_.size()); }

  /// As behind a pointer, the numbers may change.
  Column column(int c) const { return {columns_[static_cast<std::size_t>(c)], length_}; }

  Base* Clone(int columns) const override { return new Vectors(length_, columns); }
  Base* CloneCopy() const override { return copy(*this); }
  Base* CloneCopy(const std::vector<int>& some) const override { return copy(view(some)); }
  Base* CloneViewNonConst(const std::vector<int>& some) override { return new Vectors(view(some)); }
  const Base* CloneView(const std::vector<int>& some) const override { return new Vectors(view(some)); }

  ptrdiff_t GetGlobalLength() const override { return length_; }
  int GetNumberVecs() const override { return columns(); }

  void MvTimesMatAddMv(double alpha, const Base& a, const Small& b, double beta) override;  ///< this = beta this + alpha A B
  void MvAddMv(double alpha, const Base& a, double beta, const Base& b) override;           ///< this = alpha A + beta B
  void MvScale(double alpha) override;
  void MvScale(const std::vector<double>& alpha) override;
  void MvTransMv(double alpha, const Base& a, Small& b) const override;  ///< B = alpha A^T this
  void MvDot(const Base& a, std::vector<double>& b) const override;
  void MvNorm(std::vector<double>& norms, Belos::NormType type) const override;
  void SetBlock(const Base& a, const std::vector<int>& where) override { view(where).set(of(a)); }
  void MvRandom() override;
  void MvInit(double alpha) override;
  void MvPrint(std::ostream& out) const override;

  static const Vectors& of(const Base& any) { return dynamic_cast<const Vectors&>(any); }

 private:
  Vectors(std::shared_ptr<double[]> memory, Eigen::Index length) : memory_(std::move(memory)), length_(length) {}
  Vectors view(const std::vector<int>& some) const;
  void set(const Vectors& other) const;
  static Vectors* copy(const Vectors& other);

  std::shared_ptr<double[]> memory_;
  Eigen::Index length_;
  std::vector<double*> columns_;
};

}  // namespace tanktread::coupling
