#include "scene/initial_shape.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/document.hpp"
#include "deck/words.hpp"
#include "spline/iga.hpp"
#include "spline/transfer.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread {

namespace {

const std::string key = "Particle/initial shape/";

/// Returns the image of a surface under a linear map about the point `middle`. If the map is the identity, the result is bitwise equal to `net`.
Net image(const Net& net, const Vec3& middle, const Mat3& map) {
  return net + (net.rowwise() - middle.transpose()) * (map - Mat3::Identity()).transpose();
}

bool same_space(const spline::Space& one, const spline::Space& other) {
  const auto same = [](const spline::Element& a, const spline::Element& b) {
    // The extraction matrices of a file are compared to 1e-6, because a file holds rounded numbers.
    return a.points == b.points && a.degree == b.degree && (*a.extraction - *b.extraction).cwiseAbs().maxCoeff() < 1e-6;
  };
  return one.n_points == other.n_points && std::ranges::equal(one.elements, other.elements, same);
}

/// Reads a control net from the file `name`. `path`: path of the key that names the file.
Net net_of_file(const spline::Space& space, const std::string& name, const std::string& path) {
  const spline::SplineSurface surface = spline::read_iga(name);
  if (!same_space(surface.space, space))
    throw UserError(path + formatted(": %s contains another spline space than the particle's: it has %d control points, and the particle has %d.",
                                     name.c_str(), surface.space.n_points, space.n_points));
  return surface.net;
}

/// Throws UserError if the scene cannot start from the surface of a particle of the run: the mesh options differ from the scene's, or the mesh adapts
/// and the resting shapes differ. Material properties may differ.
void check_surface(const ParticleScene& particle_scene, const ParticleKind& before, const std::string& name) {
  const auto refuse = [&](const char* what) { throw UserError(key + "run: " + what + " must be the same as in " + name + "."); };
  if (!(before.surface == particle_scene.surface)) refuse("Surface");
  const motion::AdaptationOptions &then = before.adaptation, &now = particle_scene.adaptation;
  if (then.enabled != now.enabled || (now.enabled && then.levels != now.levels)) refuse("Adaptation/enabled and Adaptation/levels");
  surface::ParticleShape rest = before.particle.shape;
  if (before.copies.present) rest.center = particle_scene.particle.shape.center, rest.orientation = particle_scene.particle.shape.orientation;
  if (now.enabled && !rest.same_rest(particle_scene.particle.shape)) refuse("Particle's resting shape on a mesh that adapts");
}

/// Particle of an earlier run: its name, its kind, and its rows in the nets of the run.
struct Part {
  std::string name;
  const ParticleKind* kind;
  Eigen::Index first_row, n_rows;
};

/// Returns the particles of a run, in the order of their rows. `scene`: scene of the run's deck, in which the copies are not yet made.
std::vector<Part> parts_of(const Scene& scene, const output::Checkpoint& run) {
  std::vector<Part> parts;
  Eigen::Index first_row = 0;
  const auto add = [&](const std::string& name, const ParticleKind& kind) {
    const auto found = run.arrays.find(name.empty() ? "unstressed" : name + ": unstressed");
    if (found == run.arrays.end()) return false;
    parts.push_back({name, &kind, first_row, found->second.rows()});
    first_row += found->second.rows();
    return true;
  };
  for (const ParticleKind& kind : scene.particles) {
    if (!kind.copies.present) add(kind.name, kind);
    for (int copy = 1; kind.copies.present && add(kind.name + formatted(" %d", copy), kind);) ++copy;
  }
  if (parts.empty()) parts.push_back({"", &scene.particles.front(), 0, output::stored_shapes(run).rows()});  // a free rigid body
  return parts;
}

/// Reduces a run to the particle from which the particle of the scene starts: removes the rows of other particles and of surface fields from the
/// state and the modes, and the name of the particle from the names of its arrays (`cell: unstressed` becomes `unstressed`).
void reduce(RunBefore& run, const ParticleScene& particle_scene, const std::string& name) {
  Scene of_run(*particle_scene.registry);
  deck::Document deck = deck::read_text(run.texts.at("deck"), "The deck of " + name);
  deck.declare(of_run);
  const std::vector<Part> parts = parts_of(of_run, run);
  const std::optional<std::string>& given = particle_scene.particle.shape.initial->particle;
  run.in_place = parts.size() > 1 && !given;
  const auto part = std::ranges::find(parts, given.value_or(run.in_place ? particle_scene.name : parts.front().name), &Part::name);
  if (part == parts.end()) {
    std::vector<std::string> names;
    for (const Part& one : parts) names.push_back("`" + one.name + "`");
    throw UserError(key + "particle must be one of the particles of " + name + ", " + deck::shortened(deck::alternatives(names), 200) +
                    (given ? ", but is " + deck::in_quotes(*given) : "") + ".");
  }
  check_surface(particle_scene, *part->kind, name);
  const Net shapes = output::stored_shapes(run);
  if (part->first_row + part->n_rows > shapes.rows()) throw std::out_of_range("x");
  std::map<std::string, Eigen::MatrixXd> arrays{{"x", shapes.middleRows(part->first_row, part->n_rows)}};
  run.arrays.erase("x");
  for (auto& [array, values] : run.arrays) {
    const bool own = !part->name.empty() && array.starts_with(part->name + ": ");
    const bool stacked = array.starts_with("mode ");
    arrays[own ? array.substr(part->name.size() + 2) : array] = stacked ? values.middleRows(part->first_row, part->n_rows).eval() : std::move(values);
  }
  run.arrays = std::move(arrays);
}

/// Returns an eigenmode from the section Spectrum of a run, as a displacement of the control points.
Net mode_of_run(const output::Checkpoint& run, int number) {
  const auto found = run.arrays.find("mode " + std::to_string(number));
  if (found == run.arrays.end())
    throw UserError(key + formatted("mode must be one of the modes of the run's Spectrum, and there is no mode %d.", number));
  return found->second;
}

}  // namespace

