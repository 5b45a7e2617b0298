#pragma once
// Particles in a tube. The traction on the wall and the pressure drop are eliminated.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "membrane/options.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/medium/lattice.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

class ChannelFlow;
class Duct;
class LayerPair;
struct SharedWalls;

struct TubeParameters {
  double viscosity = 1;              ///< mu of the outer fluid
  surface::Symmetry symmetry;        ///< symmetry of the channel, the particle and all fields; Symmetry() if there is none
  bool holds_pressure_drop = false;  ///< true if the pressure drop of the duct flow is prescribed, not its flow rate
  quadrature::Options quadrature;
  membrane::DirectSolverOptions direct;
  std::shared_ptr<SharedWalls> walls;  ///< walls of the run; a straight tube uses a wall of this set. Null: the tube builds its wall
};

/// Response of the wall and the pressure drop to a load f and a velocity v on the particle, both given by control values. The response is linear in
/// (f, v):
///
///   wall      (1/mu) G_W f^D - dp c = -(1/mu) G_C f + (1 - lambda) (1 / 8 pi) int_C T v n dGamma        at the wall      (2.6)
///   pressure  Q dp = int_C [f.v_inf - (1 - lambda) f_inf.v] dGamma                                                       (2.7)
///   response  u = -(1/mu) G_W f^D + dp c                                                                at the particle  (2.5)
///
/// G_W and G_C, the single layers of the wall and of the particle, include the factor 1/(8 pi) but not 1/mu, and c is 1/mu times the integral over
/// the inlet (2.13). f^D is the disturbance of the traction on the wall, and dp is the disturbance of the pressure drop between the ends. v_inf in
/// (2.7) is the flow of the duct with any mean velocity, even if the ambient flow of the scene is another flow. f_inf is its traction on C, and Q its
/// flow rate.
///
/// Several particles are treated as one surface C. A straight wall is centred on the particle: it is fixed in a frame in which x1 is measured from
/// the particle's centroid. Operators that depend only on the wall are therefore assembled and factored once. Points of the particle are in the
/// laboratory frame; nets of the wall are in the wall's frame. Nets are replicated on all ranks. All calls except queries are collective.
///
/// If the pressure drop dp_0 of the duct flow is prescribed instead of its flow rate, dp/dp_0 times that flow is subtracted from the response. dp is
/// then the pressure drop minus the pressure drop of the empty tube at the reduced flow rate Q (1 - dp/dp_0).
///
/// A duct that repeats along x1 is represented by one period of its wall, without ends and with the kernels of one period (Layer::repeat). c is then
/// the empty duct's flow v_inf per unit pressure drop of a period. This flow vanishes on the wall, so that the response without the term dp c is the
/// response at a prescribed pressure drop. dp is the pressure drop of one period, and the response includes the effect of the particle's images on
/// the particle.
///
/// The wall of a channel is fixed in the laboratory frame, and v_inf is the flow of ChannelFlow. The contribution of v to dp then follows, without
/// f_inf, from the condition that the disturbance has zero flow rate (2.14).
///
/// The kinds of duct (surface::DuctKind), each of them open or periodic:
///
///                             straight tube                     channel
///   frame of the wall         moves with the particle           fixed
///   part of dp due to v       f_inf in (2.7)                    zero flow rate of the disturbance (2.14)
///   equation of the wall      LU factors                        LU factors, or iteration; with iteration the Jacobian omits the response
///
///                             open                              periodic
///   c                         integral over the inlet (2.13)    v_inf per unit pressure drop of a period
///   images of the particle    none                              in the kernels of one period
///
/// If an enumerator is added to DuctKind, the compiler names the switches that omit it; surface::properties() is one of them. A new kind of duct
/// also needs decisions in places that are not switches:
///
///   frame of the wall      uses of DuctProperties::fixed, because a wall that is not fixed moves along x1 with the centroid; adapt_mesh() in
///                          scene/particles/coupled_particles.cpp
///   flow v_inf             uses of DuctProperties::parallel_flow; Duct::velocity_per_pressure_drop()
///   wall                   Wall::is_for(); FlowRate
///   one pressure drop      cause(), frozen_response(); Duct; WallResidual; DuctWall (its unknown); PowerBalance::flow_power(); the pressure
///                          correction of RigidResidual and RigidTractions; FreeBodyInTube::pressure_drop()
///   checks                 checks(), cap_velocity(), points_of_caps()
///   system                 the single inlet in Wall and FlowRate
///   scene                  TubeRow in scene/tube.cpp; films() in scene/particles/gaps.cpp measures distances from the one wall
///   record                 channel.h5 in record/results.cpp
class Tube {
 public:
  Tube(const surface::TubeWall& wall, const stokes::DuctFlow& flow, const spline::Space& particle, const TubeParameters& parameters,
       Phases& phases);

  /// Constructs the tube for a channel. Its wall is the wall of `flow`.
  Tube(std::shared_ptr<const ChannelFlow> flow, const spline::Space& particle, const TubeParameters& parameters, Phases& phases);

  ~Tube();

  /// Sets the particles in the tube and their unstressed net. Required before set_shape().
  void set_particles(const Net& unstressed, std::span<const Particle> particles);

  /// Sets the particle's control net, in the laboratory frame; later calls use this shape. Does nothing if the arguments equal the arguments of the
  /// latest call. `origin`: x1 coordinate of the origin of the frame of wall() if the wall is straight; by default the x1 coordinate of the
  /// particle's centroid. In a periodic channel, by default the x1 coordinate of the period that contains the particles.
  void set_shape(const Net& x, std::optional<double> origin = {});
  void forget() { latest_shape_ = {}; }  ///< requires set_shape() before the next response, also if the shape does not change

