#include "membrane/points_kernel.hpp"

#include "base/kernel.hpp"
#include "membrane/dual.hpp"
#include "membrane/packed.hpp"

namespace tanktread::membrane {
namespace INSTRUCTIONS {
namespace {

using Reference = ReferencePointOf<Register>;
using membrane::dot;
Register dot(const Register* a, const Register* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Metric {
  Register g11, g12, g22;
  explicit Metric(const Register* a) : g11(dot(a, a)), g12(dot(a, a + 3)), g22(dot(a + 3, a + 3)) {}
  Register det() const { return g11 * g22 - g12 * g12; }
};

Register first_invariant(const Reference& r, const Metric& m) { return r.g11 * m.g11 + 2.0 * r.g12 * m.g12 + r.g22 * m.g22 - 2.0; }
Register second_invariant(const Reference& r, const Metric& m) { return m.det() * r.inverse_det - 1.0; }

template <class Use>
void visit_points(const Law& law, int n, const ReferencePoint* points, const Pack* tangents, const Use& use) {
  const auto* reference = reinterpret_cast<const Reference*>(points);
  const Register* a = registers(tangents);
  std::visit(
      [&](const auto& l) {
        for (int q = 0; q < n; ++q) use(l, q, reference[q], Metric(a + 6 * q));
      },
      law);
}

// Twice the mean curvature, 2 chi = -M/J^3 with N = x_,s x x_,t, J = |N| and M = (g22 x_,ss - 2 g12 x_,st + g11 x_,tt) . N.
template <class Number>
struct Curved {
  Vector<Number> s, t, ss, st, tt, normal, turned;  // turned: the sum in parentheses in M
  Number g11, g12, g22, j, curvature;

  explicit Curved(const Vector<Number>* jet) : s(jet[0]), t(jet[1]), ss(jet[2]), st(jet[3]), tt(jet[4]), normal(cross(s, t)) {
    g11 = dot(s, s), g12 = dot(s, t), g22 = dot(t, t);
    const Number square = dot(normal, normal);
    j = sqrt(square);
    for (int c = 0; c < 3; ++c) turned[c] = g22 * ss[c] - 2.0 * (g12 * st[c]) + g11 * tt[c];
    curvature = -(dot(turned, normal) / (square * j));
  }

  // Computes p, the gradient of the bending energy density with respect to the five vectors of the jet, by the product rule d[Eb/2 (2 chi - c0)^2
  // J] = Eb (2 chi - c0) J d(2 chi) + Eb/2 (2 chi - c0)^2 dJ. Eb: `modulus`, chi: mean curvature, J = |x_,s x x_,t|.
  void gradient(double modulus, const Register& c0, Vector<Number>* p) const {
    const Number excess = curvature - c0, inverse = 1.0 / j;
    const Number by_m = -modulus * (excess * inverse * inverse);                                              // derivative by M
    const Number by_j = 0.5 * modulus * (excess * excess) - 3.0 * modulus * (excess * curvature);             // derivative by J
    const Number css = dot(ss, normal), cst = dot(st, normal), ctt = dot(tt, normal), by_n = by_j * inverse;  // dJ = N.dN/J
    Vector<Number> n;                                                                                         // derivative by N
    for (int c = 0; c < 3; ++c) n[c] = by_m * turned[c] + by_n * normal[c];
    const Vector<Number> ns = cross(t, n), nt = cross(n, s);
    for (int c = 0; c < 3; ++c) {
      p[0][c] = ns[c] + 2.0 * (by_m * (ctt * s[c] - cst * t[c]));
      p[1][c] = nt[c] + 2.0 * (by_m * (css * t[c] - cst * s[c]));
      p[2][c] = by_m * g22 * normal[c];
      p[3][c] = -2.0 * (by_m * g12 * normal[c]);
      p[4][c] = by_m * g11 * normal[c];
    }
  }
};

void read(const Register* jet, Vector<Register>* x) {
  for (int k = 0; k < 5; ++k)
    for (int c = 0; c < 3; ++c) x[k][c] = jet[3 * k + c];
}

}  // namespace

void reference_points(int n, int used, const Pack* tangents, const double* weight, ReferencePoint* points) {
  const Register* const a = registers(tangents);
  auto* const reference = reinterpret_cast<Reference*>(points);
  for (int q = 0; q < n; ++q) {
    const Metric m(a + 6 * q);
    const Register inverse = 1.0 / m.det();
    reference[q] = {m.g22 * inverse, -m.g12 * inverse, m.g11 * inverse, inverse, weight[q] * sqrt(m.det())};
    for (int l = used; l < lanes; ++l) reference[q].area[l] = 0;
  }
}

void energy(const Law& law, int n, const ReferencePoint* reference, const Pack* tangents, Pack* energy) {
  Register sum{};
  visit_points(law, n, reference, tangents, [&](const auto& l, int, const Reference& r, const Metric& m) {
    sum += r.area * l.energy(first_invariant(r, m), second_invariant(r, m));
  });
  *registers(energy) = sum;
}

void stresses(const Law& law, int n, const ReferencePoint* reference, const Pack* tangents, Pack* gradient) {
  const Register* const a = registers(tangents);
  Register* const p = registers(gradient);
  visit_points(law, n, reference, tangents, [&](const auto& l, int q, const Reference& r, const Metric& m) {
    const auto psi = l.response(first_invariant(r, m), second_invariant(r, m));
    const Register scale = 2.0 * r.area, psi2 = psi.psi2 * r.inverse_det;
    const Register s11 = scale * (psi.psi1 * r.g11 + psi2 * m.g22);
    const Register s12 = scale * (psi.psi1 * r.g12 - psi2 * m.g12);
    const Register s22 = scale * (psi.psi1 * r.g22 + psi2 * m.g11);
    const Register *a1 = a + 6 * q, *a2 = a1 + 3;
    for (int c = 0; c < 3; ++c) {
      p[6 * q + c] = s11 * a1[c] + s12 * a2[c];
      p[6 * q + 3 + c] = s12 * a1[c] + s22 * a2[c];
    }
  });
}

void smaller_tensions(const Law& law, int n, const ReferencePoint* reference, const Pack* tangents, Pack* tension, Pack* area) {
  visit_points(law, n, reference, tangents, [&](const auto& l, int q, const Reference& r, const Metric& m) {
    const Register det = 1.0 / r.inverse_det;
    const auto [larger, smaller] = squared_stretches<Register>({r.g22 * det, -r.g12 * det, r.g11 * det}, {m.g11, m.g12, m.g22});
    const Register squared_ratio = larger * smaller, ratio = sqrt(squared_ratio);
    const auto psi = l.response(larger + smaller - 2.0, squared_ratio - 1.0);
    const Register along = 2.0 * psi.psi1 / ratio, around = 2.0 * ratio * psi.psi2;
    const Register of_larger = along * larger + around, of_smaller = along * smaller + around;
    registers(tension)[q] = of_larger < of_smaller ? of_larger : of_smaller;
    registers(area)[q] = r.area * ratio;
  });
}

// If the strain changes by e_ab (half the change of the metric), the invariants change by dI1 = 2 G.e and dI2 = 2 K.e, with e = (e11, 2 e12, e22),
// G = (G^11, G^12, G^22) of the unstressed surface and K = J_s^2 (g^11, g^12, g^22) of the current surface. J_s is the ratio of current to unstressed
// area. The stress is S = 2 area (Psi_1 G + Psi_2 K), with the unstressed area of the Gauss point, and with Psi_1 and Psi_2 the derivatives of the
// energy with respect to I1 and I2.
void tangent_points(const Law& law, int n, const ReferencePoint* reference, const Pack* tangents, TangentPoint* points) {
  const Register* const a = registers(tangents);
  auto* const tangent = reinterpret_cast<TangentPointOf<Register>*>(points);
  visit_points(law, n, reference, tangents, [&](const auto& l, int q, const Reference& r, const Metric& m) {
    const auto psi = l.response(first_invariant(r, m), second_invariant(r, m));
    const Register scale = 2.0 * r.area;
    const Register g[3] = {r.g11, r.g12, r.g22};
    const Register k[3] = {r.inverse_det * m.g22, -r.inverse_det * m.g12, r.inverse_det * m.g11};
    const auto c = [&](int i, int j) {
      return 2.0 * scale * (psi.psi11 * g[i] * g[j] + psi.psi12 * (g[i] * k[j] + k[i] * g[j]) + psi.psi22 * k[i] * k[j]);
    };
    const Register turn = scale * psi.psi2 * r.inverse_det;  // contribution to the moduli c13 and c22, because K = J_s^2 (g^11, g^12, g^22) depends
                                                             // on the metric
    auto& t = tangent[q];
    for (int i = 0; i < 3; ++i) t.a1[i] = a[6 * q + i], t.a2[i] = a[6 * q + 3 + i];
    t.s11 = scale * (psi.psi1 * g[0] + psi.psi2 * k[0]);
    t.s12 = scale * (psi.psi1 * g[1] + psi.psi2 * k[1]);
    t.s22 = scale * (psi.psi1 * g[2] + psi.psi2 * k[2]);
    t.c11 = c(0, 0), t.c12 = c(0, 1), t.c13 = c(0, 2) + 2.0 * turn;
    t.c22 = c(1, 1) - turn, t.c23 = c(1, 2), t.c33 = c(2, 2);
  });
}

// Viscous stress S = J (2 eta_s g^ac g^bd d_cd + (kappa_s - eta_s) g^ab k.e), with the shear viscosity eta_s, the dilatational viscosity kappa_s, the
// rate of strain d_ab, k = (g^11, g^12, g^22) and e = (d11, 2 d12, d22). J is the current area that the Gauss point represents.
void viscous_points(const SurfaceViscosity& viscosity, int n, const ReferencePoint* points, const Pack* tangents, TangentPoint* moduli) {
  const auto* const reference = reinterpret_cast<const Reference*>(points);
  const Register* const a = registers(tangents);
  auto* const tangent = reinterpret_cast<TangentPointOf<Register>*>(moduli);
  for (int q = 0; q < n; ++q) {
    const Metric m(a + 6 * q);
    const Register inverse = 1.0 / m.det(), area = reference[q].area * sqrt(m.det() * reference[q].inverse_det);
    const Register g11 = inverse * m.g22, g12 = -inverse * m.g12, g22 = inverse * m.g11;
    const Register twice = (2 * viscosity.shear) * area, rest = (viscosity.dilatational - viscosity.shear) * area;
    auto& t = tangent[q];
    for (int i = 0; i < 3; ++i) t.a1[i] = a[6 * q + i], t.a2[i] = a[6 * q + 3 + i];
    t.s11 = t.s12 = t.s22 = Register{};
    t.c11 = (twice + rest) * g11 * g11, t.c12 = (twice + rest) * g11 * g12, t.c13 = twice * g12 * g12 + rest * g11 * g22;
    t.c22 = 0.5 * twice * (g11 * g22 + g12 * g12) + rest * g12 * g12, t.c23 = (twice + rest) * g12 * g22, t.c33 = (twice + rest) * g22 * g22;
  }
}

void apply(int n, const TangentPoint* points, const Pack* gradient, Pack* result) {
  const auto* const tangent = reinterpret_cast<const TangentPointOf<Register>*>(points);
  const Register* const u = registers(gradient);
  Register* const p = registers(result);
  for (int q = 0; q < n; ++q) {
    const auto& t = tangent[q];
    const Register *u1 = u + 6 * q, *u2 = u1 + 3;
    const Register e1 = dot(t.a1, u1), e2 = dot(t.a1, u2) + dot(t.a2, u1), e3 = dot(t.a2, u2);
    const Register d11 = t.c11 * e1 + t.c12 * e2 + t.c13 * e3;
    const Register d12 = t.c12 * e1 + t.c22 * e2 + t.c23 * e3;
    const Register d22 = t.c13 * e1 + t.c23 * e2 + t.c33 * e3;
    for (int c = 0; c < 3; ++c) {
      p[6 * q + c] = t.s11 * u1[c] + t.s12 * u2[c] + d11 * t.a1[c] + d12 * t.a2[c];
      p[6 * q + 3 + c] = t.s12 * u1[c] + t.s22 * u2[c] + d12 * t.a1[c] + d22 * t.a2[c];
    }
  }
}

void curvatures(int n, const Pack* jets, Pack* curvature) {
  for (int q = 0; q < n; ++q) {
    Vector<Register> x[5];
    read(registers(jets) + 15 * q, x);
    registers(curvature)[q] = Curved<Register>(x).curvature;
  }
}

void bending_energy(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* energy) {
  Register sum{};
  for (int q = 0; q < n; ++q) {
    Vector<Register> x[5];
    read(registers(jets) + 15 * q, x);
    const Curved<Register> at(x);
    const Register excess = at.curvature - registers(c0)[q];
    sum += (0.5 * modulus * weight[q]) * excess * excess * at.j;
  }
  *registers(energy) = sum;
}

void bending_stresses(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p) {
  for (int q = 0; q < n; ++q) {
    Vector<Register> x[5], f[5];
    read(registers(jets) + 15 * q, x);
    Curved<Register>(x).gradient(modulus * weight[q], registers(c0)[q], f);
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) registers(p)[15 * q + 3 * k + c] = f[k][c];
  }
}

void bending_apply(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p) {
  for (int q = 0; q < n; ++q) {
    Vector<Dual<Register>> x[5], f[5];
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) x[k][c] = {registers(jets)[15 * q + 3 * k + c], registers(u)[15 * q + 3 * k + c]};
    Curved<Dual<Register>>(x).gradient(modulus * weight[q], registers(c0)[q], f);
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) registers(p)[15 * q + 3 * k + c] = f[k][c].slope;
  }
}

