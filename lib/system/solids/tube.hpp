#pragma once
// Particles in a tube: the wall's traction and the pressure drop, eliminated.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "membrane/options.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/layer.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"
#include "system/ranks.hpp"
#include "system/solids/channel_flow.hpp"

namespace tanktread::coupling {

class Wall;
struct BetweenSites;

struct TubeParameters {
  double viscosity = 1;                                  ///< mu of the outer fluid
  double viscosity_ratio = 1;                            ///< lambda, of all particles, if they do not differ
  surface::Symmetry symmetry;  ///< of channel, particle and all that is asked for; of no points: none
  bool holds_pressure_drop = false;  ///< of the duct's flow, in place of its flow rate
  quadrature::Options quadrature;
  membrane::DirectSolverOptions direct;
};

/// What the wall and the pressure drop answer to a load f and a velocity v on the particle (control values, linear in both together):
///
///   wall      (1/mu) G_W f^D - dp c = -(1/mu) G_C f + (1 - lambda) (1 / 8 pi) int_C T v n dG            at the wall      (2.6)
///   pressure  Q dp = int_C [f.v_inf - (1 - lambda) f_inf.v] dG                                                           (2.7)
///   answer    u = -(1/mu) G_W f^D + dp c                                                                at the particle  (2.5)
///
/// G single layers over 8 pi, c = (1/mu) of the inlet's integral (2.13). f^D is the disturbance of the traction on the wall, dp that of the pressure
/// drop between the ends, Q the flow rate of v_inf; v_inf is the duct's flow of any mean velocity here, whatever flow the walls go along with.
///
/// Several particles are one surface here, C all of it. The wall is laid around the particle: it is fixed in a frame whose x1 is counted from the
/// particle's centroid. So what depends on the wall alone is assembled and factored once. Points of the particle are true ones everywhere; nets of
/// the wall are in the wall's frame. Nets are replicated; calls are collective but for queries.
///
/// Where the pressure drop dp_0 of the duct's flow is held, not its flow rate, the answer is less by dp/dp_0 of that flow; dp is what the particle
/// adds to the empty tube of the flow rate that is left, Q (1 - dp/dp_0).
///
/// A duct that repeats along x1 has one period of its wall, no ends, and the kernels of one period (Layer::repeat). c is the empty duct's flow v_inf
/// per unit pressure drop of a period, which vanishes on the wall, so that the answer without it is that of a held pressure drop; dp is that of one
/// period, and the answer contains what the images of the particle do to it.
///
/// The wall of a channel stays where it is, v_inf is that of ChannelFlow, and what v does to dp follows from the flow rate of the disturbance (2.14),
/// which vanishes, in place of f_inf.
class Tube {
 public:
  Tube(const surface::TubeWall& wall, const stokes::DuctFlow& flow, const spline::Space& particle, const TubeParameters& parameters,
       Phases& phases);

  /// A channel, with the wall that its flow came from.
  Tube(std::shared_ptr<const ChannelFlow> flow, const spline::Space& particle, const TubeParameters& parameters, Phases& phases);

  /// The same tube around another mesh of the particle: nothing of the wall is made again.
  Tube(const Tube& tube, const spline::Space& particle);
  ~Tube();

  /// Sets the unstressed particles, and what loads are measured on, as Layer::set_reference.
  void set_reference(const Net& unstressed, stokes::Measure measure = stokes::Measure::reference, std::vector<bool> present = {});

  /// 1 - lambda of the particle that each control point is of, -1 of a rigid body, whose `v` is w of (2.23): where there are several.
  void set_contrasts(const Eigen::VectorXd& contrasts);

  /// Takes the particle's control net, in true places; what follows belongs to this shape. `centroid`: where the frame of a straight wall has its
  /// origin along x1; none: the particle's centroid.
  void place(const Net& x, std::optional<double> centroid = {});

  /// The lattice of a duct that repeats.
  const std::optional<stokes::PeriodicCell>& cell() const;

  struct Response {
    Net velocity;       ///< u at the particle's collocation points, shape (N, 3)
    Net wall_traction;  ///< f^D, control values on the wall
    double pressure_drop = 0;
    Net load, moves;  ///< f and v of the images in a duct that repeats, else empty
  };

  /// Either net may be empty: then it is zero. v counts for lambda != 1 only. `lacking`: what is known to lack of the pressure drop.
  Response respond(const Net& f, const Net& v = {}, double lacking = 0);

  /// Rows `rows` of the answer u of a response at the points with rows `x`, true places, on the particle or anywhere in the fluid.
  /// Not collective.
  void velocity_at(const Net& x, const Response& response, std::span<const int> rows, Net& u);

