// Control points -> Bezier points -> tangents at Gauss points, by sum factorisation, and the transpose of that chain.

#include <utility>

#include "membrane/packed.hpp"

namespace tanktread::membrane {
namespace {

constexpr int max_bernstein = (max_degree + 1) * (max_degree + 1);

// bezier[3 b + c] = sum_A extraction[A][b] x_A[c], four b at a time
template <int Width>
void extract_columns(const Pack* extraction, const Pack* x, int functions, int n_b, int b, Pack* bezier) {
  Pack sum[Width][3] = {};
  for (int a = 0; a < functions; ++a)
    for (int k = 0; k < Width; ++k) {
      const Pack& e = extraction[a * n_b + b + k];
      for (int c = 0; c < 3; ++c) sum[k][c] += e * x[3 * a + c];
    }
  for (int k = 0; k < Width; ++k)
    for (int c = 0; c < 3; ++c) bezier[3 * (b + k) + c] = sum[k][c];
}

// f_A[c] = sum_b extraction[A][b] bezier[3 b + c], several A at a time
template <int Width>
void extract_rows(const Pack* extraction, const Pack* bezier, int n_b, int a, Pack* f) {
  Pack sum[Width][3] = {};
  for (int b = 0; b < n_b; ++b)
    for (int k = 0; k < Width; ++k) {
      const Pack& e = extraction[(a + k) * n_b + b];
      for (int c = 0; c < 3; ++c) sum[k][c] += e * bezier[3 * b + c];
    }
  for (int k = 0; k < Width; ++k)
    for (int c = 0; c < 3; ++c) f[3 * (a + k) + c] = sum[k][c];
}

void gather(const Group& g, const Batch& batch, const Net& net, Pack* x) {
  const int* points = &g.points[batch.points];
  const double* rows = net.data();
  for (int a = 0; a < batch.functions; ++a)
    for (int l = 0; l < lanes; ++l) {
      const double* row = rows + 3 * static_cast<std::ptrdiff_t>(points[a * lanes + l]);
      for (int c = 0; c < 3; ++c) x[3 * a + c][l] = row[c];
    }
}

void scatter(const Group& g, const Batch& batch, const Pack* f, Net& sum) {
  const int* points = &g.points[batch.points];
  double* rows = sum.data();
  for (int l = 0; l < batch.used; ++l)
    for (int a = 0; a < batch.functions; ++a) {
      double* row = rows + 3 * static_cast<std::ptrdiff_t>(points[a * lanes + l]);
      for (int c = 0; c < 3; ++c) row[c] += f[3 * a + c][l];
    }
}

// The degree and the order are template arguments where they are usual, 0 where they are known at run time only.
template <int Degree, int Order>
struct Rule {
  static constexpr int max_p = Degree ? Degree : max_degree, max_q = Order ? Order : max_order;
  const int p, q;
  const double *value, *slope, *bend;
  explicit Rule(const Group& g)
      : p(Degree ? Degree : g.degree), q(Order ? Order : g.order), value(g.value.data()), slope(g.slope.data()), bend(g.bend.data()) {}

  // a = (B_s' B_t, B_s B_t') applied to Bezier points, s first
  void evaluate(const Pack* bezier, Pack* a) const {
    Pack along[max_p + 1][max_q][6];  // s-derivative and value on each row j
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Pack sum[6] = {};
        for (int i = 0; i <= p; ++i)
          for (int c = 0; c < 3; ++c) {
            const Pack& x = bezier[3 * ((p + 1) * j + i) + c];
            sum[c] += slope[k * (p + 1) + i] * x;
            sum[3 + c] += value[k * (p + 1) + i] * x;
          }
        for (int c = 0; c < 6; ++c) along[j][k][c] = sum[c];
      }
    for (int l = 0; l < q; ++l)
      for (int k = 0; k < q; ++k) {
        Pack sum[6] = {};
        for (int j = 0; j <= p; ++j)
          for (int c = 0; c < 3; ++c) {
            sum[c] += value[l * (p + 1) + j] * along[j][k][c];
            sum[3 + c] += slope[l * (p + 1) + j] * along[j][k][3 + c];
          }
        for (int c = 0; c < 6; ++c) a[6 * (l * q + k) + c] = sum[c];
      }
  }