void area_weights(int n, const Pack* tangents, const double* weight, Pack* areas) {
  const Register* a = registers(tangents);
  Register* const area = registers(areas);
  for (int q = 0; q < n; ++q, a += 6) {
    const Register n1 = a[1] * a[5] - a[2] * a[4], n2 = a[2] * a[3] - a[0] * a[5], n3 = a[0] * a[4] - a[1] * a[3];
    area[q] = weight[q] * sqrt(n1 * n1 + n2 * n2 + n3 * n3);
  }
}

void mass_entries(int functions, int n, const Pack* values_at_points, const Pack* weights, Pack* all_entries) {
  const Register *values = registers(values_at_points), *weight = registers(weights);
  Register* entries = registers(all_entries);
  Register row[max_gauss];
  for (int a = 0; a < functions; ++a) {
    for (int q = 0; q < n; ++q) row[q] = weight[q] * values[a * n + q];
    for (int b = 0; b <= a; ++b) {
      Register even{}, odd{};
      for (int q = 0; q + 1 < n; q += 2) {
        even += row[q] * values[b * n + q];
        odd += row[q + 1] * values[b * n + q + 1];
      }
      if (n % 2) even += row[n - 1] * values[b * n + n - 1];
      *entries++ = even + odd;
    }
  }
}

}  // namespace INSTRUCTIONS

