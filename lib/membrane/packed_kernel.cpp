// Evaluation of tangents at Gauss points from control points, via Bezier points and sum factorisation, and its transpose.

#include <cstring>

#include "base/kernel.hpp"
#include "membrane/packed.hpp"

namespace tanktread::membrane {
namespace INSTRUCTIONS {
namespace {

constexpr int max_bernstein = (spline::largest_degree + 1) * (spline::largest_degree + 1);

// Computes the small matrix product out[3 k + c] = sum_r x[3 r + c] e[r * across_r + k * across_k] for k = first .. first + Width - 1 and the
// components c = 0, 1, 2.
template <int Width>
void extract(const Register* e, int across_r, int across_k, const Register* x, int n_r, int first, Register* out) {
  Register sum[Width][3] = {};
  for (int r = 0; r < n_r; ++r)
    for (int k = 0; k < Width; ++k) {
      const Register& factor = e[r * across_r + (first + k) * across_k];
      for (int c = 0; c < 3; ++c) sum[k][c] += factor * x[3 * r + c];
    }
  for (int k = 0; k < Width; ++k)
    for (int c = 0; c < 3; ++c) out[3 * (first + k) + c] = sum[k][c];
}

// Computes the small matrix product out[3 k + c] = sum_r x[3 r + c] e[r * across_r + k * across_k] for k = 0 .. n_k - 1 and the components c = 0, 1,
// 2, for four values of k at a time.
void extract(const Register* e, int across_r, int across_k, const Register* x, int n_r, int n_k, Register* out) {
  int k = 0;
  for (; k + 4 <= n_k; k += 4) extract<4>(e, across_r, across_k, x, n_r, k, out);
  for (; k < n_k; ++k) extract<1>(e, across_r, across_k, x, n_r, k, out);
}

void gather(const Group& g, const Batch& batch, const Net& net, Register* x) {
  const int* points = &g.points[batch.points];
  const double* rows = net.data();
  for (int a = 0; a < batch.functions; ++a)
    for (int l = 0; l < lanes; ++l) {
      const double* row = rows + 3 * static_cast<std::ptrdiff_t>(points[a * lanes + l]);
      for (int c = 0; c < 3; ++c) x[3 * a + c][l] = row[c];
    }
}

void scatter(const Batch& batch, const Register* f, double* rows) {
  for (int l = 0; l < batch.used; ++l)
    for (int k = 0; k < 3 * batch.functions; ++k) *rows++ = f[k][l];
}

// Orders of the five derivatives x_,s x_,t x_,ss x_,st x_,tt with respect to s and with respect to t.
constexpr int times_s[] = {1, 0, 2, 1, 0}, times_t[] = {0, 1, 0, 1, 2};

// Tensor-product Gauss rule. The degree of the elements and the number of points are template arguments for the usual combinations, and 0 if they are
// known only at run time.
template <int Degree, int Order>
struct Rule {
  static constexpr int max_p = Degree ? Degree : spline::largest_degree, max_q = Order ? Order : max_order;
  const int p, q;
  const double* bernstein[3];  // values, first and second derivatives
  explicit Rule(const Group& g)
      : p(Degree ? Degree : g.degree), q(Order ? Order : g.order), bernstein{g.value.data(), g.slope.data(), g.bend.data()} {}

