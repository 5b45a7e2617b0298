#include "stokes/kernels/image_kernel.hpp"

#include "base/kernel.hpp"
#include "stokes/kernels/panel_points.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

constexpr int packs = far_block / lanes;

/// Coefficients of the image Stokeslet G^I (2.35) for as many pairs of node and target as fit into a register.
struct ImageOfForce {
  Register z, i, i3, h, c, isotropic, dyadic, normal;

  ImageOfForce(const Register (&r)[3], const Register& z0)
      : z(z0), i(inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])), i3(i * i * i), h(r[2] - z0) {
    const Register i5 = i3 * i * i, both = z * h;
    c = 2 * z;
    isotropic = i + 2 * both * i3;
    dyadic = i3 - 6 * both * i5;
    normal = c * (i3 - 6 * h * r[2] * i5);
  }

  /// Adds the image Stokeslet G^I (2.35) of the force f to u. The components of f are registers or numbers.
  template <class Number>
  void add(const Register (&r)[3], const Number& fx, const Number& fy, const Number& fz, Register (&u)[3]) const {
    const Register along = r[0] * fx + r[1] * fy + r[2] * fz, push = c * i3 * fz, of_r = along * dyadic - push;
    u[0] -= fx * isotropic + r[0] * of_r;
    u[1] -= fy * isotropic + r[1] * of_r;
    u[2] -= fz * isotropic + r[2] * of_r - along * normal + 2 * z * push;
  }
};

/// Coefficients of the image stresslet T^I (2.36) for as many pairs of node and target as fit into a register.
struct ImageOfStress {
  Register z, i5, i7, h;

  ImageOfStress(const Register (&r)[3], const Register& z0) : z(z0), h(r[2] - z0) {
    const Register i = inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), i2 = i * i;
    i5 = i2 * i2 * i, i7 = i5 * i2;
  }

  /// Adds the image stresslet T^I (2.36) with the strength S to u. sr: the vector S r. `trace`: the trace of S.
  void add(const Register (&r)[3], const Register (&sr)[3], const Register& trace, Register (&u)[3]) const {
    const Register form = r[0] * sr[0] + r[1] * sr[1] + r[2] * sr[2];
    const Register of_r = 6 * form * i5 - 60 * z * h * form * i7 - 12 * trace * z * z * i5, of_sr = 24 * z * h * i5;
    u[0] += of_r * r[0] + of_sr * sr[0];
    u[1] += of_r * r[1] + of_sr * sr[1];
    u[2] += 12 * h * form * i5 - of_r * r[2] - of_sr * sr[2];
  }
};

template <int Degree>
struct Sums {
  static void single_sum(const PointTable& table, const double* x, const double* f, const Register* weight, const double* x0, double* u) {
    const int n_b = n_bernstein<Degree>(table);
    const Register z = Register{} - x0[2];
    Register total[3] = {};
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      const Register r[3] = {points.value(x) - x0[0], points.value(x + n_b) - x0[1], points.value(x + 2 * n_b) - x0[2]};
      ImageOfForce(r, z).add(r, points.value(f) * weight[k], points.value(f + n_b) * weight[k], points.value(f + 2 * n_b) * weight[k], total);
    }
    for (int c = 0; c < 3; ++c) u[c] = sum(total[c]);
  }

  static void single_moments(const PointTable& table, const double* x, const Register* weight, const double* x0, Register* g, double* moment) {
    const int n_b = n_bernstein<Degree>(table);
    const Register z = Register{} - x0[2];
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      const Register r[3] = {points.value(x) - x0[0], points.value(x + n_b) - x0[1], points.value(x + 2 * n_b) - x0[2]};
      const ImageOfForce image(r, z);
      for (int j = 0; j < 3; ++j) {
        Register u[3] = {};
        image.add(r, j == 0 ? weight[k] : Register{}, j == 1 ? weight[k] : Register{}, j == 2 ? weight[k] : Register{}, u);
        for (int i = 0; i < 3; ++i) g[9 * k + 3 * i + j] = u[i];
      }
    }
    project<Degree, 9>(table, g, moment);
  }

  static void double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u) {
    const int n_b = n_bernstein<Degree>(table);
    const Register z = Register{} - x0[2];
    Register total[3] = {};
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      Register r[3], n[3];
      const Register weight = registers(table.weights.data())[k], height = weight * points.height(x, n_b, x0, r, n);
      const Register w[3] = {points.value(v) - v0[0], points.value(v + n_b) - v0[1], points.value(v + 2 * n_b) - v0[2]};
      add(ImageOfStress(r, z), r, w, n, height, weight, total);
    }
    for (int c = 0; c < 3; ++c) u[c] = sum(total[c]);
  }

  static void double_moments(const PointTable& table, const double* x, const double* x0, Register* g, double* moment) {
    const int n_b = n_bernstein<Degree>(table);
    const Register z = Register{} - x0[2];
    for (int k = 0; k < table.packs(); ++k) {
      const Points<Degree> points(table, k);
      Register r[3], n[3];
      const Register weight = registers(table.weights.data())[k], height = weight * points.height(x, n_b, x0, r, n);
      const ImageOfStress image(r, z);
      for (int j = 0; j < 3; ++j) {
        Register w[3] = {}, u[3] = {};
        w[j] = Register{} + 1;
        add(image, r, w, n, height, weight, u);
        for (int i = 0; i < 3; ++i) g[9 * k + 3 * i + j] = u[i];
      }
    }
    project<Degree, 9>(table, g, moment);
  }

  /// Adds the image stresslet T^I (2.36) of the density w at a node with the normal n to u. The strength is S = weight (w n + n w)/2, where `weight`
  /// is the quadrature weight. `height`: weight r.n.
  static void add(const ImageOfStress& image, const Register (&r)[3], const Register (&w)[3], const Register (&n)[3], const Register& height,
                  const Register& weight, Register (&u)[3]) {
    const Register along = weight * (r[0] * w[0] + r[1] * w[1] + r[2] * w[2]);
    Register sr[3];
    for (int c = 0; c < 3; ++c) sr[c] = 0.5 * (w[c] * height + n[c] * along);
    image.add(r, sr, weight * (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]), u);
  }
};