std::optional<RunBefore> run_before(const ParticleScene& particle_scene) try {
  const auto& initial = particle_scene.particle.shape.initial;
  if (!initial || !initial->run) return {};
  const std::string name = deck::shortened(*initial->run, 80);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(*initial->run, error);
  if (error) throw UserError(key + "run: cannot read " + name + ": " + error.message());
  RunBefore run;
  if (std::filesystem::is_directory(status)) {
    auto saved = output::newest_checkpoint(*initial->run);
    if (!saved) throw UserError(key + "run: there is no checkpoint in " + name + ".");
    run = {std::move(saved->checkpoint)};
  } else {
    run = {output::read_checkpoint(*initial->run)};
  }
  reduce(run, particle_scene, name);
  using Names = std::vector<const char*>;
  for (const char* needed : particle_scene.adaptation.enabled ? Names{"x", stored_rest, "mesh edges", "mesh spacing"} : Names{"x"})
    static_cast<void>(run.arrays.at(needed));
  return run;
} catch (const std::out_of_range&) {
  throw UserError(key + "run: the run was written by another version of tanktread and lacks data that this version needs.");
} catch (const std::runtime_error& error) {
  if (dynamic_cast<const UserError*>(&error)) throw;
  throw UserError(key + "run: " + error.what());
}

Net initial_shape(const ParticleScene& particle_scene, const Body& body, const RunBefore* before) {
  const surface::ParticleShape& shape = particle_scene.particle.shape;
  if (!shape.initial) return body.rest;
  const surface::InitialShape& initial = *shape.initial;
  const bool own = initial.volume == "own";
  if (const auto map = initial.affine(shape.rotation())) return image(body.rest, shape.center, *map / (own ? 1 : std::cbrt(map->determinant())));
  Net x = before ? Net(before->arrays.at("x")) : net_of_file(body.space, initial.file.value(), key + "file");
  if (x.rows() != body.space.n_points)
    throw UserError(key + formatted("run: its surface has %d control points, but the particle has %d.", static_cast<int>(x.rows()),
                                    body.space.n_points));
  if (initial.mode) x += initial.mode_amplitude * body.radius * mode_of_run(*before, *initial.mode);
  if (!before || !before->in_place) x = (x * initial.turn.transpose()).rowwise() + initial.shift.transpose();
  const surface::Measures measures = surface::measures(body.space, x);
  const double scale = own ? 1 : std::cbrt(surface::volume(body.space, body.rest) / measures.volume);
  return image(x, measures.centroid, scale * Mat3::Identity());
}

Net stress_free_shape(const ParticleScene& particle_scene, const Body& body, const Body& first) {
  const membrane::Options& membrane = particle_scene.membrane;
  if (membrane.stress_free == "resting") return body.rest;
  if (membrane.stress_free == "file") {
    const Net net = net_of_file(first.space, membrane.stress_free_file.value(), "Membrane/stress-free file");
    return &first == &body ? net : spline::transfer(first.nested(), body.nested())(net).net;
  }
  if (particle_scene.particle.shape.imported)
    throw UserError(
        "Membrane/stress-free shape must be `resting` or `file` if Particle/shape is `file`, because the axis of that shape is not known.");
  const surface::LeastSquaresFit fit(first.space);
  const surface::MeshOptions& mesh = particle_scene.surface;
  const Net sphere = mesh.polar() ? surface::unit_sphere(mesh.polar_mesh(), first.space, mesh.axis()) : surface::unit_sphere(first.mesh, fit);
  const Net spheroid = surface::stress_free_spheroid(fit, sphere, particle_scene.particle.shape, membrane.reduced_volume.value_or(1));
  return &first == &body ? spheroid : spline::transfer(first.nested(), body.nested())(spheroid).net;
}

}  // namespace tanktread
