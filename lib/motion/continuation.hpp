#pragma once
// Continuation of branches of steady shapes along a parameter and around folds.

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

struct BranchPoint;

/// Options of the continuation, `Continuation/*` of the deck.
struct ContinuationOptions {
  bool present = false;              ///< true if the deck has the section Continuation
  std::string parameter;             ///< path of a numerical key of the deck
  double to = 0;                     ///< value of the parameter at which the branch ends
  std::string method = "arclength";  ///< arclength, natural
  std::optional<double> step;        ///< first step of the parameter; empty: 1/20 of the interval from its start value to `to`
  double largest_change = 0.05;      ///< largest change of shape from point to point, in the norm of `Time/tolerance`
  int points = 100;                  ///< largest number of points
  double fold_tolerance = 1e-6;      ///< relative tolerance of the parameter at a fold
  std::optional<std::string> second_parameter;      ///< path of another numerical key, along which the first fold is continued
  std::optional<std::vector<double>> second_values;  ///< values of the second parameter in sequence, after its value in the deck

  void declare(deck::Section& section);
  std::string remark(const BranchPoint& point) const;   ///< returns a warning if the error of a fold is above its tolerance, otherwise ""
  std::string text(double value, double second) const;  ///< returns the name and value of the parameter and, if set, of the second parameter
};

/// A steady shape on a branch.
struct BranchPoint {
  double parameter = 0, second = 0;
  State x;
  bool fold = false;   ///< true if the parameter reverses its direction here
  int iterations = 0;  ///< number of NOX iterations
  double rest = 0;     ///< estimated error of the shape; at a fold, relative error of the parameter, see Continuation/fold tolerance

  void add_columns(bool follows_fold, Columns& to) const;
};

/// A connected branch of steady shapes, from a start to a given value of the parameter, or around a fold and back to the start. Let t be the
/// direction from the second last point to the last one, in the norm of `Time/tolerance`. The parameter p is scaled so that it contributes as much to
/// the length of the first step as the change of shape. The next point satisfies
///
///   G(x, p) = 0,   t.(x - x^, p - p^) = 0                                                                           (4.20)
///
/// G(x, p) = 0 are the equations (4.17) of a steady shape, and (x^, p^) is the predicted point, one step further along the branch. This is the method
/// `arclength`; with `natural`, the second equation is p = p^. The two equations are solved by the method for (4.17), with G linearised in p. In each
/// iteration, p is changed such that the iterate lies on the plane of the second equation. The solution is repeated, with G linearised at the p just
/// found, until p no longer changes. A fold is the vertex of the parabola p(arclength) through three points. The point of the branch at the vertex is
/// computed, and replaces one of the three points, until the p of the vertex no longer changes.
///
/// A fold can be continued in a second parameter through a sequence of values. The fold is predicted by extrapolation from the previous two folds, as
/// if the values were evenly spaced. Equation (4.20) then gives one point at the prediction, one before and one after it, where t is the direction of
/// the branch at the previous fold. If no fold is found, the step to the next value is halved. The mesh of the first fold is kept.
class Branch {
 public:
  /// Returns the equations of steady shapes for given values of the parameter and of the second parameter. If there is no second parameter, its value
  /// is 0. Collective.
  using Family = std::function<std::shared_ptr<SteadyEquations>(double parameter, double second)>;

  /// Adapts the mesh to the last of the given shapes, which is steady at `parameter`, and transfers all shapes to the new mesh. From then on, the
  /// function Family of the branch must return equations on the new mesh. Returns false if the mesh does not change. Collective.
  using Remesh = std::function<bool(double parameter, std::vector<State>& states)>;

  /// Starts the branch at `parameter`, with the steady shape that a search from `x` finds. `second`: value of the second parameter if the first fold
  /// is continued.
  Branch(Family family, Remesh remesh, const ContinuationOptions& options, const SteadyOptions& steady, const coupling::SolverOptions& solvers,
         double parameter, double second, State x);

  /// Alternative search for the first point, called if the first search fails. x: best iterate of the failed search, replaced by the result.
  /// `failed`: report of the failed search. Returns the report of the new search. Collective.
  using Search = std::function<SteadyReport(State& x, const SteadyReport& failed)>;
  void search(Search other) { search_ = std::move(other); }

  /// Returns the next point of the branch, which may be a fold. If there is a second parameter, returns the points up to the first fold, and then the
  /// fold at each value of the second parameter. Returns nothing at the end of the branch. Throws RunFailure if the point is not found. Collective.
  std::optional<BranchPoint> next();

  /// Returns whether the largest number of points ended the branch before it reached its end.
  bool cut_short() const { return !ended_ && count_ >= options_.points; }

 private:
  struct Place {
    State x;
    double q = 0;  // scaled parameter
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
    Place along;  // direction of the branch at the fold
  };
  double inner(const Place& a, const Place& b) const;
  double length(const Place& a) const { return std::sqrt(inner(a, a)); }
  Place unit(const Place& a) const {
    const double size = length(a);
    return {a.x / size, a.q / size};
  }
  std::optional<Solved> at_parameter(double parameter, const State& x);
  std::optional<Solved> on_plane(const Place& predicted, const Place& normal, double tolerance);
  std::optional<Solved> stepped();
  Place predicted(const Place& t) const;
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
  Search search_;
  std::string why_;  // reason for which the latest search at a given parameter failed, as part of a message; empty if not known
  ContinuationOptions options_;
  SteadyOptions steady_;
  const coupling::SolverOptions& solvers_;
  double start_, second_, unit_ = 1;  // q = parameter/unit
  std::shared_ptr<SteadyEquations> first_;
  State x_;
  std::vector<Solved> last_;  // latest points of the branch, at most three, latest last
  std::vector<std::pair<Solved, bool>> ahead_;  // points still to be returned by next(), in order of arclength; the flag is true for a fold
  std::vector<Fold> folds_;       // the two latest folds, found at two values of the second parameter
  double last_share_ = 1;         // last step of the second parameter, divided by the interval between two of its given values
  std::size_t values_ = 0;        // number of given values of the second parameter that have been reached
  std::string failure_;
  // step_: length of the next step. prediction_error_: distance of the latest point from its prediction, divided by the step
  double step_ = 0, prediction_error_ = 1;
  double heading_ = 0;  // last change of the scaled parameter q along the branch; at a fold its sign changes. Not reset when the mesh changes
  int count_ = 0;
  bool ended_ = false;
};

}  // namespace tanktread::motion
