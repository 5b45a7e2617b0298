#include "surface/spline_lines.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/LU>
#include <unsupported/Eigen/KroneckerProduct>

#include "spline/bernstein.hpp"

namespace tanktread::surface {

void Line::add_site(double u, const std::vector<double>& knots, int first, bool closed) {
  const int m = static_cast<int>(knots.size()) - 1;
  const double tiny = 1e-9 * (knots[m] - knots[0]);
  std::vector<std::pair<int, double>> at;
  int piece = first;
  for (int e = 0; e < m; ++e) {
    if (knots[e] == knots[e + 1]) continue;
    if (u > knots[e] - tiny && u < knots[e + 1] + tiny) at.emplace_back(piece, std::clamp((u - knots[e]) / (knots[e + 1] - knots[e]), 0., 1.));
    ++piece;
  }
  if (closed && std::abs(u - knots[0]) <= tiny) at.emplace_back(first + m - 1, 1.);
  for (auto& [e, s] : at)
    for (const double end : {0., 1.})
      if (std::abs(s - end) < 1e-9) s = end;
  sites.push_back(std::move(at));
}

namespace {

/// Adds the m intervals between knots to the line as pieces, each with four B-splines. `extended`: the knots, with three more at each end. The
/// B-spline whose first knot is extended[j] is function number(j) of the line.
template <class Number>
void add_pieces(Line& line, const std::vector<double>& extended, int m, const Number& number) {
  for (int e = 0; e < m; ++e) {
    if (extended[e + 3] == extended[e + 4]) continue;
    Line::Piece piece;
    for (int a = 0; a < 4; ++a) {
      std::array<double, 5> k;
      std::copy_n(extended.begin() + e + a, 5, k.begin());
      const std::array<double, 4> values = spline::b_spline_on(k, extended[e + 3], extended[e + 4]);
      for (int b = 0; b < 4; ++b) piece.extraction(a, b) = values[b];
      piece.functions[a] = number(e + a);
    }
    line.pieces.push_back(piece);
  }
}

}  // namespace

void add(Line& line, const std::vector<double>& knots, bool closed, bool inwards) {
  const int m = static_cast<int>(knots.size()) - 1, n = closed ? m : m + 3, first = static_cast<int>(line.pieces.size()), offset = line.n;
  const double period = knots[m] - knots[0];
  std::vector<double> extended, greville;
  for (int k = -3; k <= m + 3; ++k)
    extended.push_back(closed ? knots[(k + m) % m] + period * std::floor(static_cast<double>(k) / m) : knots[std::clamp(k, 0, m)]);
  add_pieces(line, extended, m, [&](int j) { return offset + (closed ? (j - 1 + m) % m : j); });
  for (int i = closed ? 1 : 0; i < n + closed; ++i) {
    const double u = (extended[i + 1] + extended[i + 2] + extended[i + 3]) / 3;
    greville.push_back(closed && u < knots[0] - 1e-9 * period ? u + period : u);
  }
  if (inwards) {
    greville[0] = (greville[0] + greville[1]) / 2;
    greville[n - 1] = (greville[n - 1] + greville[n - 2]) / 2;
  }
  for (const double u : greville) line.add_site(u, knots, first, closed);
  line.n += n;
}

RepeatingLine repeating(const std::vector<double>& knots, const std::array<double, 2>& ends) {
  const double period = ends[1] - ends[0];
  std::vector<double> all{ends[0]}, cycle = knots;
  all.insert(all.end(), knots.begin(), knots.end());
  all.push_back(ends[1]), cycle.push_back(knots.front() + period);
  RepeatingLine line;
  Line closed, &open = line.open;
  add(open, all, false, false);
  add(closed, cycle, true, false);
  open.sites.clear();
  for (int i = 0; i < closed.n; ++i) {  // computes the Greville points as add() does
    const auto knot = [&](int k) { return cycle[static_cast<std::size_t>((k + closed.n) % closed.n)] + period * std::floor(1. * k / closed.n); };
    const double u = (knot(i - 1) + knot(i) + knot(i + 1)) / 3;
    open.add_site(u < ends[0] ? u + period : u >= ends[1] ? u - period : u, all, 0, false);
  }
  const int last = static_cast<int>(closed.pieces.size()) - 1;
  const double seam = (ends[1] - knots.back()) / (cycle.back() - knots.back());  // fraction of the periodic element at the seam that lies before the
                                                                                 // seam ends[1]
  line.open_from_periodic = Eigen::MatrixXd::Zero(open.n, closed.n);
  for (int piece = 0; piece <= last + 1; ++piece) {
    const bool first_part = piece == last + 1;  // true for the last piece of `open`: the part of the last periodic element before the seam
    const Line::Piece& here = open.pieces[static_cast<std::size_t>(piece)];
    const Line::Piece& there = closed.pieces[static_cast<std::size_t>(piece == 0 ? last : piece - 1)];
    const Eigen::Matrix4d values = there.extraction * spline::restriction(3, piece == 0 ? seam : 0, first_part ? seam : 1).transpose();
    const Eigen::Matrix4d part = here.extraction.transpose().inverse() * values.transpose();
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) line.open_from_periodic(here.functions[a], there.functions[b]) = part(a, b);
    if (!first_part) line.middles.push_back(piece == 0 ? (0.5 - seam) / (1 - seam) : 0.5);
  }
  return line;
}

std::vector<std::vector<spline::Site>> sites_of(const Line& along, const Line& around) {
  std::vector<std::vector<spline::Site>> all;
  for (const auto& in_s : along.sites)
    for (const auto& in_t : around.sites) {
      std::vector<spline::Site>& sites = all.emplace_back();
      for (const auto& [i, s] : in_s)
        for (const auto& [k, t] : in_t) sites.push_back({i * static_cast<int>(around.pieces.size()) + k, s, t});
    }
  return all;
}

Eigen::SparseMatrix<double> kronecker(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Eigen::kroneckerProduct(Eigen::SparseMatrix<double>(a.sparseView(1, 1e-15)), Eigen::SparseMatrix<double>(b.sparseView(1, 1e-15)));
}

spline::Space product(const Line& along, const Line& around) {
  spline::Space space;
  space.n_points = along.n * around.n;
  const int m = static_cast<int>(around.pieces.size());
  for (std::size_t i = 0; i < along.pieces.size(); ++i)
    for (int k = 0; k < m; ++k) {
      const Line::Piece &s = along.pieces[i], &t = around.pieces[k];
      spline::Element element;
      element.origin = {static_cast<double>(i), static_cast<double>(k)};
      for (int b = 0; b < 4; ++b)
        for (int a = 0; a < 4; ++a) element.points.push_back(s.functions[a] * around.n + t.functions[b]);
      element.extraction = std::make_shared<const Eigen::MatrixXd>(Eigen::kroneckerProduct(t.extraction, s.extraction));
      space.elements.push_back(std::move(element));
    }
  space.collocation = sites_of(along, around);
  spline::share_extraction(std::array{&space});
  return space;
}

}  // namespace tanktread::surface
