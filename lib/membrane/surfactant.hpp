#pragma once
// Insoluble surfactant on a fluid interface: the load due to its tension, and its transport on a moving surface.

#include <array>
#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>

#include "base/types.hpp"
#include "membrane/field.hpp"
#include "membrane/mass.hpp"
#include "membrane/mass_solver.hpp"
#include "membrane/surfactant_options.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {

/// The concentration c of a surfactant on a moving surface x, interpolated by the shape functions N_A. The conserved quantities are m_A = int c N_A
/// dGamma. Their sum is the total mass:
///
///   dm_A/dt = int (c (v - u).grad_s N_A - D_s grad_s c.grad_s N_A) dGamma,   sum_A dm_A/dt = 0                          (3.17)
///
/// Here u is the velocity of the control points and v the velocity of the fluid; their normal components are equal. The coefficients are q_A =
/// m_A/int N_A dGamma, with the integral over the surface `initial` on the same space, so q = 1 at the start of a run with that shape. Uses no MPI.
class Surfactant : public Field {
 public:
  /// `clean_tension`: tension sigma(0) of the clean interface. `space` must outlive this object.
  Surfactant(const spline::Space& space, const Net& initial, const SurfactantOptions& options, double clean_tension, double diffusivity);

  Eigen::Index size() const override { return share_.size(); }  ///< number of coefficients: one per control point
  Eigen::VectorXd start(const Net& shape) const override { return contents(shape, Eigen::VectorXd::Ones(size())); }  ///< c = 1

  /// Throws RunFailure if the tension is not positive everywhere.
  void set_state(const Net& x, const Eigen::VectorXd& q) override;

  const Eigen::VectorXd& concentration() const { return concentration_; }  ///< control values of c

  /// Returns the load of the surfactant, in addition to the load of the clean interface: d_A = int (sigma(c) - sigma(0)) grad_s N_A dGamma (3.18),
  /// shape (N, 3).
  Net load() const override;

  Eigen::VectorXd rate(const Net& slip) const override;

  /// Returns the total mass int c dGamma over the surface. It is an area, because c is divided by the initial concentration.
  double mass(const Eigen::VectorXd& q) const { return share_.dot(q); }
  /// Returns int (f(c) - sigma(0)) dGamma, the surface free energy in addition to the energy of the clean interface. f: free energy density.  (3.21)
  double energy() const override;
  surface::Range extremes() const;  ///< smallest and largest c on the surface, to round-off

  void linearise(const Net& slip) override;
  Eigen::VectorXd value_change(const Net& dx, const Eigen::VectorXd& dq) const override;
  Net load_change(const Net& dx, const Eigen::VectorXd& dc) const override;
  Eigen::VectorXd rate_change(const Net& dx, const Eigen::VectorXd& dc, const Net& slip_change) const override;
  void freeze(const Net& x) override;
  Eigen::VectorXd solve(double shift, const Eigen::VectorXd& r) const override;  ///< includes only diffusion: solves (M + shift D K) c = m for the
                                                                                 ///< concentration c, with the contents m that have the coefficients
                                                                                 ///< r, and returns the coefficients of M c. M: mass matrix, K:
                                                                                 ///< stiffness matrix (both of the shape stored by freeze()), D:
                                                                                 ///< diffusivity
  void conserve(const Eigen::VectorXd& r, Eigen::VectorXd& dq) const override;
  Eigen::VectorXd relabelled(const Net& mesh_velocity) const override;
  Eigen::VectorXd conserved() const override { return share_; }
  surface::FieldsAt values_at() const override;  ///< returns a function for c divided by its mean
  std::vector<std::pair<int, double>> images(const surface::Image& image) const override;

  /// Computes the concentration at the Gauss points from the field `from`, and scales it so that the total mass does not change.
  Eigen::VectorXd transferred(const Field& from, const Net& x, const std::function<spline::Site(const spline::Site&)>& site) const override;

  /// Returns the coefficients q for which the concentration on the surface x has the control values c.
  Eigen::VectorXd contents(const Net& x, const Eigen::VectorXd& c) const;

 private:
  static constexpr int gauss_points = 4;  // number per direction for elements up to degree 3; equal to the number for the membrane
  /// Basis functions of an element at its n Gauss points, with the surface and the concentration there. Arrays have the layout of
  /// surfactant_kernel.hpp.
  struct ElementPoints {
    int n, functions;
    std::vector<double> value, by_s, by_t, weight;
    std::vector<double> s, t;    // derivatives of x and c with respect to the parameters s and t: four components each
    std::vector<double> metric;  // contravariant metric, then the Gauss weight times J
    std::vector<double> c;

    const double* area() const { return &metric[3 * static_cast<std::size_t>(n)]; }
    std::array<double, 2> raised(int q, double by_s, double by_t) const;
  };
  struct Point;
  template <class Use>
  void each_change(const Net& dx, const Eigen::VectorXd& dc, const Use& use) const;
  /// Adds the contributions of an element to the rows of its control points in `sums`. Each point has as many values as `sums` has columns.
  template <class Sums>
  void add_rows(std::size_t element, const double* rows, Sums& sums) const {
    constexpr int n = Sums::ColsAtCompileTime;
    for (const int a : space_.elements[element].points) sums.row(a) += Eigen::Map<const Eigen::Matrix<double, 1, n>>(rows), rows += n;
  }
  double concentration_at(const spline::Site& site) const;
  Eigen::VectorXd transport(const Net& slip, double diffusivity) const;
  Eigen::SparseMatrix<double> stiffness() const;

  const spline::Space& space_;
  surface::BezierMap bezier_;
  SurfactantOptions options_;
  double clean_tension_, diffusivity_;
  std::vector<ElementPoints> elements_;
  mutable MassMatrix mass_;
  mutable MassSolver solver_;
  Eigen::VectorXd share_, concentration_;  // share_: int N_A dGamma on the initial surface, per function A. concentration_: control values of c
  Eigen::VectorXd q_;                                     // coefficients set last
  Net x_, known_x_;                                       // x_: shape set last. known_x_: shape stored by linearise()
  std::vector<ElementPoints> known_;                      // elements_ at the linearisation
  std::vector<std::vector<double>> known_slip_;           // components of the slip at the Gauss points of each element; empty without slip
  mutable MassMatrix known_mass_;                         // mass matrix at the linearisation
  Eigen::SparseMatrix<double> frozen_mass_, frozen_stiffness_;
  // factors of M + shift D_s K, with the mass matrix M and the stiffness matrix K of the frozen shape and the diffusivity D_s
  mutable std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factors_;
  mutable double factored_spread_ = 0;
};

}  // namespace tanktread::membrane
