#include "membrane/bending_kernel.hpp"

#include "membrane/dual.hpp"

namespace tanktread::membrane {
namespace {

template <class Number>
struct Vector {
  Number c[3];
};
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {{a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2], a.c[0] * b.c[1] - a.c[1] * b.c[0]}};
}

// With N = x_,s x x_,t, J = |N| and M = (g22 x_,ss - 2 g12 x_,st + g11 x_,tt) . N:  2 chi = -M/J^3.
template <class Number>
struct Curved {
  Vector<Number> s, t, ss, st, tt, normal, turned;  // turned: the bracket of M
  Number g11, g12, g22, j, curvature;

  explicit Curved(const Vector<Number>* jet) : s(jet[0]), t(jet[1]), ss(jet[2]), st(jet[3]), tt(jet[4]), normal(cross(s, t)) {
    g11 = dot(s, s), g12 = dot(s, t), g22 = dot(t, t);
    const Number square = dot(normal, normal);
    j = sqrt(square);
    for (int c = 0; c < 3; ++c) turned.c[c] = g22 * ss.c[c] - 2.0 * (g12 * st.c[c]) + g11 * tt.c[c];
    curvature = -(dot(turned, normal) / (square * j));
  }

  // d[Eb/2 (2 chi - c0)^2 J] = Eb (2 chi - c0) J d(2 chi) + Eb/2 (2 chi - c0)^2 dJ, by the five vectors of the jet
  void gradient(double modulus, const Pack& c0, Vector<Number>* p) const {
    const Number excess = curvature - c0, inverse = 1.0 / j;
    const Number by_m = -modulus * (excess * inverse * inverse);                                              // of M
    const Number by_j = 0.5 * modulus * (excess * excess) - 3.0 * modulus * (excess * curvature);             // of J
    const Number css = dot(ss, normal), cst = dot(st, normal), ctt = dot(tt, normal), by_n = by_j * inverse;  // dJ = N.dN/J
    Vector<Number> n;                                                                                         // by N
    for (int c = 0; c < 3; ++c) n.c[c] = by_m * turned.c[c] + by_n * normal.c[c];
    const Vector<Number> ns = cross(t, n), nt = cross(n, s);
    for (int c = 0; c < 3; ++c) {
      p[0].c[c] = ns.c[c] + 2.0 * (by_m * (ctt * s.c[c] - cst * t.c[c]));
      p[1].c[c] = nt.c[c] + 2.0 * (by_m * (css * t.c[c] - cst * s.c[c]));
      p[2].c[c] = by_m * g22 * normal.c[c];
      p[3].c[c] = -2.0 * (by_m * g12 * normal.c[c]);
      p[4].c[c] = by_m * g11 * normal.c[c];
    }
  }
};

void read(const Pack* jet, Vector<Pack>* x) {
  for (int k = 0; k < 5; ++k)
    for (int c = 0; c < 3; ++c) x[k].c[c] = jet[3 * k + c];
}

}  // namespace

void curvatures(int n, const Pack* jets, Pack* curvature) {
  for (int q = 0; q < n; ++q) {
    Vector<Pack> x[5];
    read(jets + 15 * q, x);
    curvature[q] = Curved<Pack>(x).curvature;
  }
}

Pack bending_energy(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets) {
  Pack sum{};
  for (int q = 0; q < n; ++q) {
    Vector<Pack> x[5];
    read(jets + 15 * q, x);
    const Curved<Pack> at(x);
    const Pack excess = at.curvature - c0[q];
    sum += (0.5 * modulus * weight[q]) * excess * excess * at.j;
  }
  return sum;
}

void bending_stresses(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p) {
  for (int q = 0; q < n; ++q) {
    Vector<Pack> x[5], f[5];
    read(jets + 15 * q, x);
    Curved<Pack>(x).gradient(modulus * weight[q], c0[q], f);
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) p[15 * q + 3 * k + c] = f[k].c[c];
  }
}

void bending_apply(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p) {
  for (int q = 0; q < n; ++q) {
    Vector<Dual<Pack>> x[5], f[5];
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) x[k].c[c] = {jets[15 * q + 3 * k + c], u[15 * q + 3 * k + c]};
    Curved<Dual<Pack>>(x).gradient(modulus * weight[q], c0[q], f);
    for (int k = 0; k < 5; ++k)
      for (int c = 0; c < 3; ++c) p[15 * q + 3 * k + c] = f[k].c[c].slope;
  }
}

}  // namespace tanktread::membrane
