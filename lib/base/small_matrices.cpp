#include "base/small_matrices.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace tanktread {

Mat3 exponential(const Mat3& a) { return a.exp(); }

double largest_growth_rate(const Mat3& a) { return a.eigenvalues().real().maxCoeff(); }

double largest_stretch(const Mat3& a) { return Eigen::JacobiSVD<Mat3>(a).singularValues()[0]; }

Mat3 nearest_rotation(const Mat3& a) {
  const Eigen::JacobiSVD<Mat3> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 right = svd.matrixV().transpose();
  if ((svd.matrixU() * right).determinant() < 0) right.row(2) *= -1;
  return svd.matrixU() * right;
}

Mat3 rotation_between(const Net& from, const Net& to) {
  return nearest_rotation((to.rowwise() - to.colwise().mean()).transpose() * (from.rowwise() - from.colwise().mean()));
}

}  // namespace tanktread
