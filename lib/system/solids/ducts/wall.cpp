#include "system/solids/ducts/wall.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/solids/ducts/channel_flow.hpp"
#include "system/solids/ducts/congruence.hpp"
#include "system/targets/collocation.hpp"
#include "system/targets/points_off.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the lattice of a periodic wall. The reference distance l of (2.43) is well outside the duct: if it were close to the duct's radius,
/// tractions on the wall could not move the fluid along the duct.
std::optional<stokes::PeriodicCell> lattice(const surface::TubeWall& wall) {
  constexpr double far = 4;
  if (wall.period == 0) return {};
  return stokes::PeriodicCell(wall.period * Mat3::Identity(), 1, far * wall.net.rightCols<2>().rowwise().norm().maxCoeff());
}

}  // namespace

Wall::Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases,
           const surface::Symmetry& symmetry, const WallSolver& solver)
    : surface_(wall),
      symmetry_(symmetry.order() > 1 ? symmetry : surface::Symmetry(static_cast<int>(wall.sites.size()))),
      quadrature_(quadrature),
      solver_(solver),
      inner_radius_(wall.outline.distance(wall.outline.centroid())),
      points_(surface_, symmetry_, phases),
      cell_(lattice(wall)),
      layer_(stokes::Layer::Kernel::single_layer, surface_.space, {}, quadrature) {
  const auto n = static_cast<int>(wall.sites.size());
  if (!cell_) inlet_.emplace(wall.outline, wall.start, quadrature.for_matrix().tolerance);
  if (cell_) layer_.repeat(*cell_, {.assembled = true});
  layer_.set_shape(wall.net);
  on_itself_ = std::make_unique<stokes::Layer>(stokes::Layer::Kernel::single_layer, surface_.space, points_.target_sites(wall),
                                               quadrature.for_matrix());
  if (cell_) on_itself_->repeat(*cell_, {.assembled = true});
  on_itself_->set_shape(wall.net);
  if (cell_) find_null_vector();
  const surface::Symmetry of_wall = reflections(surface_, points_.sites());
  if (solver.iterates(WallFactors::bytes(of_wall, symmetry_), cell_.has_value())) {
    stop_together([&] { patches_of_rows_.emplace(surface_, *on_itself_, symmetry_.fundamental()); });
    krylov_ = std::make_unique<Krylov>(IterativeOptions{.solver = "GMRES", .preconditioner = "recycled"});
  } else {
    factor(of_wall);
  }
  inlet_column_ = cell_ ? Net(Net::Zero(n, 3)) : points_.collocated(inlet_->integral(points_.targets()));
  traction_per_pressure_drop_ = cell_ ? inlet_column_ : solve(inlet_column_);
}

bool Wall::is_for(const surface::TubeWall& wall, const quadrature::Options& quadrature, const surface::Symmetry& symmetry,
                  const WallSolver& solver) const {
  const bool same_surface = same(wall.net, surface_.net) && wall.n_around == surface_.n_around && wall.period == surface_.period &&
                            wall.start == surface_.start && wall.end == surface_.end && wall.kind == surface_.kind;
  const bool same_symmetry = symmetry.order() == symmetry_.order() && (symmetry.order() == 1 || symmetry.source() == symmetry_.source());
  return same_surface && same_symmetry && quadrature == quadrature_ && solver == solver_;
}

/// Computes no_flux_. The outer product of its two vectors is added to A, because A is singular: a uniform pressure produces no velocity. The product
/// is scaled so that it maps a uniform pressure to about the velocity that A produces for a tangential traction of equal size.
void Wall::find_null_vector() {
  no_flux_.flux_vector = from_space(wall_integrals(surface_, [](const surface::Point& at) -> Vec3 { return at.n; }));
  no_flux_.null_vector.resize(n_sites(), 3);
  for (Eigen::Index i = 0; i < no_flux_.null_vector.rows(); ++i)
    no_flux_.null_vector.row(i) = surface::point(surface_.space, surface_.net, surface_.sites[static_cast<std::size_t>(i)].front()).n.transpose();
  no_flux_.null_vector *= surface_.radius() / dot(no_flux_.flux_vector, no_flux_.null_vector);
}

template <class Real>
void Wall::from_space(stokes::Rows<Real>& rows) const {
  if (cell_) rows = columns_of(surface_.open_from_periodic, rows);
}
template void Wall::from_space(stokes::Rows<float>& rows) const;

/// Assembles the rows of the single layer of the wall at targets on the wall itself. The columns belong to the control values of f.
void Wall::assemble_rows(std::span<const int> targets, stokes::Rows<double>& rows) {
  on_itself_->assemble(targets, rows);
  from_space(rows);
}