  void transpose(const Pack* f, Pack* bezier) const {
    Pack along[max_p + 1][max_q][6];
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Pack sum[6] = {};
        for (int l = 0; l < q; ++l)
          for (int c = 0; c < 3; ++c) {
            sum[c] += value[l * (p + 1) + j] * f[6 * (l * q + k) + c];
            sum[3 + c] += slope[l * (p + 1) + j] * f[6 * (l * q + k) + 3 + c];
          }
        for (int c = 0; c < 6; ++c) along[j][k][c] = sum[c];
      }
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        Pack sum[3] = {};
        for (int k = 0; k < q; ++k)
          for (int c = 0; c < 3; ++c) sum[c] += slope[k * (p + 1) + i] * along[j][k][c] + value[k * (p + 1) + i] * along[j][k][3 + c];
        for (int c = 0; c < 3; ++c) bezier[3 * ((p + 1) * j + i) + c] = sum[c];
      }
  }

  // The same for (B_s' B_t, B_s B_t', B_s'' B_t, B_s' B_t', B_s B_t'').
  void evaluate_jets(const Pack* bezier, Pack* jet) const {
    Pack along[max_p + 1][max_q][9];  // value, slope, bend on each row j
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Pack sum[9] = {};
        for (int i = 0; i <= p; ++i)
          for (int c = 0; c < 3; ++c) {
            const Pack& x = bezier[3 * ((p + 1) * j + i) + c];
            sum[c] += value[k * (p + 1) + i] * x;
            sum[3 + c] += slope[k * (p + 1) + i] * x;
            sum[6 + c] += bend[k * (p + 1) + i] * x;
          }
        for (int c = 0; c < 9; ++c) along[j][k][c] = sum[c];
      }
    for (int l = 0; l < q; ++l)
      for (int k = 0; k < q; ++k) {
        Pack sum[15] = {};
        for (int j = 0; j <= p; ++j) {
          const double v = value[l * (p + 1) + j], d = slope[l * (p + 1) + j], dd = bend[l * (p + 1) + j];
          for (int c = 0; c < 3; ++c) {
            sum[c] += v * along[j][k][3 + c];
            sum[3 + c] += d * along[j][k][c];
            sum[6 + c] += v * along[j][k][6 + c];
            sum[9 + c] += d * along[j][k][3 + c];
            sum[12 + c] += dd * along[j][k][c];
          }
        }
        for (int c = 0; c < 15; ++c) jet[15 * (l * q + k) + c] = sum[c];
      }
  }

  void transpose_jets(const Pack* f, Pack* bezier) const {
    Pack along[max_p + 1][max_q][9];
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Pack sum[9] = {};
        for (int l = 0; l < q; ++l) {
          const double v = value[l * (p + 1) + j], d = slope[l * (p + 1) + j], dd = bend[l * (p + 1) + j];
          const Pack* at = f + 15 * (l * q + k);
          for (int c = 0; c < 3; ++c) {
            sum[c] += d * at[3 + c] + dd * at[12 + c];
            sum[3 + c] += v * at[c] + d * at[9 + c];
            sum[6 + c] += v * at[6 + c];
          }
        }
        for (int c = 0; c < 9; ++c) along[j][k][c] = sum[c];
      }
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        Pack sum[3] = {};
        for (int k = 0; k < q; ++k)
          for (int c = 0; c < 3; ++c)
            sum[c] += value[k * (p + 1) + i] * along[j][k][c] + slope[k * (p + 1) + i] * along[j][k][3 + c] +
                      bend[k * (p + 1) + i] * along[j][k][6 + c];
        for (int c = 0; c < 3; ++c) bezier[3 * ((p + 1) * j + i) + c] = sum[c];
      }
  }
};

template <class Use>
void with_rule(const Group& g, const Use& use) {
  if (g.degree == 3 && g.order == 4) return use(Rule<3, 4>(g));
  if (g.degree == 3 && g.order == 3) return use(Rule<3, 3>(g));
  if (g.degree == 4 && g.order == 5) return use(Rule<4, 5>(g));
  if (g.degree == 4 && g.order == 4) return use(Rule<4, 4>(g));
  use(Rule<0, 0>(g));
}

void to_bezier(const Group& group, const Batch& batch, const Net& net, Pack* bezier) {
  Pack x[3 * max_functions];
  gather(group, batch, net, x);
  const Pack* extraction = &group.extraction[batch.extraction];
  const int n_b = group.n_bernstein();
  int b = 0;
  for (; b + 4 <= n_b; b += 4) extract_columns<4>(extraction, x, batch.functions, n_b, b, bezier);
  for (; b < n_b; ++b) extract_columns<1>(extraction, x, batch.functions, n_b, b, bezier);
}

void add_from_bezier(const Group& group, const Batch& batch, const Pack* bezier, Net& sum) {
  Pack f[3 * max_functions];
  const Pack* extraction = &group.extraction[batch.extraction];
  const int n_b = group.n_bernstein();
  int a = 0;
  for (; a + 4 <= batch.functions; a += 4) extract_rows<4>(extraction, bezier, n_b, a, f);
  for (; a < batch.functions; ++a) extract_rows<1>(extraction, bezier, n_b, a, f);
  scatter(group, batch, f, sum);
}

}  // namespace

void tangents(const Group& group, const Batch& batch, const Net& net, Pack* a) {
  Pack bezier[3 * max_bernstein];
  to_bezier(group, batch, net, bezier);
  with_rule(group, [&](const auto& rule) { rule.evaluate(bezier, a); });
}

void add_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum) {
  Pack bezier[3 * max_bernstein];
  with_rule(group, [&](const auto& rule) { rule.transpose(p, bezier); });
  add_from_bezier(group, batch, bezier, sum);
}

void jets(const Group& group, const Batch& batch, const Net& net, Pack* j) {
  Pack bezier[3 * max_bernstein];
  to_bezier(group, batch, net, bezier);
  with_rule(group, [&](const auto& rule) { rule.evaluate_jets(bezier, j); });
}

void add_jet_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum) {
  Pack bezier[3 * max_bernstein];
  with_rule(group, [&](const auto& rule) { rule.transpose_jets(p, bezier); });
  add_from_bezier(group, batch, bezier, sum);
}

}  // namespace tanktread::membrane
