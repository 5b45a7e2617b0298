#include "surface/integrals_kernel.hpp"

#include <stdexcept>
#include <string>

#include "base/kernel.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface::kernel {
namespace INSTRUCTIONS {
namespace {

/// Bernstein values and derivatives at the Gauss points of one direction.
template <int p, int n>
struct Table {
  double weight[n], value[n][p + 1], slope[n][p + 1];
  Table() {
    const quadrature::GaussRule& rule = quadrature::gauss(n);
    for (int q = 0; q < n; ++q) {
      weight[q] = rule.weights[q];
      spline::bernstein(p, rule.nodes[q], value[q], slope[q], nullptr);
    }
  }
};

/// Calls use(q_s, q_t, x, a1, a2) at every node of the tensor rule, with the position x and the tangents a1, a2 as three SIMD registers each, one per
/// component. Bernstein expansions are summed along s first, then along t. If with_place is false, x is 0.
template <int p, int n, bool with_place, class Use>
inline void each_node(const Table<p, n>& table, const Lanes& points_of_lanes, Use use) {
  const auto* points = reinterpret_cast<const Register*>(points_of_lanes.value);
  for (int qs = 0; qs < n; ++qs) {
    Register value[3][p + 1], slope[3][p + 1];
    for (int c = 0; c < 3; ++c) {
      for (int j = 0; j <= p; ++j) {
        const Register* row = points + (c * (p + 1) + j) * (p + 1);
        Register v{}, d{};
        for (int i = 0; i <= p; ++i) {
          v += table.value[qs][i] * row[i];
          d += table.slope[qs][i] * row[i];
        }
        value[c][j] = v;
        slope[c][j] = d;
      }
    }
    for (int qt = 0; qt < n; ++qt) {
      Register x[3]{}, a1[3]{}, a2[3]{};
      for (int c = 0; c < 3; ++c) {
        for (int j = 0; j <= p; ++j) {
          if constexpr (with_place) x[c] += table.value[qt][j] * value[c][j];
          a1[c] += table.value[qt][j] * slope[c][j];
          a2[c] += table.slope[qt][j] * value[c][j];
        }
      }
      use(qs, qt, x, a1, a2);
    }
  }
}

inline void cross(const Register (&a)[3], const Register (&b)[3], Register (&c)[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

inline void store(const Register& from, double (&to)[most_lanes]) {
  for (int l = 0; l < lanes; ++l) to[l] = from[l];
}

/// Computes the 16 solid harmonics h of degree 0 to 3 at the position `at`.
inline void harmonics(const Register (&at)[3], Register (&h)[n_harmonics]) {
  const Register x = at[0], y = at[1], z = at[2], xx = x * x, yy = y * y, zz = z * z;
  const Register all[n_harmonics] = {Register{} + 1.,
                                     x,
                                     y,
                                     z,
                                     x * y,
                                     y * z,
                                     z * x,
                                     xx - yy,
                                     2. * zz - xx - yy,
                                     x * (xx - 3. * yy),
                                     y * (3. * xx - yy),
                                     z * (xx - yy),
                                     x * y * z,
                                     x * (4. * zz - xx - yy),
                                     y * (4. * zz - xx - yy),
                                     z * (2. * zz - 3. * xx - 3. * yy)};
  for (int i = 0; i < n_harmonics; ++i) h[i] = all[i];
}

template <int p>
struct Of {
  static constexpr int n = quadrature::gauss_points_for_degree(3 * p - 1);
  static constexpr int n_moments = quadrature::gauss_points_for_degree(5 * p - 1);
  static constexpr int n_transport = quadrature::gauss_points_for_degree(4 * p - 1);
  static constexpr int n_shape = 3;

  static void volume_gradient(const Lanes& points, Lanes& gradient) { normal_integrals<n, false>(points, nullptr, gradient); }
  static void moment_gradient(const Lanes& points, const double* g, Lanes& gradient) { normal_integrals<n_transport, true>(points, g, gradient); }

  /// Computes the integral of B_b n over each element for each Bernstein polynomial B_b, or if with_place is true, of B_b (g.x) n with the vector g.
  template <int n, bool with_place>
  static void normal_integrals(const Lanes& points, const double* g, Lanes& gradient) {
    static const Table<p, n> table;
    auto* result = reinterpret_cast<Register*>(gradient.value);
    for (int k = 0; k < 3 * (p + 1) * (p + 1); ++k) result[k] = Register{};
    Register over_t[3][p + 1];
    each_node<p, n, with_place>(table, points, [&](int qs, int qt, const Register(&x)[3], const Register(&a1)[3], const Register(&a2)[3]) {
      Register normal[3];
      cross(a1, a2, normal);
      const double weight = table.weight[qs] * table.weight[qt];
      if constexpr (with_place) {
        const Register height = g[0] * x[0] + g[1] * x[1] + g[2] * x[2];
        for (Register& component : normal) component *= height;
      }
      for (int c = 0; c < 3; ++c)
        for (int j = 0; j <= p; ++j) {
          const Register term = (weight * table.value[qt][j]) * normal[c];
          over_t[c][j] = qt == 0 ? term : over_t[c][j] + term;
        }
      if (qt + 1 < n) return;
      for (int c = 0; c < 3; ++c)
        for (int j = 0; j <= p; ++j)
          for (int i = 0; i <= p; ++i) result[(c * (p + 1) + j) * (p + 1) + i] += table.value[qs][i] * over_t[c][j];
    });
  }

  static void moments(const Lanes& points, Moments& result) {
    static const Table<p, n_moments> table;
    Register area{}, volume_sum{}, first[3]{}, second[6]{};
    each_node<p, n_moments, true>(table, points, [&](int qs, int qt, const Register(&x)[3], const Register(&a1)[3], const Register(&a2)[3]) {
      Register normal[3];
      cross(a1, a2, normal);
      const double weight = table.weight[qs] * table.weight[qt];
      const Register square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
      area += weight * sqrt(square);
      const Register flux = weight * (x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2]);
      volume_sum += flux;
      for (int c = 0; c < 3; ++c) {
        first[c] += flux * x[c];
        second[c] += flux * x[c] * x[c];
      }
      second[3] += flux * x[0] * x[1];
      second[4] += flux * x[0] * x[2];
      second[5] += flux * x[1] * x[2];
    });
    store(area, result.area);
    store(volume_sum / 3, result.volume);
    for (int c = 0; c < 3; ++c) store(first[c] / 4, result.first[c]);
    for (int k = 0; k < 6; ++k) store(second[k] / 5, result.second[k]);
  }

  /// Computes the velocity v at the Gauss points, indexed [s][t].
  template <int n>
  static void node_values(const Table<p, n>& table, const Lanes& velocities, Register (&v)[n][n][3]) {
    each_node<p, n, true>(table, velocities, [&](int qs, int qt, const Register(&at)[3], const Register(&)[3], const Register(&)[3]) {
      for (int c = 0; c < 3; ++c) v[qs][qt][c] = at[c];
    });
  }

  static void shape_motion(const Lanes& points, const Lanes& velocities, ShapeMotion& result) {
    static const Table<p, n_shape> table;
    Register v[n_shape][n_shape][3], products[n_harmonics * (n_harmonics + 1) / 2]{}, motion[n_harmonics]{}, normals[n_harmonics][3]{};
    node_values(table, velocities, v);
    each_node<p, n_shape, true>(table, points, [&](int qs, int qt, const Register(&x)[3], const Register(&a1)[3], const Register(&a2)[3]) {
      Register normal[3], h[n_harmonics];
      cross(a1, a2, normal);
      harmonics(x, h);
      for (Register& component : normal) component *= table.weight[qs] * table.weight[qt];
      const Register area = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
      const Register flux = v[qs][qt][0] * normal[0] + v[qs][qt][1] * normal[1] + v[qs][qt][2] * normal[2];
      for (int i = 0, k = 0; i < n_harmonics; ++i) {
        const Register weighted = area * h[i];
        for (int j = i; j < n_harmonics; ++j) products[k++] += weighted * h[j];
        motion[i] += flux * h[i];
        for (int c = 0; c < 3; ++c) normals[i][c] += normal[c] * h[i];
      }
    });
    for (int k = 0; k < n_harmonics * (n_harmonics + 1) / 2; ++k) store(products[k], result.products[k]);
    for (int i = 0; i < n_harmonics; ++i) {
      store(motion[i], result.motion[i]);
      for (int c = 0; c < 3; ++c) store(normals[i][c], result.normals[i][c]);
    }
  }

  static void transport(const Lanes& points, const Lanes& velocities, Transport& result) {
    static const Table<p, n_transport> table;
    Register v[n_transport][n_transport][3], volume_sum{}, flux_sum{}, first[3]{}, flux_moment[3]{};
    node_values(table, velocities, v);
    each_node<p, n_transport, true>(table, points, [&](int qs, int qt, const Register(&x)[3], const Register(&a1)[3], const Register(&a2)[3]) {
      Register normal[3];
      cross(a1, a2, normal);
      const double weight = table.weight[qs] * table.weight[qt];
      const Register outward = weight * (x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2]);
      volume_sum += outward;
      const Register flux = weight * (v[qs][qt][0] * normal[0] + v[qs][qt][1] * normal[1] + v[qs][qt][2] * normal[2]);
      flux_sum += flux;
      for (int c = 0; c < 3; ++c) {
        first[c] += outward * x[c];
        flux_moment[c] += flux * x[c];
      }
    });
    store(volume_sum / 3, result.volume);
    store(flux_sum, result.flux);
    for (int c = 0; c < 3; ++c) {
      store(first[c] / 4, result.first[c]);
      store(flux_moment[c], result.flux_moment[c]);
    }
  }
};

/// Calls `use` with the degree as a compile-time constant.
template <class Use>
void with_degree(int degree, Use use) {
  switch (degree) {
    case 2:
      return use(std::integral_constant<int, 2>{});
    case 3:
      return use(std::integral_constant<int, 3>{});
    case 4:
      return use(std::integral_constant<int, 4>{});
    case 5:
      return use(std::integral_constant<int, 5>{});
    case 6:
      return use(std::integral_constant<int, 6>{});
  }
  throw std::logic_error("surface integrals have no rule for elements of degree " + std::to_string(degree));
}

}  // namespace

void volume_gradient(int degree, const Lanes& x, Lanes& gradient) {
  with_degree(degree, [&](auto p) { Of<p>::volume_gradient(x, gradient); });
}

void moment_gradient(int degree, const Lanes& x, const double* g, Lanes& gradient) {
  with_degree(degree, [&](auto p) { Of<p>::moment_gradient(x, g, gradient); });
}

void moments(int degree, const Lanes& x, Moments& result) {
  with_degree(degree, [&](auto p) { Of<p>::moments(x, result); });
}

void transport(int degree, const Lanes& x, const Lanes& v, Transport& result) {
  with_degree(degree, [&](auto p) { Of<p>::transport(x, v, result); });
}

void shape_motion(int degree, const Lanes& x, const Lanes& v, ShapeMotion& result) {
  with_degree(degree, [&](auto p) { Of<p>::shape_motion(x, v, result); });
}

}  // namespace INSTRUCTIONS

KERNEL(void, volume_gradient, (int degree, const Lanes& x, Lanes& gradient), (degree, x, gradient))
KERNEL(void, moment_gradient, (int degree, const Lanes& x, const double* g, Lanes& gradient), (degree, x, g, gradient))
KERNEL(void, moments, (int degree, const Lanes& x, Moments& result), (degree, x, result))
KERNEL(void, transport, (int degree, const Lanes& x, const Lanes& v, Transport& result), (degree, x, v, result))
KERNEL(void, shape_motion, (int degree, const Lanes& x, const Lanes& v, ShapeMotion& result), (degree, x, v, result))

}  // namespace tanktread::surface::kernel
