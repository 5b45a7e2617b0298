#pragma once
// Branches of shapes at rest, along a parameter and around its folds.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/columns.hpp"
#include "motion/steady.hpp"

namespace tanktread::motion {

/// `Continuation/*` of the deck.
struct ContinuationOptions {
  bool present = false;              ///< whether the deck has this list
  std::string parameter;             ///< path of a key of the deck that is a number
  double to = 0;                     ///< value of the parameter at which the branch ends
  std::string method = "arclength";  ///< arclength, natural
  std::optional<double> step;        ///< of the parameter, the first; empty: a twentieth of the way
  double largest_change = 0.05;      ///< of the shape from point to point, in the norm of `Time/tolerance`
  int points = 100;                  ///< most
  double fold_tolerance = 1e-6;      ///< of the parameter at a fold, relative
  std::optional<std::string> second_parameter;      ///< path of another number, along which the first fold goes on
  std::optional<std::vector<double>> second_values;  ///< of it, one after another; the deck's own comes before them

  void declare(deck::Section& section);
};

/// A shape at rest.
struct BranchPoint {
  double parameter = 0, second = 0;
  Net x;
  bool fold = false;   ///< the parameter turns round here
  int iterations = 0;  ///< of NOX
  double rest = 0;     ///< the correction that was left

  void add_columns(bool follows_fold, Columns& to) const;
};

/// The shapes at rest that hang together, from one on to a value of the parameter, or around a fold back to the first one. With t the direction from
/// the point before last to the last one, in the norm of `Time/tolerance` and with the parameter p in units in which the first step is as long as the
/// change of the shape, the next point is where
///
///   G(x, p) = 0,   t.(x - x^, p - p^) = 0                                                                           (4.20)
///
/// (x^, p^) one step further along t (`arclength`), or where p = p^ (`natural`). Both are solved as (4.17) is, the change of p being what brings the
/// correction onto the plane; in the iteration G is linear in p, and taken anew at the p it ends with until that stays. A fold is the vertex of the
/// parabola p(arclength) through three points, which is solved for and replaces one of them until p there stays.
///
/// A fold goes on in a second parameter from one value of it to the next: expected where the two folds before point to, the values taken for evenly
/// spaced, it lies between three points that (4.20) gives at a distance before, at and after that place, t being the direction of the branch at the
/// fold before. Where nothing is found the way to the next value is halved. The mesh stays that of the first fold.
class Branch {
 public:
  /// The equations at a value of the parameter and one of the second, 0 where there is none. Collective.
  using Family = std::function<std::shared_ptr<SteadyEquations>(double parameter, double second)>;

  /// Carries shapes, the last of which is at rest at this parameter, to a mesh that fits that one better, and the family to it; whether there is one.
  /// Collective.
  using Remesh = std::function<bool(double parameter, std::vector<Net>& shapes)>;

  /// Begins with the shape that `x` leads to at `parameter`, and at `second` where the first fold is to go on in a second one.
  Branch(Family family, Remesh remesh, const ContinuationOptions& options, const SteadyOptions& steady, const coupling::SolverOptions& solvers,
         double parameter, double second, Net x);

  /// The next point, folds in between included; with a second parameter up to the first fold, then that at each of its values. None at the end.
  /// Throws RunFailure where it cannot be found. Collective.
  std::optional<BranchPoint> next();

 private:
  struct Place {
    Net x;
    double q = 0;  // the parameter in its units
    Place operator-(const Place& other) const { return {x - other.x, q - other.q}; }
    Place along(const Place& t, double ds) const { return {x + ds * t.x, q + ds * t.q}; }
  };
  struct Solved {
    Place place;
    double s = 0;  // arclength
    int iterations = 0;
    double rest = 0;
  };
  struct Fold {
    Solved at;
    Place along;  // the direction of the branch there
  };
  double inner(const Place& a, const Place& b) const;
  double length(const Place& a) const { return std::sqrt(inner(a, a)); }
  std::optional<Solved> at_parameter(double parameter, const Net& x);
  std::optional<Solved> on_plane(const Place& predicted, const Place& normal);
  std::optional<Solved> stepped();
  void begin();
  void advance();
  void keep(const Solved& solved);
  void adapt();
  std::optional<Fold> fold(std::array<Solved, 3> three);
  std::optional<Fold> fold_near(const Place& expected, const Place& along);
  bool next_fold();
  bool ends(const Solved& solved) const;
  std::optional<double> end_before(const Place& place) const;

  Family family_;
  Remesh remesh_;
  ContinuationOptions options_;
  SteadyOptions steady_;
  const coupling::SolverOptions& solvers_;
  double start_, second_, unit_ = 1;  // q = parameter/unit
  std::shared_ptr<SteadyEquations> first_;
  Net x_;
  std::vector<Solved> last_;  // up to three, the latest last
  std::vector<std::pair<Solved, bool>> ahead_;  // that next() has to give yet, by arclength, and whether each is a fold
  std::vector<Fold> folds_;       // of the second parameter, the two latest
  double last_share_ = 1;         // of the way between two values of it that lies between them
  std::size_t values_ = 0;        // of it that were reached
  std::string failure_;
  double step_ = 0;
  double heading_ = 0;  // how q changed on the last step; points found again on another mesh may have it otherwise
  int count_ = 0;
  bool ended_ = false;
};

}  // namespace tanktread::motion