KERNEL(void, reference_points, (int n, int used, const Pack* a, const double* weight, ReferencePoint* reference), (n, used, a, weight, reference))
KERNEL(void, energy, (const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* energy), (law, n, reference, a, energy))
KERNEL(void, stresses, (const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* p), (law, n, reference, a, p))
KERNEL(void, smaller_tensions, (const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* tension, Pack* area),
       (law, n, reference, a, tension, area))
KERNEL(void, tangent_points, (const Law& law, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent),
       (law, n, reference, a, tangent))
KERNEL(void, viscous_points, (const SurfaceViscosity& viscosity, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent),
       (viscosity, n, reference, a, tangent))
KERNEL(void, apply, (int n, const TangentPoint* tangent, const Pack* u, Pack* p), (n, tangent, u, p))
KERNEL(void, curvatures, (int n, const Pack* jets, Pack* curvature), (n, jets, curvature))
KERNEL(void, bending_energy, (double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* energy),
       (modulus, n, weight, c0, jets, energy))
KERNEL(void, bending_stresses, (double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p),
       (modulus, n, weight, c0, jets, p))
KERNEL(void, bending_apply, (double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p),
       (modulus, n, weight, c0, jets, u, p))
KERNEL(void, area_weights, (int n, const Pack* a, const double* weight, Pack* area), (n, a, weight, area))
KERNEL(void, mass_entries, (int functions, int n, const Pack* values, const Pack* weight, Pack* entries), (functions, n, values, weight, entries))

}  // namespace tanktread::membrane
