#include "stokes/closed_surface_identities.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "base/threads.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/identity_kernel.hpp"

namespace tanktread::stokes {

namespace {

/// Returns the correction matrix M of the quadrature rule `desingularised` for the collocation site x_i: u_i = sum_q w G f - M f(x_i). With
/// f(x_i) = f_n n0 + f_t, f_t tangential, M f(x_i) is the quadrature error of an integral that vanishes:
///   M f = sum_q w [G (f_n n + f_t (n0.n) + n0 (f_t.n)) - (n0.r) T f_t n].
/// n0 is the normal at x_i, w and n are the weight and the normal at the node x_q, and r = x_q - x_i. If the density is a force per unstressed
/// area, M is scaled to this area.
Mat3 identities(const LayerSources& sources, int site) {
  const auto normal_of = [&](const std::vector<double>& bezier) -> Vec3 {
    const auto [a1, a2] = sources.surface.self_field.tangents(site, sources.surface.panels, bezier);
    return a1.cross(a2);
  };
  const Vec3 at = sources.surface.site(site), a = normal_of(sources.surface.bezier), n0 = a.normalized();
  const auto& node = sources.surface.node;
  const IdentitySums s = identity_sums(sources.n_nodes(), node[0].data(), node[1].data(), node[2].data(), sources.normal[0].data(),
                                       sources.normal[1].data(), sources.normal[2].data(), at.data(), n0.data());
  const Mat3 tangential = Mat3::Identity() - n0 * n0.transpose();
  const Mat3 m = Vec3(s.pressure) * n0.transpose() + Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(s.shear) * tangential;
  const bool unstressed = sources.on_reference(sources.surface.self_field.basis(site, sources.surface.panels).first);
  return unstressed ? Mat3(m * (normal_of(sources.reference_bezier()).norm() / a.norm())) : m;
}

}  // namespace

void subtract_identities(LayerSources& sources, std::span<const int> sites, Net& u) {
  each_item(sites.size(), [&](std::size_t k) {
    u.row(sites[k]) -= (identities(sources, sites[k]) * sources.surface.value(sites[k], sources.bezier_f)).transpose();
  });
  sources.counts.mine().self += static_cast<long long>(sites.size()) * sources.n_nodes();
}

template <class Real>
void subtract_identities(const LayerSources& sources, std::span<const int> sites, Rows<Real>& a) {
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const Mat3 m = over_8_pi * identities(sources, sites[k]);
    const auto [panel, basis] = sources.surface.self_field.basis(sites[k], sources.surface.panels);
    for (int b = 0; b < basis.size(); ++b)
      a.template block<3, 3>(3 * static_cast<Eigen::Index>(k), 3 * sources.surface.panels.points(panel)[b]) -=
          (basis[b] * m).template cast<Real>();
  }
}

template void subtract_identities(const LayerSources& sources, std::span<const int> sites, Rows<float>& a);
template void subtract_identities(const LayerSources& sources, std::span<const int> sites, Rows<double>& a);

void subtract_identities(const LayerSources& sources, std::span<const int> sites, const NearPoints& near, std::vector<double>& entries) {
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const Mat3 m = over_8_pi * identities(sources, sites[k]);
    const auto [panel, basis] = sources.surface.self_field.basis(sites[k], sources.surface.panels);
    const std::span<const int> points(sources.surface.panels.points(panel), static_cast<std::size_t>(basis.size()));
    for (std::size_t j = near.first[k]; j < near.first[k + 1]; ++j) {
      const auto b = std::ranges::find(points, near.point[j]) - points.begin();
      if (b == basis.size()) continue;
      for (std::size_t c = 0; c < kernel_entries; ++c) entries[kernel_entries * j + c] -= basis[b] * m(upper[c][0], upper[c][1]);
    }
  }
}

}  // namespace tanktread::stokes
