#include "stokes/kernels/pair_kernel.hpp"

#include "base/kernel.hpp"
#include "stokes/kernels/panel_points.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

template <int Degree>
struct Sums {
  static void area_weights(const PointTable& table, const double* bezier, Register* weight) {
    const int n_b = n_bernstein<Degree>(table);
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      Register a[3], b[3];
      for (int c = 0; c < 3; ++c) points.gradient(bezier + n_b * c, a[c], b[c]);
      const Register nx = a[1] * b[2] - a[2] * b[1], ny = a[2] * b[0] - a[0] * b[2], nz = a[0] * b[1] - a[1] * b[0];
      weight[k] = registers(table.weights.data())[k] * sqrt(nx * nx + ny * ny + nz * nz);
    }
  }

  static void single_sum(const PointTable& table, const double* x, const double* f, const Register* weight, const double* x0, double* u) {
    const int n_b = n_bernstein<Degree>(table);
    Register ux{}, uy{}, uz{};
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      const Register rx = points.value(x) - x0[0], ry = points.value(x + n_b) - x0[1], rz = points.value(x + 2 * n_b) - x0[2];
      const Register fx = points.value(f), fy = points.value(f + n_b), fz = points.value(f + 2 * n_b);
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz), weighted = inverse * weight[k];
      const Register along = (rx * fx + ry * fy + rz * fz) * (inverse * inverse);
      ux += weighted * (fx + rx * along);
      uy += weighted * (fy + ry * along);
      uz += weighted * (fz + rz * along);
    }
    u[0] = sum(ux), u[1] = sum(uy), u[2] = sum(uz);
  }

  static void single_moments(const PointTable& table, const double* x, const Register* weight, const double* x0, Register* g, double* moment) {
    const int n_b = n_bernstein<Degree>(table);
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      const Register rx = points.value(x) - x0[0], ry = points.value(x + n_b) - x0[1], rz = points.value(x + 2 * n_b) - x0[2];
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz), weighted = inverse * weight[k];
      const Register cube = weighted * inverse * inverse;
      g[6 * k] = weighted + cube * rx * rx, g[6 * k + 1] = cube * rx * ry, g[6 * k + 2] = cube * rx * rz;
      g[6 * k + 3] = weighted + cube * ry * ry, g[6 * k + 4] = cube * ry * rz, g[6 * k + 5] = weighted + cube * rz * rz;
    }
    project<Degree, 6>(table, g, moment);
  }

  static void double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u) {
    const int n_b = n_bernstein<Degree>(table);
    Register ux{}, uy{}, uz{};
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      Register r[3], n[3];
      const Register normal = points.height(x, n_b, x0, r, n) * registers(table.weights.data())[k];
      const Register velocity =
          r[0] * (points.value(v) - v0[0]) + r[1] * (points.value(v + n_b) - v0[1]) + r[2] * (points.value(v + 2 * n_b) - v0[2]);
      const Register inverse = inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), square = inverse * inverse;
      const Register strength = -6 * velocity * normal * (square * square * inverse);
      ux += strength * r[0];
      uy += strength * r[1];
      uz += strength * r[2];
    }
    u[0] = sum(ux), u[1] = sum(uy), u[2] = sum(uz);
  }

  static void double_moments(const PointTable& table, const double* x, const double* x0, Register* g, double* moment) {
    const int n_b = n_bernstein<Degree>(table);
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      Register r[3], n[3];
      const Register normal = points.height(x, n_b, x0, r, n) * registers(table.weights.data())[k];
      const Register inverse = inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), square = inverse * inverse;
      const Register strength = -6 * normal * (square * square * inverse);
      int c = 6 * k;
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) g[c++] = strength * r[i] * r[j];
    }
    project<Degree, 6>(table, g, moment);
  }
};

}  // namespace

void area_weights(const PointTable& table, const double* bezier, Pack* weight) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.area_weights(table, bezier, registers(weight)); });
}

void single_sum(const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.single_sum(table, x, f, registers(weight), x0, u); });
}

void single_moments(const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.single_moments(table, x, registers(weight), x0, registers(scratch), moment); });
}

void double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.double_sum(table, x, v, x0, v0, u); });
}

void double_moments(const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.double_moments(table, x, x0, registers(scratch), moment); });
}

}  // namespace INSTRUCTIONS

KERNEL(void, area_weights, (const PointTable& table, const double* bezier, Pack* weight), (table, bezier, weight))
KERNEL(void, single_sum, (const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u),
       (table, x, f, weight, x0, u))
KERNEL(void, single_moments, (const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment),
       (table, x, weight, x0, scratch, moment))
KERNEL(void, double_sum, (const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u),
       (table, x, v, x0, v0, u))
KERNEL(void, double_moments, (const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment),
       (table, x, x0, scratch, moment))

}  // namespace tanktread::stokes
