#include <algorithm>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/table.hpp"
#include "deck/words.hpp"
#include "surface/walls/outline.hpp"

namespace tanktread::surface {
namespace {

constexpr int fewest_smooth = 8, fewest_with_corners = 3;
constexpr double same_point = 1e-6;  // points are equal if their distance is below this multiple of the longest distance between consecutive points

struct Row {
  int line;
  Vec2 x;
  bool corner;
};

class File {
 public:
  File(const std::string& list, const deck::TableFile& file) : name_(list + "/outline \"" + deck::shortened(file.path, 80) + "\"") {
    for (const deck::TableRow& row : deck::read_table(file, name_, {{{"x2", "length"}, {"x3", "length"}}, {2}, "corner"}))
      rows_.push_back({row.line, Vec2(row.numbers.data()), row.marked});
    if (rows_.size() > 1 && (rows_.front().x - rows_.back().x).norm() <= same_point * longest_step()) {
      rows_.front().corner |= rows_.back().corner;
      rows_.pop_back();
    }
    check();
  }

  const std::string& name() const { return name_; }
  const std::vector<Row>& rows() const { return rows_; }

 private:
  std::string at(int line) const { return name_ + ", line " + std::to_string(line) + ": "; }

  /// Returns the largest distance between consecutive points of the file.
  double longest_step() const {
    double longest = 0;
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) longest = std::max(longest, (rows_[i + 1].x - rows_[i].x).norm());
    return longest;
  }

  void check() const {
    bool corners = false;
    for (const Row& row : rows_) corners = corners || row.corner;
    const int fewest = corners ? fewest_with_corners : fewest_smooth, n = static_cast<int>(rows_.size());
    if (n < fewest)
      throw UserError(name_ + " must hold at least " + std::to_string(fewest) + " points" + (corners ? "" : " without corners") +
                      ", but holds " + std::to_string(n) + ".");
    const double longest = longest_step();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row &one = rows_[i], &next = rows_[(i + 1) % rows_.size()];
      if ((next.x - one.x).norm() <= same_point * longest)
        throw UserError(at(std::max(one.line, next.line)) + "the point of line " + std::to_string(std::min(one.line, next.line)) +
                        " is repeated here.");
    }
    const double gap = (rows_.front().x - rows_.back().x).norm();
    const bool straight = rows_.front().corner && rows_.back().corner;
    if (gap > 3 * longest && !straight)
      throw UserError(name_ + formatted(" is open: its last point is %.4g from its first, but no two others that follow each other are more than "
                                        "%.4g apart.",
                                        gap, longest));
  }

  std::string name_;
  std::vector<Row> rows_;
};

/// Returns the spline through the n + 1 points from rows[first] on, parametrised by chord length. If `closed`, there are n points, and the curve
/// returns to the first one.
CubicCurve fit(const std::vector<Row>& rows, std::size_t first, std::size_t n, bool closed) {
  std::vector<double> breaks{0};
  std::vector<Vec2> points{rows[first].x};
  for (std::size_t i = 1; i <= n; ++i) {
    const Vec2& x = rows[(first + i) % rows.size()].x;
    breaks.push_back(breaks.back() + (x - rows[(first + i - 1) % rows.size()].x).norm());
    if (!closed || i < n) points.push_back(x);
  }
  return closed ? interpolate_closed(breaks, points) : interpolate_open(breaks, points);
}

Outline through(const File& file) {
  const auto& rows = file.rows();
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].corner) corners.push_back(i);
  std::vector<PlaneCurve> sides;
  if (corners.empty()) sides.push_back(fit(rows, 0, rows.size(), true));
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t next = k + 1 < corners.size() ? corners[k + 1] : corners[0] + rows.size();
    sides.push_back(fit(rows, corners[k], next - corners[k], false));
  }
  return Outline(std::move(sides), file.name());
}

}  // namespace

Outline outline(const TubeOptions& options) {
  if (options.section == "file") return through(File(options.list(), options.outline.value()));
  const Vec2 zero = Vec2::Zero();
  if (options.section == "circle") return Outline({Ellipse{zero, Vec2::Constant(options.radius.value())}});
  if (options.section == "ellipse") return Outline({Ellipse{zero, options.semi_axes.value()}});
  if (options.section != "rectangle") throw std::logic_error(options.list() + "/section " + options.section + " has no outline");
  const Vec2 half = options.sides.value() / 2;
  const std::array<Vec2, 4> corner{Vec2(-half[0], -half[1]), Vec2(half[0], -half[1]), Vec2(half[0], half[1]), Vec2(-half[0], half[1])};
  std::vector<PlaneCurve> sides;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 &a = corner[k], &b = corner[(k + 1) % 4];
    sides.push_back(interpolate_open({0, (b - a).norm()}, {a, b}));
  }
  return Outline(std::move(sides));
}

}  // namespace tanktread::surface
