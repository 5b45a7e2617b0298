#pragma once
// Estimated errors of a series (a quantity as a function of time) from its differences between successive levels of refinement.

#include <string>
#include <vector>

namespace tanktread::accuracy {

/// Estimated error of a series on the finest level l. Let E_l be the expected error of level l up to a factor C that depends on the series. The
/// difference d_l between the levels l and l - 1 is then about C (E_(l-1) - E_l), and the error of the finest level is
///
///   e_l = C_l E_l,   C_l = d_l/(E_(l-1) - E_l)                                                                      (9.1)
///
/// Two alternatives are less accurate: the largest or the mean C of several levels in place of C_l; and e_l = d_l/(r - 1) with a ratio r fitted to
/// the differences, because a difference that is small by chance is taken for fast convergence.
struct Estimate {
  double error = 0;       ///< estimated error of the finest level; NaN if it cannot be estimated
  /// observed ratio of the errors of the last two levels, (C_(l-1) E_(l-1))/(C_l E_l) with C and E of (9.1); NaN if it is unknown
  double ratio = 0;
  std::string untrusted;  ///< reason for which the estimate cannot be trusted; empty if it can
  bool trusted() const { return untrusted.empty(); }
};

/// Safety factor: a request is met if the estimated error times this factor is at most the requested error.
constexpr double margin = 1.5;

/// Differences below this number times the magnitude of a series (`scale` of estimated()) count as round-off.
constexpr double round_off = 1e-10;

/// Smallest and largest `Estimate::ratio` with which an estimate is trusted.
constexpr double least_ratio = 1.5, most_ratio = 10;

/// Returns the error (9.1) at a level with the expected error `at`. `difference`: difference between two levels with the expected errors `coarse` and
/// `fine`.
inline double predicted_error(double difference, double coarse, double fine, double at) { return difference / (coarse - fine) * at; }

/// Returns the estimated error (9.1). `differences`: differences between all pairs of successive levels, coarse to fine. `expected`: expected error
/// E_l of each level up to a common factor; it has one entry more than `differences`. `scale`: magnitude of the values; differences below `round_off`
/// times `scale` count as round-off.
Estimate estimated(const std::vector<double>& differences, double scale, const std::vector<double>& expected);

/// A quantity as a function of time, or of another abscissa. Abscissas ascend.
struct Curve {
  std::vector<double> at, values;
};

/// Returns |a - b| at the abscissas that both curves have, up to 1e-9 of the largest abscissa. In two cases, returns |a - b| at all abscissas of `a`
/// within the range of `b` instead, where b is interpolated by cubics: if the common abscissas are fewer than 5 although both curves have more
/// points, or if the values of `a` there cover less than half of the range of all its values. The result is NaN where a or b is NaN.
/// `period`: period of the values if they are angles, otherwise 0; the difference is then at most half a period.
Curve difference(const Curve& a, const Curve& b, double period = 0);

/// Returns the largest value that is not NaN; NaN if there is none.
double largest(const std::vector<double>& values);

/// Time average of a curve, and the error of its quadrature.
struct Average {
  double value, error;
};

/// Returns the time average of a curve over its parts without NaN, or its value if it has one point. The curve is interpolated by cubics through the
/// four nearest points. The error is estimated from every second and every fourth point. Differences between levels do not contain this error where
/// the interval of snapshots limits the steps, because all levels then have the same points.
Average average(const Curve& curve);

/// Returns the standard error of the time average, from the averages over eight parts of equal length, which are assumed to be independent; NaN if
/// the curve has fewer than 32 points.
double statistical_error(const Curve& curve);

/// Returns an upper envelope of a curve at the abscissas `at`: at each abscissa, the largest value of the two nearest points of the curve on each
/// side. A difference between two levels that crosses zero at an abscissa is therefore not mistaken for a zero error. NaN values are skipped.
std::vector<double> envelope(const Curve& curve, const std::vector<double>& at);

}  // namespace tanktread::accuracy