  /// Response (2.5) of the tube to the particle: the disturbance due to the wall and the pressure drop.
  struct Response {
    Net velocity;       ///< velocity u (2.5) that wall and pressure drop cause at the particle's collocation points, shape (N, 3)
    /// control values of the density f^D. In an open duct, it is the disturbance of the traction on the wall. In a periodic duct, it lacks the
    /// traction of the flow that pressure_drop drives, pressure_drop/dp_inf times that of v_inf (2.38); in a periodic channel,
    /// ChannelFlow::wall_traction() does not give the traction of v_inf either.
    Net wall_traction;
    double pressure_drop = 0;  ///< disturbance dp of the pressure drop
    Net load, particle_velocity;  ///< load f and velocity v of the particle that cause this response; set only in a periodic duct
    Net on_wall;                  ///< velocity that f and v cause at the wall: right-hand side of (2.6)
    double caused_drop = 0;       ///< dp (2.7) of f and v, if `pressure_drop` is an unknown
  };

  /// Returns the response. An empty net is treated as zero. v is used only if lambda != 1. `pressure_correction`: collocation-error correction of dp.
  Response respond(const Net& f, const Net& v = {}, double pressure_correction = 0);

  /// Returns what f and v cause without the wall's answer: the velocity at the wall, dp (2.7) and the velocity due to images of the particle.
  Response cause(const Net& f, const Net& v, double pressure_correction = 0);
  /// Adds to the velocity of `response` the velocity due to its wall traction and its pressure drop.
  void add_answer(Response& response);

  /// Computes rows `rows` of the velocity u of a response at points on the particle. `points`: values of its basis functions there. `x`: its control
  /// points (laboratory frame). Not collective, except if the duct repeats or its pressure drop is prescribed: then every rank must call it with the
  /// same x.
  void velocity_at(const Eigen::SparseMatrix<double>& points, const Net& x, const Response& response, std::span<const int> rows, Net& u);

  /// Stores the operators of the current shape as low-precision blocks for the Jacobian.
  void freeze();
  /// Returns the response u at the particle's collocation points, computed with the operators that freeze() stored. In a periodic duct, u includes
  /// two images of particle and wall on either side; images further away would change u by 5 to 10 percent. With 4000 control points or more, it
  /// omits the images of the particle, whose operators grow like N^2. If the wall's system is solved by iteration, returns 0. The Jacobian then omits
  /// u. This is accurate enough, because the contribution of u is small and smooth.
  Net frozen_response(const Net& f, const Net& v = {});

  /// The flow v_inf of the empty duct at the particle's collocation points, with amplitude 1, and the weights of the particle's load f and velocity v
  /// in dp (2.7).
  struct InFlow {
    Net ambient;            ///< v_inf
    Net control_values;     ///< control values of v_inf by interpolation; set only if the flow is not parallel (DuctProperties::parallel_flow)
    Net per_pressure_drop;  ///< velocity c (2.5)
    Net weights_of_load, weights_of_velocity;  ///< weights of f and v in dp. Weights of v are set only if lambda != 1 and the flow is parallel
  };
  const InFlow& in_flow() const;
  double pressure_of(const Net& f) const;  ///< returns dp (2.7) due to the load f

  /// Independent checks of a response: its errors in the conditions (2.14). A response without discretisation errors satisfies them exactly.
  struct Checks {
    double flux = 0;          ///< disturbance of the flow rate through the inlet, divided by Q
    double force = 0;         ///< unbalanced axial force of the disturbance: A dp minus the axial forces on wall and particle, divided by the product
                              ///< of A, the radius and the pressure gradient of the empty duct, where A is the area of the cross-section
    double cap_velocity = 0;  ///< largest disturbance velocity on the caps, divided by the mean velocity
    double pressure_by_flux = 0, pressure_by_force = 0;  ///< pressure drops that would make `flux` or `force` zero
  };
  Checks checks(const Net& f, const Net& v, const Response& response);

  /// Returns the flow rate of the disturbance through the inlet, due to f, v and their response.
  double disturbed_flow_rate(const Net& f, const Net& v, const Response& response);

  /// Returns the smallest distance between the particle and the wall; negative if they intersect.
  double gap() const;

  /// Returns x1 of the origin of the frame of `wall()` for the particle's net x. The frame moves with the particle in a straight tube.
  double frame_origin(const Net& x) const;

  Duct& duct() const { return *duct_; }  ///< returns the duct without particles
  LayerPair& particles();                ///< returns the layers of the particle at points off it, in the frame of the wall
  const surface::TubeWall& wall() const;
  const stokes::DuctFlow& flow() const;
  const std::optional<stokes::PeriodicCell>& cell() const;  ///< lattice of a periodic duct; not set for other ducts
  surface::DuctProperties properties() const { return surface::properties(wall().kind); }
  /// Returns the number of kernel evaluations, including the assembly of the wall unless TubeParameters::walls counts it.
  stokes::Evaluations kernel_evaluations() const;

 private:
  struct ParticleData;
  double gap_to_channel_wall() const;
  double cap_velocity(const Net& f, const Net& v, const Response& response);
  void add_caused(const Net& f, const Net& v, Response& to);
  double pressure_of_velocity(const Net& v, const Net& on_wall);

  Phases& phases_;
  std::unique_ptr<Duct> duct_;
  std::unique_ptr<ParticleData> particle_;
  Net latest_shape_;                      // arguments of the latest call of set_shape(); no rows if this call threw an exception
  std::optional<double> latest_origin_;
};

}  // namespace tanktread::coupling
