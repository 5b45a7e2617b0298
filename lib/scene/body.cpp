#include "scene/body.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "base/errors.hpp"
#include "membrane/patch_forces.hpp"
#include "membrane/wall_repulsion.hpp"
#include "membrane/weight.hpp"
#include "membrane/whole_membrane.hpp"
#include "scene/initial_shape.hpp"
#include "scene/member.hpp"
#include "scene/plane_wall.hpp"
#include "scene/room.hpp"
#include "scene/tube.hpp"
#include "spline/extraction.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread {

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
  std::function<double(double)> radius;
  switch (wall.kind) {
    case surface::DuctKind::straight_tube: radius = [mouth](double) { return mouth; }; break;
    case surface::DuctKind::channel:
      radius = [mouth, channel = wall.channel](double s) { return mouth * channel->section(s).factor[0]; };
      break;
  }
  return {std::move(radius), *tube.repulsion, *tube.repulsion_range};
}

}  // namespace

void lay_out(const ParticleScene& particle_scene, spline::TMesh mesh, Body& body) {
  body.mesh = std::move(mesh);
  if (particle_scene.surface.polar()) {
    const spline::PolarMesh polar = particle_scene.surface.polar_mesh();
    body.space = spline::space(body.mesh, polar.poles, polar.subdivisions);
    if (particle_scene.adaptation.enabled && spline::properties(polar.poles).replaces_elements)
      body.plain = std::make_shared<const spline::Space>(spline::space(body.mesh, spline::PoleRule::plain));
  } else {
    body.space = spline::space(body.mesh, particle_scene.surface.extraordinary_points.value());
  }
}

bool alike(const ParticleScene& one, const ParticleScene& other) {
  const surface::ParticleShape &here = one.particle.shape, &there = other.particle.shape;
  const auto levels = [](const ParticleScene& particle_scene) { return particle_scene.adaptation.enabled ? particle_scene.adaptation.levels : 0; };
  return surface::is_linear_image(here, there) && !here.initial && !there.initial && one.surface == other.surface && levels(one) == levels(other);
}

Body make_body(const ParticleScene& particle_scene) {
  Body body = make_body_of_several(particle_scene, nullptr, nullptr);
  body.wall = make_wall(particle_scene, body);
  body.symmetry = symmetry(particle_scene, body, body.initial);
  return body;
}

namespace {

/// Returns the body of make_body_of_several() without checks of its place.
Body body_anywhere(const ParticleScene& particle_scene, const Member* similar, std::shared_ptr<const stokes::DuctFlow> empty_duct) {
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
  b.symmetry = surface::Symmetry(b.space.n_points);
  const bool own = particle_scene.particle.shape.initial && particle_scene.particle.shape.initial->volume == "own";
  b.volume = surface::measures(b.space, own ? b.initial : b.rest).volume;
  return b;
}

/// Throws NoRoom if the body does not start inside of the fluid, at the smallest distance from walls that is allowed.
void check_place(const ParticleScene& particle_scene, const Body& body) {
  check_fit(particle_scene, body);
  if (particle_scene.wall.present) check_in_front(particle_scene, body);
  check_in_medium(particle_scene, body);
}

}  // namespace

Body make_body_of_several(const ParticleScene& particle_scene, const Member* similar, std::shared_ptr<const stokes::DuctFlow> empty_duct) {
  Body body = body_anywhere(particle_scene, similar, std::move(empty_duct));
  check_room([&](int factor) {
    if (factor == 1) return check_place(particle_scene, body);
    ParticleScene finer = particle_scene;
    refine(finer, factor);
    check_place(finer, body_anywhere(finer, nullptr, body.duct));
  });
  return body;
}

void check_in_medium(const ParticleScene& particle_scene, const Body& body) {
  if (stokes::contains(particle_scene.domain.medium.get(), coupling::collocation_matrix(body.space) * body.initial)) return;
  throw NoRoom((particle_scene.name.empty() ? "The particle" : particle_scene.path()) + " is not inside the fluid of Domain/kind `" +
                   particle_scene.domain.kind + "` at the start.",
               0);
}

std::string lacks_symmetry(const ParticleScene& particle_scene, const Body& body) {
  if (particle_scene.particle.rigid()) return "for a rigid body";
  if (!particle_scene.equations.empty()) return "with added equations";
  if (body.wall)
    switch (body.wall->kind) {
      case surface::DuctKind::straight_tube: return "in a tube";
      case surface::DuctKind::channel: return particle_scene.domain.present ? "in a channel that repeats" : "";
    }
  if (!particle_scene.domain.present) return "";
  if (!particle_scene.posts.empty()) return "among posts";
  return particle_scene.adaptation.enabled ? "on an adaptive mesh in a lattice" : "";
}

surface::Symmetry symmetry(const ParticleScene& particle_scene, const Body& body, const Net& x) {
  if (!lacks_symmetry(particle_scene, body).empty()) return surface::Symmetry(body.space.n_points);
  const Net* nets[] = {&body.unstressed, &body.rest, &x};
  const coupling::LoadList loads = make_loads(particle_scene, body, body.wall.get()).all();
  if (body.wall) return coupling::symmetry(particle_scene.symmetry, body.space, nets, *body.wall, loads);
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
