#include "scene/particles/adaptation.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "accuracy/obstacles.hpp"
#include "base/formatted.hpp"
#include "motion/adaptation.hpp"
#include "scene/particles/gaps.hpp"
#include "spline/locate.hpp"
#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "surface/geometry.hpp"
#include "surface/metrics.hpp"
#include "surface/shapes.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread {

namespace {

/// Particle whose mesh is adapted.
struct Subject {
  const ParticleScene& particle_scene;
  const Body& body;
  const Net &x, &slope;  ///< shape and its velocity; `slope` has no rows if it is unknown
  std::span<const double> films;
};

/// Returns the result with the body `target`, whose nets are transferred to its space by `move`.
Adapted transferred(const Subject& of, std::unique_ptr<Body> target, std::function<Net(const Net&)> move) {
  target->rest = move(of.body.rest);
  target->initial = move(of.body.initial);
  target->unstressed = move(of.body.unstressed);
  return {std::move(target), std::move(move)};
}

/// Records in the result the displacement `moved` of the surfaces by the mesh change, divided by the radius R_C.
void record_change(Adapted& result, double moved, double radius) {
  result.change = moved / radius;
  result.body->refit_error += result.change;
}

std::unique_ptr<Body> on_mesh(const Subject& of, spline::TMesh mesh) {
  auto target = std::make_unique<Body>(of.body);
  lay_out(of.particle_scene, std::move(mesh), *target);
  return target;
}

/// Returns rules that keep the mesh of a symmetric particle symmetric: a refined element is refined together with its images under the symmetry.
spline::RepairRules rules(const Body& body) {
  spline::RepairRules result;
  for (const surface::Image& image : body.symmetry.images())
    if (auto map = spline::lattice_map(body.mesh, body.space, image.element, image.signs.prod() < 0)) result.images.push_back(std::move(*map));
  return result;
}

Adapted on_finer_mesh(const Subject& of, spline::TMesh mesh) {
  auto target = on_mesh(of, std::move(mesh));
  const auto transfer = spline::transfer(of.body.nested(), target->nested());
  const double residual = std::max(transfer(of.body.unstressed).residual, transfer(of.x).residual);
  Adapted result = transferred(of, std::move(target), [transfer](const Net& field) { return transfer(field).net; });
  record_change(result, residual, of.body.radius);
  return result;
}

/// Result of the indicator of mesh adaptation (`Adaptation/indicator`) on the current mesh: `marks` returns the elements to refine for given limits,
/// and `merges` are the elements to merge.
struct Findings {
  std::function<std::vector<spline::Mark>(const motion::AdaptationOptions&)> marks;
  std::vector<spline::Merge> merges;
};

/// Calls `choose` on the first rank only and returns its result, a list of marks or merges, on all ranks.
template <class Choose>
auto decided(const Choose& choose) {
  using Item = typename decltype(choose())::value_type;
  const std::vector<double> numbers = coupling::decided([&] {
    std::vector<double> all;
    for (const Item& item : choose())
      for (const int number : {item.element, static_cast<int>(item.s), static_cast<int>(item.t)}) all.push_back(number);
    return all;
  });
  std::vector<Item> items;
  for (size_t k = 0; k < numbers.size(); k += 3)
    items.push_back({static_cast<int>(numbers[k]), static_cast<decltype(Item::s)>(numbers[k + 1]), static_cast<decltype(Item::t)>(numbers[k + 2])});
  return items;
}

/// Returns the length of each element along s and t.
template <class Indicator>
std::vector<std::array<double, 2>> lengths_of(const std::vector<Indicator>& found) {
  std::vector<std::array<double, 2>> lengths;
  for (const Indicator& one : found) {
    if constexpr (requires { one.along; }) lengths.push_back({one.along[0].length, one.along[1].length});
    else lengths.push_back({one[0].length, one[1].length});
  }
  return lengths;
}

/// Returns for each element of the T-mesh the smallest of the values on its Bezier elements. `values`: one value per Bezier element; if empty, the
/// result is empty.
std::vector<double> least_of_mesh(const Body& body, std::span<const double> values) {
  std::vector<double> least;
  if (values.empty()) return least;
  const std::vector<int> tile = spline::mesh_elements(body.mesh, body.nested());
  least.assign(static_cast<size_t>(*std::ranges::max_element(tile)) + 1, std::numeric_limits<double>::infinity());
  for (size_t e = 0; e < values.size(); ++e) least[static_cast<size_t>(tile[e])] = std::min(least[static_cast<size_t>(tile[e])], values[e]);
  return least;
}

Findings findings(const Subject& particle, const surface::FieldAt& traction, const surface::FieldsAt& fields_at) {
  const auto& [particle_scene, body, x, slope, films] = particle;
  const motion::AdaptationOptions& options = particle_scene.adaptation;
  const std::vector<double> widths = least_of_mesh(body, films);
  const auto of = [&](auto indicator) {
    const std::vector<std::array<double, 2>> lengths = lengths_of(indicator);
    std::vector<spline::Merge> merges = decided([&] {
      std::vector<spline::Merge> all = motion::merges(indicator, options);
      if (!widths.empty()) motion::keep_films(lengths, widths, options, all);
      return all;
    });
    return Findings{[found = std::move(indicator), lengths, widths](const motion::AdaptationOptions& limits) {
                      return decided([&] {
                        std::vector<spline::Mark> marks = motion::marks(found, limits);
                        if (!widths.empty()) motion::add_films(lengths, widths, limits, marks);
                        return marks;
                      });
                    },
                    std::move(merges)};
  };
  if (options.indicator == "error")
    return of(surface::resolution(body.mesh, body.nested(), body.unstressed, x, options.load_tolerance ? traction : surface::FieldAt(),
                                  fields_at));
  surface::MetricFields fields;
  if (options.reference_traction_variation) fields.traction = traction;
  if (options.reference_velocity_variation && slope.rows() > 0) fields.velocity = surface::field_of_net(body.nested(), slope);
  return of(surface::element_metrics(body.mesh, body.nested(), x, fields));
}

/// Removes the marks of T-mesh elements with a side at a pole, if the poles are degenerate or `Adaptation/indicator` is not `error`. As in Maestre et
/// al. (2017), such elements are then refined only if the refinement of a neighbour requires it.
void leave_poles(const ParticleScene& particle_scene, const Body& body, std::vector<spline::Mark>& marks) {
  if (body.mesh.lattice->pad == 0 || (particle_scene.surface.has_normal_at_poles() && particle_scene.adaptation.indicator == "error")) return;
  const spline::Tiling tiling = spline::elements(body.mesh);
  const auto degenerate = [&](const spline::Mark& mark) {
    return spline::is_degenerate(*body.mesh.lattice, tiling.tiles[static_cast<size_t>(mark.element)]);
  };
  std::erase_if(marks, degenerate);
}

/// Refines all marked elements. If the mesh would exceed the allowed number of points, tries again with the tolerances and limits of the section
/// Adaptation multiplied by 2, 4, … up to 64.
Adapted refined(const Subject& of, const Findings& found) {
  const auto& [particle_scene, body, x, slope, films] = of;
  const int room = particle_scene.adaptation.largest_number_of_points - body.space.n_points;
  const size_t before = spline::anchors(body.mesh).size();
  Adapted result;
  std::optional<spline::RepairRules> keeping;
  for (double factor = 1; factor <= 64; factor *= 2) {
    auto marks = found.marks(particle_scene.adaptation.coarser(factor));
    leave_poles(particle_scene, body, marks);
    if (marks.empty()) break;
    if (!keeping) keeping = rules(body);
    spline::Refinement refinement = spline::refine(body.mesh, marks, *keeping);
    const int refused = factor == 1 ? refinement.refused : result.refused;
    const bool fits = static_cast<int>(spline::anchors(refinement.mesh).size() - before) <= room;
    const bool full = result.full || !fits;
    if (fits && refinement.mesh.edges != body.mesh.edges) result = on_finer_mesh(of, std::move(refinement.mesh));
    result.refused = refused;
    result.full = full;
    if (fits) break;
  }
  return result;
}

/// Merges elements. If the surfaces on some of the merged elements would move by more than the tolerance, leaves these elements out and merges only
/// the remaining ones.
Adapted coarsened(const Subject& of, std::vector<spline::Merge> merges) {
  const auto& [particle_scene, body, x, slope, films] = of;
  for (int trial = 0; trial < 4 && !merges.empty(); ++trial) {
    auto target = on_mesh(of, spline::coarsen(body.mesh, merges, rules(body)));
    if (target->space.n_points >= body.space.n_points) return {};
    const auto projection = spline::projection(body.nested(), target->nested());
    const std::vector<double> defect = coupling::decided([&] {
      std::vector<double> worse = projection(body.unstressed).defect;
      std::ranges::transform(worse, projection(x).defect, worse.begin(), [](double a, double b) { return std::max(a, b); });
      return worse;
    });
    const double change = *std::max_element(defect.begin(), defect.end());
    if (change <= particle_scene.adaptation.coarsening_tolerance) {
      Adapted result = transferred(of, std::move(target), [projection](const Net& field) { return projection(field).net; });
      result.finer = false;
      record_change(result, change, body.radius);
      return result;
    }
    std::vector<double> unmoved;
    for (const double moved : defect) unmoved.push_back(particle_scene.adaptation.coarsening_tolerance - moved);
    const std::vector<double> left = least_of_mesh(body, unmoved);
    std::erase_if(merges, [&](const spline::Merge& merge) { return left[static_cast<size_t>(merge.element)] < 0; });
  }
  return {};
}

}  // namespace