/// Assembles and factors the wall's operator A. Many rows are assembled at a time, because each row is a mean over a collocation point and adjacent
/// element midpoints (2.39), and neighbouring collocation points share these midpoints. If rotations or reflections of the cross-section map
/// collocation points to each other, only the rows of one of these points are assembled. These maps then yield the rows of the other points.
void Wall::factor(const surface::Symmetry& of_wall) {
  constexpr std::size_t at_a_time = 240;
  factors_ = WallFactors(of_wall, symmetry_);
  const auto n = static_cast<int>(n_sites());
  const int m = surface_.n_around;
  const std::vector<WallSymmetry> maps = wall_symmetries(surface_, points_.sites());
  const std::vector<OrbitRepresentative> representative = orbit_representatives(maps, m);
  const auto representative_of = [&](int site) { return representative[static_cast<std::size_t>(site % m)]; };
  std::vector<int> own;  // sites of this rank, sorted by OrbitRepresentative::point (congruence.hpp): equal representatives are adjacent
  for (const int k : points_.ranks().share(static_cast<int>(of_wall.fundamental().size())))
    own.push_back(of_wall.fundamental()[static_cast<std::size_t>(k)]);
  std::ranges::stable_sort(own, {}, [&](int site) { return site - site % m + representative_of(site).point; });
  // Adds the rows of `site`. `rows`: the three rows of the congruent site that `map` moves to `site`.
  const auto add_rows = [&](int site, const WallSymmetry& map, const auto& rows) {
    for (int p = 0; p < n; ++p) {
      const int from = p - p % m + map.source[static_cast<std::size_t>(p % m)];
      factors_.add(site, p, map.q * rows.template middleCols<3>(3 * from) * map.q.transpose());
    }
  };
  const auto assemble = [&] {
    for (std::size_t first = 0, last = 0; first < own.size(); first = last) {
      std::vector<int> some,
          row;  // some: sites whose rows are assembled. row: for each site of `own`, index in `some` of the congruent site
      for (; last < own.size() && some.size() < at_a_time; ++last) {
        const int site = own[last] - own[last] % m + representative_of(own[last]).point;
        if (some.empty() || some.back() != site) some.push_back(site);
        row.push_back(static_cast<int>(some.size()) - 1);
      }
      stokes::Rows<double> part;
      points_.collocate<double>(
          some, [&](std::span<const int> targets, stokes::Rows<double>& rows) { assemble_rows(targets, rows); }, part);
      for (std::size_t k = 0; k < row.size(); ++k)
        add_rows(own[first + k], *representative_of(own[first + k]).from, part.middleRows<3>(3 * row[k]));
    }
  };
  stop_together(assemble);
  if (cell_ && points_.ranks().rank() == 0) factors_.add_product(no_flux_.null_vector, no_flux_.flux_vector);
  factors_.factor(points_.ranks());
}

EmptyChannel& Wall::empty_channel(const std::function<EmptyChannel*()>& make) {
  if (!empty_channel_) empty_channel_.reset(make());
  return *empty_channel_;
}

const surface::ElementBoxes& Wall::boxes() {
  return boxes_ ? *boxes_ : boxes_.emplace(patches_.emplace(surface::BezierMap(surface_.space), surface_.net));
}

Net Wall::apply(const Net& f) const {
  Net u(points_.targets().rows(), 3);
  on_itself_->apply(on_space(f), points_.own_targets(), u);
  const Net rows = points_.collocated(u);
  return cell_ ? Net(rows + dot(no_flux_.flux_vector, f) * no_flux_.null_vector) : rows;
}

Net Wall::solve(const Net& rhs) const {
  return iterates() ? iterated(rhs) : factors_.solve(symmetry_.completed(rhs));
}

Net Wall::iterated(const Net& rhs) const {
  const auto precondition = [this](const Net& u) {
    Net f = Net::Zero(n_sites(), 3);
    patches_of_rows_->apply(u, f);
    return symmetry_.completed(std::move(f));
  };
  const LinearSystem system{one_block("wall traction", rhs.size()), on_nets(n_sites(), [this](const Net& f) { return apply(f); }),
                            on_nets(n_sites(), precondition)};
  const Net b = symmetry_.completed(rhs);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  require_convergence(krylov_->solve(system, flat(b), x, solver_.tolerance), "the wall", solver_.tolerance);
  return as_net(x);
}

Net Wall::solve_transposed(const Net& weights) const {
  if (iterates()) throw std::logic_error("the transposed system of a wall needs its factors");
  const Net everywhere = factors_.solve_transposed(weights);
  Net folded = Net::Zero(weights.rows(), 3);
  for (Eigen::Index p = 0; p < weights.rows(); ++p)
    folded.row(symmetry_.source()[static_cast<std::size_t>(p)]) += symmetry_.signs().row(p).cwiseProduct(everywhere.row(p));
  return folded;
}

void Wall::velocity(const Net& f, const PointsOff& points, Net& u) {
  layer_.apply(on_space(f), points.at, points.own, u, points.near ? &*points.near : nullptr);
}

Eigen::Index Wall::first_outside(const Net& x, std::span<const int> rows) const {
  const auto first = std::ranges::find_if_not(rows, [&](int i) {
    const Vec3 place = x.row(i).transpose();
    switch (surface_.kind) {
      case surface::DuctKind::straight_tube:
        return (place.tail<2>() - surface_.outline.centroid()).norm() < inner_radius_ || surface_.outline.inside(place.tail<2>());
      case surface::DuctKind::channel: return surface_.channel->inside(place);
    }
    throw std::logic_error("unknown DuctKind");
  });
  return first == rows.end() ? -1 : *first;
}

stokes::Evaluations Wall::evaluations() const {
  const stokes::Evaluations own = on_itself_->evaluations() + layer_.evaluations();
  return empty_channel_ ? own + empty_channel_->layer.evaluations() : own;
}

}  // namespace tanktread::coupling
