#include "app/adaptation.hpp"

#include <algorithm>

#include "motion/adaptation.hpp"
#include "spline/coarsening.hpp"
#include "spline/locate.hpp"
#include "spline/projection.hpp"
#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "surface/metrics.hpp"
#include "surface/resolution.hpp"

namespace tanktread {

namespace {

/// The body and the state carried over by `move`, which gives a net on the new space.
template <class Move>
Adapted carried(const Body& body, std::unique_ptr<Body> target, const motion::State& state, const Move& move) {
  Adapted result{std::move(target), state};
  result.body->rest = move(body.rest);
  result.body->unstressed = move(body.unstressed);
  result.state.x = move(state.x);
  for (Net& slope : result.state.history) slope = move(slope);
  if (state.frozen.size() > 0) result.state.frozen = move(state.frozen);
  return result;
}

std::unique_ptr<Body> on_mesh(const Scene& scene, const Body& body, spline::TMesh mesh) {
  auto target = std::make_unique<Body>(body);
  lay_out(scene, std::move(mesh), *target);
  return target;
}

/// A symmetric particle keeps a symmetric mesh: marks stand for all their images.
spline::RepairRules rules(const Body& body) {
  spline::RepairRules result;
  for (const surface::Image& image : body.symmetry.images())
    if (auto map = spline::lattice_map(body.mesh, body.space, image.element, image.signs.prod() < 0)) result.images.push_back(std::move(*map));
  return result;
}

Adapted refined(const Scene& scene, const Body& body, const motion::State& state, const std::vector<spline::Mark>& marks) {
  if (marks.empty()) return {};
  spline::Refinement refinement = spline::refine(body.mesh, marks, rules(body));
  if (refinement.mesh.edges == body.mesh.edges) {
    Adapted unchanged;
    unchanged.refused = refinement.refused;
    return unchanged;
  }
  auto target = on_mesh(scene, body, std::move(refinement.mesh));
  const spline::Transfer transfer(body.nested(), target->nested());
  double residual = 0;
  Adapted result = carried(body, std::move(target), state, [&](const Net& field) {
    const auto moved = transfer(field);
    residual = std::max(residual, moved.residual);
    return moved.net;
  });
  result.change = residual / body.radius;
  result.refused = refinement.refused;
  return result;
}

/// Elements of the T-mesh in which some Bezier element's defect is above the tolerance.
std::vector<bool> elements_over(const Body& body, const std::vector<double>& defect, double tolerance) {
  const std::vector<int> tile = spline::mesh_elements(body.mesh, body.nested());
  std::vector<bool> over(static_cast<size_t>(*std::ranges::max_element(tile)) + 1, false);
  for (size_t e = 0; e < defect.size(); ++e)
    if (defect[e] > tolerance) over[static_cast<size_t>(tile[e])] = true;
  return over;
}

/// Coarsens; elements whose surfaces would change by more than the tolerance are left out and the rest is tried again.
Adapted coarsened(const Scene& scene, const Body& body, const motion::State& state, std::vector<spline::Merge> merges) {
  for (int trial = 0; trial < 4 && !merges.empty(); ++trial) {
    spline::Coarsening coarsening = spline::coarsen(body.mesh, merges, rules(body));
    auto target = on_mesh(scene, body, std::move(coarsening.mesh));
    if (target->space.n_points >= body.space.n_points) return {};
    const spline::Projection projection(body.nested(), target->nested());
    std::vector<double> defect(body.nested().elements.size(), 0.0);
    for (const Net* net : {&body.unstressed, &state.x}) {
      const std::vector<double> found = projection(*net).defect;
      for (size_t e = 0; e < defect.size(); ++e) defect[e] = std::max(defect[e], found[e]);
    }
    const double change = *std::max_element(defect.begin(), defect.end());
    if (change <= scene.adaptation.coarsening_tolerance) {
      Adapted result = carried(body, std::move(target), state, [&](const Net& field) { return projection(field).net; });
      result.finer = false;
      result.change = change / body.radius;
      return result;
    }
    const std::vector<bool> spoilt = elements_over(body, defect, scene.adaptation.coarsening_tolerance);
    std::erase_if(merges, [&](const spline::Merge& merge) { return spoilt[static_cast<size_t>(merge.element)]; });
  }
  return {};
}

/// Of elements of the T-mesh that have no side at a pole. The paper cuts no others; what they are cut by comes from their neighbours.
void leave_poles(const Body& body, std::vector<spline::Mark>& marks) {
  if (body.mesh.lattice->pad == 0 || marks.empty()) return;
  const spline::Tiling tiling = spline::elements(body.mesh);
  const auto degenerate = [&](const spline::Mark& mark) {
    return spline::is_degenerate(*body.mesh.lattice, tiling.tiles[static_cast<size_t>(mark.element)]);
  };
  std::erase_if(marks, degenerate);
}

}  // namespace

Adapted adapted(const Scene& scene, const Body& body, const motion::State& state, const Net& load, bool per_unstressed_area) {
  const motion::AdaptationOptions& options = scene.adaptation;
  const surface::FieldAt traction = per_unstressed_area ? surface::per_current_area(body.nested(), body.unstressed, state.x, load)
                                                        : surface::field_of_net(body.nested(), load);
  std::vector<spline::Mark> marks;
  std::vector<spline::Merge> merges;
  if (options.indicator == "error") {
    const auto resolution =
        surface::resolution(body.mesh, body.nested(), body.unstressed, state.x, options.load_tolerance ? traction : surface::FieldAt());
    marks = motion::marks(resolution, options);
    merges = motion::merges(resolution, options);
  } else {
    surface::MetricFields fields;
    if (options.reference_traction_variation) fields.traction = traction;
    if (options.reference_velocity_variation && !state.history.empty())
      fields.velocity = surface::field_of_net(body.nested(), state.history.front());
    const auto metrics = surface::element_metrics(body.mesh, body.nested(), state.x, fields);
    marks = motion::marks(metrics, options);
    merges = motion::merges(metrics, options);
  }
  leave_poles(body, marks);
  Adapted finer;
  if (body.space.n_points < options.largest_number_of_points) finer = refined(scene, body, state, marks);
  if (finer.body || !options.coarsen) return finer;
  Adapted coarser = coarsened(scene, body, state, merges);
  coarser.refused = finer.refused;
  return coarser;
}

}  // namespace tanktread
