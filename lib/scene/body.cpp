#include "scene/body.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "membrane/patch_forces.hpp"
#include "membrane/wall_repulsion.hpp"
#include "membrane/weight.hpp"
#include "membrane/whole_membrane.hpp"
#include "scene/initial_shape.hpp"
#include "scene/member.hpp"
#include "scene/plane_wall.hpp"
#include "scene/tube.hpp"
#include "spline/extraction.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread {

namespace {

std::string direction(const Vec3& v) {
  for (int c = 0; c < 3; ++c)
    if (v == Vec3::Unit(c)) return "x" + std::to_string(c + 1);
  return formatted("(%.4g, %.4g, %.4g)", v[0], v[1], v[2]);
}

}  // namespace

std::string FlowPlane::description() const {
  const std::string plane = direction(axes.row(0)) + " " + direction(axes.row(2));
  if (contains_flow) return "in the plane " + plane;
  return "in the plane of the longest and the shortest axis, because the flow is not planar; tank-treading in the plane " + plane;
}

FlowPlane plane_normal_to(Vec3 normal) {
  normal.normalize();
  for (double& component : normal)
    if (std::abs(component) < 1e-12) component = 0;  // removes round-off, so that normals along a coordinate axis are exact
  const Vec3 first = std::abs(normal[0]) < 1 - 1e-9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 a = (first - normal * normal.dot(first)).normalized();
  Vec3 b = a.cross(normal).normalized();
  Eigen::Index largest;
  b.cwiseAbs().maxCoeff(&largest);
  if (b[largest] < 0) b = -b;
  FlowPlane plane;
  plane.axes << a.transpose(), b.cross(a).transpose(), b.transpose();
  plane.axes.array() += 0.0;  // removes negative zeros
  return plane;
}

