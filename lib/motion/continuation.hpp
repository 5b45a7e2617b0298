#pragma once
// Branches of shapes at rest, along a parameter and around its folds.

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

  void declare(deck::Section& section);
};

/// A shape at rest.
struct BranchPoint {
  double parameter = 0;
  Net x;
  bool fold = false;   ///< the parameter turns round here
  int iterations = 0;  ///< of NOX
  double rest = 0;     ///< the correction that was left
};

/// The shapes at rest that hang together, from one on. With t the direction from the point before last to the last one, in the norm of
/// `Time/tolerance` and with the parameter p in units in which the first step is as long as the change of the shape, the next point is where
///
///   G(x, p) = 0,   t.(x - x^, p - p^) = 0                                                                           (4.20)
///
/// (x^, p^) one step further along t (`arclength`), or where p = p^ (`natural`). Both are solved as (4.17) is, the change of p being what brings the
/// correction onto the plane; in the iteration G is linear in p, and taken anew at the p it ends with until that stays. A fold is the vertex of the
/// parabola p(arclength) through three points, which is solved for and replaces one of them until p there stays.
class Branch {
 public:
  /// The equations at a value of the parameter. Collective.
  using Family = std::function<std::shared_ptr<SteadyEquations>(double parameter)>;

  /// Carries shapes, the last of which is at rest at this parameter, to a mesh that fits that one better, and the family to it; whether there is one.
  /// Collective.
  using Remesh = std::function<bool(double parameter, std::vector<Net>& shapes)>;

  /// Begins with the shape that `x` leads to at `parameter`.
  Branch(Family family, Remesh remesh, const ContinuationOptions& options, const SteadyOptions& steady, const coupling::SolverOptions& solvers,
         double parameter, Net x);

  /// The next point, folds in between included; none at the end of the branch. Throws RunFailure where it cannot be found. Collective.
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
  double inner(const Place& a, const Place& b) const;
  double length(const Place& a) const { return std::sqrt(inner(a, a)); }
  std::optional<Solved> at_parameter(double parameter, const Net& x);
  std::optional<Solved> on_plane(const Place& predicted, const Place& normal);
  std::optional<Solved> stepped();
  void begin();
  void advance();
  void keep(const Solved& solved);
  void adapt();
  bool turned(const Solved& next) const;
  Solved fold(Solved next);
  bool ends(const Solved& solved) const;

  Family family_;
  Remesh remesh_;
  ContinuationOptions options_;
  SteadyOptions steady_;
  const coupling::SolverOptions& solvers_;
  double start_, unit_ = 1;  // q = parameter/unit
  std::shared_ptr<SteadyEquations> first_;
  Net x_;
  std::vector<Solved> last_;  // up to three, the latest last
  std::vector<std::pair<Solved, bool>> ahead_;  // that next() has to give yet, by arclength, and whether each is a fold
  std::string failure_;
  double step_ = 0;
  int count_ = 0;
  bool ended_ = false;
};

}  // namespace tanktread::motion
