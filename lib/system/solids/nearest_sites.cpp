#include "system/solids/nearest_sites.hpp"

namespace tanktread::coupling {

std::vector<int> nearest_sites(const Net& sites, const Net& targets, std::span<const int> rows, const stokes::PeriodicCell* cell) {
  std::vector<int> nearest(static_cast<std::size_t>(targets.rows()), 0);
  for (const int i : rows) {
    Eigen::Index at = 0;
    Net apart = sites.rowwise() - targets.row(i);
    for (Eigen::Index k = 0; cell && k < apart.rows(); ++k) apart.row(k) -= cell->shift(apart.row(k).transpose()).transpose();
    apart.rowwise().squaredNorm().minCoeff(&at);
    nearest[static_cast<std::size_t>(i)] = static_cast<int>(at);
  }
  return nearest;
}

}  // namespace tanktread::coupling