  // Evaluates the first n of the derivatives x_,s x_,t x_,ss x_,st x_,tt at all Gauss nodes from Bezier points. Stores component c of a derivative in
  // a[3 (n * node + derivative) + c]. Sums over the Bezier points along s first, then along t.
  template <int n>
  void evaluate(const Register* bezier, Register* a) const {
    constexpr int m = n == 2 ? 2 : 3;
    Register along[max_p + 1][max_q][m][3];  // positions and their derivatives with respect to s at node k, for row j of Bezier points
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Register sum[m][3] = {};
        for (int i = 0; i <= p; ++i)
          for (int d = 0; d < m; ++d)
            for (int c = 0; c < 3; ++c) sum[d][c] += bernstein[d][k * (p + 1) + i] * bezier[3 * ((p + 1) * j + i) + c];
        std::memcpy(along[j][k], sum, sizeof sum);
      }
    for (int l = 0; l < q; ++l)
      for (int k = 0; k < q; ++k) {
        Register sum[n][3] = {};
        for (int j = 0; j <= p; ++j)
          for (int d = 0; d < n; ++d)
            for (int c = 0; c < 3; ++c) sum[d][c] += bernstein[times_t[d]][l * (p + 1) + j] * along[j][k][times_s[d]][c];
        std::memcpy(a + 3 * n * (l * q + k), sum, sizeof sum);
      }
  }

  template <int n>
  void transpose(const Register* a, Register* bezier) const {
    constexpr int m = n == 2 ? 2 : 3;
    Register along[max_p + 1][max_q][m][3];
    for (int j = 0; j <= p; ++j)
      for (int k = 0; k < q; ++k) {
        Register sum[m][3] = {};
        for (int l = 0; l < q; ++l)
          for (int d = 0; d < n; ++d)
            for (int c = 0; c < 3; ++c) sum[times_s[d]][c] += bernstein[times_t[d]][l * (p + 1) + j] * a[3 * (n * (l * q + k) + d) + c];
        std::memcpy(along[j][k], sum, sizeof sum);
      }
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        Register sum[3] = {};
        for (int k = 0; k < q; ++k)
          for (int d = 0; d < m; ++d)
            for (int c = 0; c < 3; ++c) sum[c] += bernstein[d][k * (p + 1) + i] * along[j][k][d][c];
        std::memcpy(bezier + 3 * ((p + 1) * j + i), sum, sizeof sum);
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

template <int n>
void evaluate(const Group& group, const Batch& batch, const Net& net, Pack* a) {
  Register x[3 * spline::most_functions], bezier[3 * max_bernstein];
  gather(group, batch, net, x);
  extract(registers(&group.extraction[batch.extraction]), group.n_bernstein(), 1, x, batch.functions, group.n_bernstein(), bezier);
  with_rule(group, [&](const auto& rule) { rule.template evaluate<n>(bezier, registers(a)); });
}

template <int n>
void transpose(const Group& group, const Batch& batch, const Pack* a, double* rows) {
  Register f[3 * spline::most_functions], bezier[3 * max_bernstein];
  with_rule(group, [&](const auto& rule) { rule.template transpose<n>(registers(a), bezier); });
  extract(registers(&group.extraction[batch.extraction]), 1, group.n_bernstein(), bezier, group.n_bernstein(), batch.functions, f);
  scatter(batch, f, rows);
}

}  // namespace

void tangents(const Group& group, const Batch& batch, const Net& net, Pack* a) { evaluate<2>(group, batch, net, a); }
void transpose(const Group& group, const Batch& batch, const Pack* p, double* rows) { transpose<2>(group, batch, p, rows); }
void jets(const Group& group, const Batch& batch, const Net& net, Pack* j) { evaluate<5>(group, batch, net, j); }
void jet_transpose(const Group& group, const Batch& batch, const Pack* p, double* rows) { transpose<5>(group, batch, p, rows); }

}  // namespace INSTRUCTIONS

KERNEL(void, tangents, (const Group& group, const Batch& batch, const Net& net, Pack* a), (group, batch, net, a))
KERNEL(void, transpose, (const Group& group, const Batch& batch, const Pack* p, double* rows), (group, batch, p, rows))
KERNEL(void, jets, (const Group& group, const Batch& batch, const Net& net, Pack* j), (group, batch, net, j))
KERNEL(void, jet_transpose, (const Group& group, const Batch& batch, const Pack* p, double* rows), (group, batch, p, rows))

}  // namespace tanktread::membrane