std::optional<Mat3> axes_of_shear(const Mat3& gradient) {
  constexpr double most = 1e-6;  // relative rounding error of a gradient in a deck, above which the flow is no simple shear
  const Eigen::JacobiSVD<Mat3> parts(gradient, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 along = parts.matrixU().col(0), across = parts.matrixV().col(0), sizes = parts.singularValues();
  if (!(sizes[0] > 0) || sizes[1] > most * sizes[0] || std::abs(along.dot(across)) > most) return {};
  Mat3 axes;
  axes << along.transpose(), along.cross(across).transpose(), across.transpose();
  return axes;
}

FlowPlane flow_plane(const stokes::FlowOptions& flow) {
  if (flow.type != "linear" || flow.gradient->isZero(0)) return {};
  const Mat3& l = *flow.gradient;
  // Matrix of the quadratic form |L n|^2 + |L^T n|^2 of a unit vector n, where L is the velocity gradient. The form is zero if the velocity has no
  // component along n and does not change along n.
  const Eigen::SelfAdjointEigenSolver<Mat3> varies(l.transpose() * l + l * l.transpose());
  const Vec3 values = varies.eigenvalues();
  if (values[0] < 1e-12 * values[2]) {
    FlowPlane plane = plane_normal_to(varies.eigenvectors().col(0));
    plane.of_shear = axes_of_shear(l);
    return plane;
  }
  const Vec3 vorticity = axial_vector(l);
  FlowPlane plane = vorticity.norm() > 1e-10 * l.norm() ? plane_normal_to(vorticity) : FlowPlane();
  plane.contains_flow = false;
  return plane;
}

namespace {

membrane::Law law(const membrane::Options& options, double modulus) {
  if (options.law == "Skalak") return membrane::Skalak{modulus, options.area_dilatation.value_or(1.0)};
  if (options.law == "Evans-Skalak") return membrane::EvansSkalak{modulus, options.area_dilatation.value_or(1.0)};
  if (options.law == "Mooney-Rivlin") return membrane::MooneyRivlin{modulus, options.neo_hookean_share.value()};
  if (options.law == "expression") return membrane::UserLaw{modulus, options.strain_energy()};
  if (options.fluid_interface()) return membrane::SurfaceTension{modulus};
  if (options.law == "neo-Hookean") return membrane::NeoHookean{modulus};
  throw std::logic_error("Membrane/law " + options.law + " has no class");
}

membrane::Repulsion repulsion(const surface::TubeOptions& tube, const surface::TubeWall& wall) {
  const double mouth = tube.radius.value();
  std::function<double(double)> radius = [mouth](double) { return mouth; };
  if (const auto channel = wall.channel) radius = [mouth, channel](double s) { return mouth * channel->section(s).factor[0]; };
  return {std::move(radius), *tube.repulsion, *tube.repulsion_range};
}

}  // namespace

void lay_out(const ParticleScene& particle_scene, spline::TMesh mesh, Body& body) {
  body.mesh = std::move(mesh);
  if (particle_scene.surface.polar()) {
    const spline::PolarMesh polar = particle_scene.surface.polar_mesh();
    body.space = spline::space(body.mesh, polar.poles, polar.subdivisions);
    if (particle_scene.adaptation.enabled && polar.poles == spline::PoleRule::bezier_transform)
      body.plain = std::make_shared<const spline::Space>(spline::space(body.mesh, spline::PoleRule::plain));
  } else {
    const bool g1 = particle_scene.surface.extraordinary_points == "g1";
    body.space = spline::space(body.mesh, g1 ? spline::ExtraordinaryRule::g1 : spline::ExtraordinaryRule::catmull_clark);
  }
}

bool alike(const ParticleScene& one, const ParticleScene& other) {
  const surface::ParticleShape &here = one.particle.shape, &there = other.particle.shape;
  const auto levels = [](const ParticleScene& particle_scene) { return particle_scene.adaptation.enabled ? particle_scene.adaptation.levels : 0; };
  return here.shape == there.shape && here.shape != "file" && !here.initial && !there.initial && one.surface == other.surface &&
         levels(one) == levels(other);
}

Body make_body(const ParticleScene& particle_scene) {
  Body body = make_body_of_several(particle_scene, nullptr, nullptr);
  body.wall = make_wall(particle_scene, body);
  body.symmetry = symmetry(particle_scene, body, body.initial);
  return body;
}

Body make_body_of_several(const ParticleScene& particle_scene, const Member* similar, std::shared_ptr<const stokes::DuctFlow> empty_duct) {
  Body b;
  const int levels = particle_scene.adaptation.enabled ? particle_scene.adaptation.levels : 0;
  if (similar) {
    const Body& other = *similar->body;
    b.mesh = other.mesh, b.space = other.space, b.plain = other.plain;
    b.rest = surface::placed_again(other.rest, similar->scene.particle.shape, particle_scene.particle.shape);
  } else if (const auto& imported = particle_scene.particle.shape.imported) {
    b.space = imported->space;
    b.rest = surface::imported_shape(particle_scene.particle.shape);
  } else if (particle_scene.surface.polar()) {
    const spline::PolarMesh mesh = particle_scene.surface.polar_mesh();
    lay_out(particle_scene, spline::polar(mesh.azimuthal, mesh.meridional, levels), b);
    b.rest = surface::resting_shape(b.space, mesh, particle_scene.surface.axis(), particle_scene.particle.shape);
  } else {
    lay_out(particle_scene, spline::cube(particle_scene.surface.elements_per_side.value(), levels), b);
    b.rest = surface::resting_shape(b.space, b.mesh, particle_scene.particle.shape);
  }
  const auto before = run_before(particle_scene);
  std::optional<Body> first;  // body on the mesh of the deck; set if the particle starts from an earlier run that may have adapted the mesh
  if (before && particle_scene.adaptation.enabled) {
    first = b;
    lay_out(particle_scene, stored_mesh(b.mesh, *before), b);
    b.rest = before->arrays.at(stored_rest);
  }
  b.initial = initial_shape(particle_scene, b, before ? &*before : nullptr);
  const Vec3& center = particle_scene.particle.shape.center;
  b.unstressed = b.rest;
  if (!particle_scene.particle.rigid())
    b.unstressed = membrane::unstressed(stress_free_shape(particle_scene, b, first ? *first : b), center, particle_scene.membrane.pre_inflation);
  b.duct = empty_duct ? std::move(empty_duct) : make_duct(particle_scene);
  b.flow = stokes::AmbientFlow(particle_scene.flow, particle_scene.flow.type == "duct" ? b.duct : nullptr);
  b.plane = flow_plane(particle_scene.flow);
  b.radius = particle_scene.radius();
  b.modulus = particle_scene.modulus();
  b.law = law(particle_scene.membrane, b.modulus);
  check_fit(particle_scene, b);
  if (particle_scene.wall.present) check_in_front(particle_scene, b);
  check_in_medium(particle_scene, b);
  b.symmetry = surface::Symmetry(b.space.n_points);
  const bool own = particle_scene.particle.shape.initial && particle_scene.particle.shape.initial->volume == "own";
  b.volume = surface::measures(b.space, own ? b.initial : b.rest).volume;
  return b;
}

void check_in_medium(const ParticleScene& particle_scene, const Body& body) {
  if (stokes::contains(particle_scene.domain.medium.get(), coupling::collocation_matrix(body.space) * body.initial)) return;
  throw UserError((particle_scene.name.empty() ? "The particle" : particle_scene.path()) + " is not inside the fluid of Domain/kind `" +
                  particle_scene.domain.kind + "` at the start.");
}

surface::Symmetry symmetry(const ParticleScene& particle_scene, const Body& body, const Net& x) {
  const bool channel = body.wall && body.wall->channel;
  const bool unused = particle_scene.domain.present && (channel || particle_scene.adaptation.enabled || !particle_scene.posts.empty());
  if (particle_scene.particle.rigid() || (body.wall && !channel) || unused) return surface::Symmetry(body.space.n_points);
  const Net* nets[] = {&body.unstressed, &body.rest, &x};
  const coupling::LoadList loads = make_loads(particle_scene, body, body.wall.get()).all();
  if (channel) return coupling::symmetry(particle_scene.symmetry, body.space, nets, *body.wall, loads);
  const auto medium = particle_scene.medium();
  const auto walls = particle_scene.wall.planes();  // meshed plates, if there is no medium
  return coupling::symmetry(particle_scene.symmetry, body.space, nets, body.flow, loads, medium || walls.empty() ? medium.get() : &walls.front(),
                            particle_scene.domain.cell());
}

coupling::LoadList ParticleLoads::all() const {
  coupling::LoadList all = built_in;
  all.insert(all.end(), registered.begin(), registered.end());
  return all;
}

ParticleLoads make_loads(const ParticleScene& particle_scene, const Body& body, const surface::TubeWall* wall) {
  ParticleLoads loads;
  coupling::LoadList& all = loads.built_in;
  if (wall && particle_scene.tube.repulsion)
    all.push_back(std::make_shared<membrane::WallRepulsion>(body.space, body.unstressed, repulsion(particle_scene.tube, *wall)));
  if (particle_scene.particle.rigid()) return loads;
  const membrane::Options& given = particle_scene.membrane;
  const membrane::WholeStiffness whole{given.global_area_dilatation * body.modulus, given.leaf_modulus * given.bending(body.modulus, body.radius),
                                       given.leaf_difference};
  if (whole.any()) all.push_back(std::make_shared<membrane::WholeMembrane>(body.space, body.unstressed, body.radius, whole));
  if (const Vec3 force = particle_scene.body_force(); !force.isZero(0)) all.push_back(std::make_shared<membrane::Weight>(body.space, force));
  if (!given.forces.all.empty())
    all.push_back(std::make_shared<membrane::PatchLoad>(given.forces, body.space, given.stress_free == "resting" ? body.unstressed : body.rest));
  for (const auto& part : particle_scene.loads)
    loads.registered.push_back(part.make({body.space, body.unstressed, body.rest, body.radius, body.modulus}));
  return loads;
}

stokes::Measure load_measure(const ParticleScene& particle_scene) {
  const bool reference =
      particle_scene.membrane.load == "weak" && particle_scene.membrane.load_measure == "reference" && !particle_scene.membrane.fluid_interface();
  return reference ? stokes::Measure::reference : stokes::Measure::current;
}

double global_tension(const ParticleScene& particle_scene, const Body& body, const Net& x) {
  const double modulus = particle_scene.membrane.global_area_dilatation;
  if (particle_scene.particle.rigid() || modulus == 0) return 0;
  return modulus * (surface::measures(body.space, x).area / surface::measures(body.space, body.unstressed).area - 1);
}

}  // namespace tanktread
