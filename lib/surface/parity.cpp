#include "surface/parity.hpp"

namespace tanktread::surface {

Parity::Parity(const Symmetry& symmetry, const Vec3& of_planes)
    : source_(symmetry.source()), signs_(Net::Zero(static_cast<Eigen::Index>(source_.size()), 3)),
      scalar_signs_(Eigen::VectorXd::Zero(signs_.rows())) {
  for (const int a : symmetry.fundamental()) signs_.row(a).setOnes(), scalar_signs_[a] = 1;
  for (const Image& g : symmetry.images()) {  // sums over the images of the source at each point
    const double turned = (g.signs.array() < 0).select(of_planes, Vec3::Ones()).prod();
    for (const int a : symmetry.fundamental()) {
      const int b = g.point[static_cast<std::size_t>(a)];
      signs_.row(b) += turned * g.signs.transpose(), scalar_signs_[b] += turned;
    }
  }
  signs_ = signs_.cwiseSign().eval(), scalar_signs_ = scalar_signs_.cwiseSign().eval();
}

void Parity::complete(Net& field) const {
  const Net known = field;
  for (Eigen::Index a = 0; a < field.rows(); ++a) field.row(a) = signs_.row(a).cwiseProduct(known.row(source_[static_cast<std::size_t>(a)]));
}

void Parity::complete(Eigen::VectorXd& field) const {
  const Eigen::VectorXd known = field;
  for (Eigen::Index a = 0; a < field.size(); ++a) field[a] = scalar_signs_[a] * known[source_[static_cast<std::size_t>(a)]];
}

}  // namespace tanktread::surface