Adapted adapted(const ParticleScene& particle_scene, const Body& body, const Net& x, const Net& slope, const Net& load, bool per_unstressed_area,
                std::span<const double> films, const surface::FieldsAt& fields) {
  const Subject particle{particle_scene, body, x, slope, films};
  const surface::FieldAt traction = per_unstressed_area ? surface::per_current_area(body.nested(), body.unstressed, particle.x, load)
                                                        : surface::field_of_net(body.nested(), load);
  const Findings found = findings(particle, traction, fields);
  Adapted finer = refined(particle, found);
  if (finer.body || !particle_scene.adaptation.coarsen) return finer;
  Adapted coarser = coarsened(particle, found.merges);
  coarser.refused = finer.refused;
  coarser.full = finer.full;
  return coarser;
}

std::vector<Warning> refine_isolated_body(const ParticleScene& particle_scene, Body& body, const std::function<Net(const Body& on)>& force_density) {
  if (!particle_scene.adaptation.enabled) return {};
  std::vector<Warning> remarks;
  constexpr int most = 10;
  for (int k = 0; k < most; ++k) {
    Net load = Net::Zero(body.rest.rows(), 3), x = body.rest;
    if (particle_scene.adaptation.limits_load()) load = force_density(body);
    // Moves the centroid of the particle to x1 = 0, because x1 of the wall of a straight tube is measured from the centroid.
    if (body.wall && !surface::properties(body.wall->kind).fixed) x.col(0).array() -= surface::measures(body.space, x).centroid[0];
    std::vector<Member> only(1);
    only[0].scene = particle_scene;
    only[0].body = std::make_unique<Body>(std::move(body));
    only[0].block = {.n_points = only[0].body->space.n_points, .n_elements = static_cast<int>(only[0].body->space.elements.size())};
    std::vector<double> widths;
    if (particle_scene.has_films_around_one()) widths = films(only, 0, x, {}, only[0].body->wall.get());
    Adapted change = adapted(particle_scene, *only[0].body, only[0].body->rest, {}, load, false, widths);
    body = std::move(*only[0].body);
    remarks = adaptation_remarks(only[0], change, 0);
    if (!change.body || !change.finer) break;
    body = std::move(*change.body);
    body.rest = surface::fitted_again(body.space, body.rest, particle_scene.particle.shape);
    body.initial = body.unstressed = body.rest;
    body.symmetry = surface::Symmetry(body.space.n_points);
  }
  return remarks;
}

std::vector<Warning> adaptation_remarks(const Member& member, const Adapted& change, double time) {
  const motion::AdaptationOptions& options = member.scene.adaptation;
  const std::string whole = "elements above the limits of Adaptation are not refined: ";
  std::vector<Warning> all;
  const auto add = [&](bool lacks, const std::string& kind, const std::string& sentence) {
    if (lacks) all.push_back({member.label(kind), member.label(formatted("at time %.4g ", time) + sentence)});
  };
  add(change.refused > 0, "levels",
      whole + formatted("they have been halved as often as Adaptation/levels = %d allows", options.levels));
  add(change.full, accuracy::full_mesh,
      whole + "Adaptation/largest number of points = " + std::to_string(options.largest_number_of_points) + " does not allow their refinement");
  add(change.body && change.finer && change.change > 1e-12 && !member.scene.particle.rigid(), "moved surface",
      formatted("refinement moved the surface by %.2g R_C, because the spline spaces are not nested: set Surface/extraordinary points to "
                "catmull-clark",
                change.change));
  return all;
}

}  // namespace tanktread