  /// Keeps the present shape's operators, as blocks of few bits, for `frozen_response`, which is the answer u at the particle's
  /// collocation points; 0 where each answer of the wall takes an iteration, for it is a small and smooth part of a Jacobian.
  void freeze();
  Net frozen_response(const Net& f, const Net& v = {});

  /// The parts of the block system, at the collocation points of wall and particle.
  Net load_on_wall(const Net& f);             ///< -(1/mu) G_C f
  Net velocity_on_wall(const Net& v);         ///< (1 - lambda) (1 / 8 pi) int T v n
  Net wall_on_particle(const Net& traction);  ///< -(1/mu) G_W f^D
  Net wall_on_wall(const Net& traction);      ///< (1/mu) G_W f^D
  Net images_on_particle(const Net& f, const Net& v = {});  ///< what the particle's images in a duct that repeats do
  const Net& inlet_on_particle() const;       ///< c; in a duct that repeats the empty duct's flow per unit pressure drop of a period
  const Net& ambient() const;                 ///< v_inf at the collocation points, of the amplitude 1
  Net inlet_on_wall() const;
  double pressure_of(const Net& f, const Net& v = {});  ///< dp (2.7)

  /// What `pressure_of` a force density f lacks, where `flow` is a duct's: `work`, the residual work of the density that has v_inf on the surface,
  /// and in a channel of v_inf at the places what is left where it is interpolated (2.41).
  double lacking_pressure(const BetweenSites& between, const Net& at_places, double amplitude, const Net& f, double work);
  Net solve_wall(const Net& rhs);                       ///< f^D of (1/mu) G_W f^D = rhs, by the factors

  /// Independent routes to what a response satisfies, and how far off they are.
  struct Checks {
    double flux = 0;                                     ///< disturbance of the flow rate through the inlet, over Q
    double force = 0;                                    ///< A dp less the axial forces on wall and particle, over the duct's own A G R_T
    double cap_velocity = 0;                             ///< largest disturbance velocity left on the caps, over the mean velocity
    double pressure_by_flux = 0, pressure_by_force = 0;  ///< the pressure drop with which flux or force would vanish
  };
  Checks checks(const Net& f, const Net& v, const Response& response);

  /// What a load f leaves over where nothing should move or flow: int N_A u dG of the velocity on the wall between its collocation points, and the
  /// flow rate through the inlet.
  struct Leak {
    Net velocity;
    double flow = 0;
  };
  Leak leak(const Net& f);

  /// What it takes from the work of another load that wall and pressure drop answer so (2.42).
  double work(const Leak& leak, const Response& of) const;

  /// Flow rate where the particle adds this pressure drop: Q, or what is left of it.
  double flow_rate(double pressure_drop) const { return flow_->flow_rate() * (1 - slowed(pressure_drop)); }

  /// Smallest distance of the particle's surface to the wall; negative where they cross.
  double gap() const;

  /// The particle of this net where the wall is the one of `wall()`, which goes along with it in a straight tube.
  Net in_wall_frame(Net x) const;

  /// Whether the wall stays where it is, and the way along it counts.
  bool fixed() const { return wall().channel != nullptr; }

  /// Whether these places are inside, of a channel between its ends too.
  bool inside(const Net& x, std::span<const int> rows) const;

  const surface::TubeWall& wall() const;
  void forget_recycled() const { wall_->forget_recycled(); }  ///< of the wall's iterative solver
  const stokes::DuctFlow& flow() const { return *flow_; }
  stokes::Evaluations kernel_evaluations() const;  ///< of both surfaces, the assembly of the wall included

 private:
  struct Particle;
  double viscosity() const;
  double cap_velocity(const Net& f, const Net& v, const Response& response);
  double empty_pressure_drop() const;
  double slowed(double pressure_drop) const;
  Net driven(const Net& at) const;
  Net on_particle(const Net& own) const;
  double pressure_of_velocity(const Net& v, const Net& on_wall);
  void weigh_flow();

  std::shared_ptr<const stokes::DuctFlow> flow_;
  Phases& phases_;
  std::shared_ptr<Wall> wall_;
  std::unique_ptr<Particle> particle_;
  Net flow_weights_, force_weights_;  // of the wall's traction, made when first asked for, as are all of these
  Net flow_of_wall_;                  // weights of a velocity on the wall: the flow rate through the inlet of the traction that takes it away
  double own_flow_ = 0, flow_of_pressure_ = 0;  // what the inlet's own pressure drives through it; with what the wall answers
};

}  // namespace tanktread::coupling