/// Computes sums over the points for a block of targets, which are given by their mirror images. add(k, r, z0, u) adds the contribution of point k to
/// u: r is the vector from the mirror image to the point, and z0 the height of the target itself above the wall.
template <class Add>
void image_sum(const Charges& points, const double* target, double* value, const Add& add) {
  for (int p = 0; p < packs; ++p) {
    Register t[3], u[3] = {};
    for (int c = 0; c < 3; ++c) t[c] = load(target + far_block * c + lanes * p);
    for (int k = 0; k < points.n; ++k) {
      const Register r[3] = {points.x[k] - t[0], points.y[k] - t[1], points.z[k] - t[2]};
      add(k, r, -t[2], u);
    }
    for (int c = 0; c < 3; ++c) store(u[c], value + far_block * c + lanes * p);
  }
}

}  // namespace

void image_stokeslet_sum(const Charges& points, const double* target, double* value) {
  const auto& q = points.q;
  image_sum(points, target, value, [&](int k, const Register (&r)[3], const Register& z0, Register (&u)[3]) {
    ImageOfForce(r, z0).add(r, q[0][k], q[1][k], q[2][k], u);
  });
}

void image_stresslet_sum(const Charges& points, const double* target, double* value) {
  const auto& q = points.q;
  image_sum(points, target, value, [&](int k, const Register (&r)[3], const Register& z0, Register (&u)[3]) {
    const Register sr[3] = {q[0][k] * r[0] + q[3][k] * r[1] + q[4][k] * r[2], q[3][k] * r[0] + q[1][k] * r[1] + q[5][k] * r[2],
                            q[4][k] * r[0] + q[5][k] * r[1] + q[2][k] * r[2]};
    ImageOfStress(r, z0).add(r, sr, Register{} + (q[0][k] + q[1][k] + q[2][k]), u);
  });
}

void image_single_sum(const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.single_sum(table, x, f, registers(weight), x0, u); });
}

void image_double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.double_sum(table, x, v, x0, v0, u); });
}

void image_single_moments(const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.single_moments(table, x, registers(weight), x0, registers(scratch), moment); });
}

void image_double_moments(const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment) {
  with_degree<Sums>(table.degree, [&](auto sums) { sums.double_moments(table, x, x0, registers(scratch), moment); });
}

}  // namespace INSTRUCTIONS

KERNEL(void, image_stokeslet_sum, (const Charges& points, const double* target, double* value), (points, target, value))
KERNEL(void, image_stresslet_sum, (const Charges& points, const double* target, double* value), (points, target, value))
KERNEL(void, image_single_sum, (const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u),
       (table, x, f, weight, x0, u))
KERNEL(void, image_double_sum, (const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u),
       (table, x, v, x0, v0, u))
KERNEL(void, image_single_moments, (const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment),
       (table, x, weight, x0, scratch, moment))
KERNEL(void, image_double_moments, (const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment),
       (table, x, x0, scratch, moment))

}  // namespace tanktread::stokes
