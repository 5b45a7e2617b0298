#pragma once
// Estimated errors of a series (a quantity as a function of time) from its differences between successive levels of refinement.

#include <array>
#include <string>
#include <vector>

namespace tanktread::accuracy {

/// Estimated error of a series on the finest level l. Let E_l be the expected error of level l up to a factor C that depends on the series. The
/// largest difference d_l between the levels l and l - 1 is then about C (E_(l-1) - E_l), and the error of the finest level is
///
///   e_l = C_l E_l,   C_l = d_l/(E_(l-1) - E_l)                                                                      (9.1)
///
/// A second estimate e'_l allows errors of two orders, a E_l + b E_l^q, whose signs may differ (two_order_error()). The estimated error is
///
///   e = 0.7 (e_l e'_l)^(1/2),   with e'_l limited to e_l/10 ... 3 e_l                                              (9.2)
///
/// Errors of coarse meshes often fall faster than E_l, because their parts of higher order have not died out. e_l is then too large, and e'_l is less
/// so. The mean of both scatters less about the true error than either. The factor makes the median of estimated divided by true error about 1.
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

/// A quantity as a function of time, or of another abscissa. Abscissas ascend.
struct Curve {
  std::vector<double> at, values;
};

/// Returns the estimated error (9.2). `changes`: differences between all pairs of successive levels, coarse to fine, each the finer level minus the
/// coarser one. `expected`: expected error E_l of each level up to a common factor; it has one entry more than `changes`. `scale`: magnitude of the
/// values; differences below `round_off` times `scale` count as round-off.
Estimate estimated(const std::vector<Curve>& changes, double scale, const std::vector<double>& expected);

/// Returns the same estimate from the largest differences only, without their signs: (9.1).
Estimate estimated(const std::vector<double>& differences, double scale, const std::vector<double>& expected);

/// Returns e' of (9.2): the largest |a E + b E^q| on the finest of three levels with the expected errors `expected`, coarse to fine. a and b follow,
/// at each abscissa of `last`, from the change between the two coarser levels, `before`, and that between the two finer levels, `last`. NaN if
/// `before` has no value at these abscissas.
double two_order_error(const Curve& before, const Curve& last, const std::array<double, 3>& expected);

/// Returns a - b at the abscissas that both curves have, up to 1e-9 of the largest abscissa. In two cases, returns a - b at all abscissas of `a`
/// within the range of `b` instead, where b is interpolated by cubics: if the common abscissas are fewer than 5 although both curves have more
/// points, or if the values of `a` there cover less than half of the range of all its values. The result is NaN where a or b is NaN.
/// `period`: period of the values if they are angles, otherwise 0; the magnitude of the difference is then at most half a period.
Curve difference(const Curve& a, const Curve& b, double period = 0);

/// Returns the largest magnitude of the values that are not NaN; NaN if there are none.
double largest(const std::vector<double>& values);

/// Returns the largest magnitude of each curve.
std::vector<double> norms(const std::vector<Curve>& curves);

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

/// Returns an upper envelope of |curve| at the abscissas `at`: at each abscissa, the largest magnitude of the two nearest points of the curve on each
/// side. A difference between two levels that crosses zero at an abscissa is therefore not mistaken for a zero error. NaN values are skipped.
std::vector<double> envelope(const Curve& curve, const std::vector<double>& at);

}  // namespace tanktread::accuracy
