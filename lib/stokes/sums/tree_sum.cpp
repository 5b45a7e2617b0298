#include "stokes/sums/tree_sum.hpp"

#include <algorithm>

#include "base/indices.hpp"

namespace tanktread::stokes {
namespace {

/// Maximum number of points in a leaf of the source tree and of the target tree. On deformed spheres, half or twice as many points per leaf take 10 %
/// more time.
constexpr int source_leaf = 256, target_leaf = 2 * far_block;

/// Factor on the tolerance of clusters. The error of clusters is proportional to the sum of |f| / r over the sources, with the force f and the
/// distance r. Loads on a membrane are in equilibrium, so that velocities are an order of magnitude smaller than this sum. With this factor, the
/// largest error on capsules in shear flow is a third of the tolerance.
constexpr double allowance = 0.3;

int blocks_of(int n) { return (n + far_block - 1) / far_block; }

/// Copies n positions, from index `first`, into blocks; unused lanes repeat the last position.
void fill_blocks(int n, int first, const std::vector<double> (&x)[3], double* block) {
  for (int k = 0; k < far_block * blocks_of(n); ++k) {
    double* to = block + 3 * far_block * (k / far_block) + k % far_block;
    for (int c = 0; c < 3; ++c) to[far_block * c] = x[c][first + std::min(k, n - 1)];
  }
}

/// Appends to `blocks` the reflections of the positions in `block`; both store positions in blocks of far_block points.
void append_images(const double* block, std::size_t size, const surface::Reflection& image, std::vector<double>& blocks) {
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t c = k / far_block % 3;
    blocks.push_back(image.middle[c] + image.signs[c] * (block[k] - image.middle[c]));
  }
}

/// Returns the clusters of trees by their distance from the root of their tree. Clusters come before their children.
std::vector<std::vector<int>> levels(const std::vector<Cluster>& all) {
  std::vector<int> level(all.size(), 0);
  std::vector<std::vector<int>> by_level;
  for (std::size_t c = 0; c < all.size(); ++c) {
    by_level.resize(std::max(by_level.size(), static_cast<std::size_t>(level[c]) + 1));
    by_level[static_cast<std::size_t>(level[c])].push_back(static_cast<int>(c));
    if (!all[c].leaf())
      for (const int child : all[c].child) level[static_cast<std::size_t>(child)] = level[c] + 1;
  }
  return by_level;
}

void reflect(ChebyshevBox& box, const surface::Reflection& image) {
  Eigen::Map<Vec3> centre(box.centre);
  centre = image(centre);
  for (auto& row : box.axes) {
    Eigen::Map<Vec3> axis(row);
    axis = image.of_vector(axis);
  }
}

}  // namespace

TreeSum::TreeSum(double tolerance)
    : sources_(allowance * tolerance, source_leaf, 1), target_tree_(allowance * tolerance, target_leaf, far_block) {}

void TreeSum::set_sources(const std::vector<double> (&x)[3], std::span<const int> starts, std::span<const Vec3> targets,
                    std::span<const surface::Reflection> reflections) {
  sources_.set_sources(x, starts);
  std::vector<double> at[3];
  for (int c = 0; c < 3; ++c)
    for (const Vec3& target : targets) at[c].push_back(target[c]);
  target_tree_.set_sources(at, indices(targets.size() + 1));
  const Clusters& tree = target_tree_;

  const int n = static_cast<int>(targets.size()), n_clusters = static_cast<int>(tree.all().size());
  target_at_.resize(static_cast<std::size_t>(3) * far_block * blocks_of(n));
  fill_blocks(n, 0, tree.points(), target_at_.data());
  node_at_.resize(static_cast<std::size_t>(3) * far_block * tree.n_blocks());
  for (const Cluster& c : tree.all())
    if (!c.bare)
      fill_blocks(c.n_nodes(), c.first_node, tree.nodes(), &node_at_[static_cast<std::size_t>(3) * far_block * c.first_block]);

  targets_ = tree.all();
  n_trees_ = 1;
  const std::size_t places = target_at_.size(), nodes = node_at_.size();
  for (const surface::Reflection& image : reflections) {
    target_at_.reserve(places * (reflections.size() + 1)), node_at_.reserve(nodes * (reflections.size() + 1));
    append_images(target_at_.data(), places, image, target_at_);
    append_images(node_at_.data(), nodes, image, node_at_);
    for (Cluster c : tree.all()) {
      reflect(c, image);
      c.first += n_trees_ * far_block * blocks_of(n), c.last += n_trees_ * far_block * blocks_of(n);
      c.first_block += n_trees_ * tree.n_blocks();
      if (!c.leaf())
        for (int& child : c.child) child += n_trees_ * n_clusters;
      targets_.push_back(c);
    }
    ++n_trees_;
  }
  levels_[0] = levels(sources_.all()), levels_[1] = levels(targets_);
}

/// Returns the row of the sums that belongs to position k in the order of the target trees. Each tree starts at a new block of far_block targets.
int TreeSum::row(std::size_t k) const {
  const std::size_t n = target_tree_.order().size(), size = static_cast<std::size_t>(far_block) * blocks_of(static_cast<int>(n));
  return target_tree_.order()[k % size] + static_cast<int>(n * (k / size));
}

void TreeSum::want(std::span<const int> rows) {
  mark_targets(rows);
  pairs_.clear();
  for (int image = 0; image < static_cast<int>(images_.size()); ++image)
    for (int k = 0; k < n_trees_; ++k) pair_up(targets_[k * target_tree_.all().size()], sources_.all().front(), image);
  if (parts_ > 1) keep_part();
  mark_sources();
  collect();
}

/// Collects the pairs that contribute to the Chebyshev nodes of each target cluster and to the targets of each leaf. The targets of a cluster are
/// those of its leaves.
void TreeSum::collect() {
  std::vector<std::vector<int>> to_nodes(targets_.size()), to_points(targets_.size());
  std::vector<int> below;
  for (int k = 0; k < static_cast<int>(pairs_.size()); ++k) {
    if (pairs_[k].target_nodes) {
      to_nodes[pairs_[k].target].push_back(k);
      continue;
    }
    for (below.assign(1, pairs_[k].target); !below.empty();) {
      const int t = below.back();
      below.pop_back();
      if (targets_[t].leaf()) to_points[t].push_back(k);
      else below.insert(below.end(), targets_[t].child, targets_[t].child + 2);
    }
  }
  shares_.clear();
  const auto add = [&](int first_block, int n, std::vector<int>& pairs) {
    if (!pairs.empty()) shares_.push_back({first_block, first_block + blocks_of(n), std::move(pairs)});
  };
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    add(targets_[t].first_block, targets_[t].n_nodes(), to_nodes[t]);
    add(targets_[t].first / far_block, targets_[t].n_points(), to_points[t]);
  }
}

/// Keeps only the pairs of clusters that belong to the part of the sum set by share(). Each part has an equal share of the work. A part contains
/// adjacent source clusters, so that only few parts compute the strengths of a given cluster.
void TreeSum::keep_part() {
  std::ranges::stable_sort(pairs_, {}, &Pair::source);
  long long before = 0, all = 0;
  for (const Pair& pair : pairs_) all += work(pair);
  std::erase_if(pairs_, [&](const Pair& pair) {
    const bool mine = before * parts_ / std::max(all, 1LL) == part_;
    before += work(pair);
    return !mine;
  });
}

/// Marks the source clusters whose Chebyshev nodes need strengths: clusters that interact through their nodes in one of the pairs, and all
/// descendants of these clusters that have nodes.
void TreeSum::mark_sources() {
  const std::vector<Cluster>& all = sources_.all();
  in_use_.assign(all.size(), 0);
  for (const Pair& pair : pairs_)
    if (pair.source_nodes) in_use_[pair.source] = 1;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (in_use_[c] && !all[c].leaf())
      for (const int child : all[c].child)
        if (!all[child].bare) in_use_[child] = 1;
}

void TreeSum::sum(const std::array<const double*, 6>& strengths, double* values) {
  interactions_ = 0;
  spread_strengths(strengths);
  target_u_.assign(target_at_.size() / 3 * out_, 0);
  node_u_.assign(node_at_.size() / 3 * out_, 0);
  has_nodes_.assign(targets_.size(), 0);
  each_item(shares_.size(), [&](std::size_t k) {
    const Share& share = shares_[k];
    for (const int pair : share.pairs) add(pairs_[pair], share.first_block, share.last_block);
  });
  for (const Pair& pair : pairs_) {
    const Cluster &target = targets_[pair.target], &source = sources_.all()[pair.source];
    if (pair.target_nodes) has_nodes_[pair.target] = 1;
    interactions_ += static_cast<long long>(pair.target_nodes ? target.n_nodes() : target.n_points()) *
                     (pair.source_nodes ? source.n_nodes() : source.n_points());
  }
  interpolate_downwards();
  for (const Cluster& t : targets_) {
    if (!t.leaf()) continue;
    for (std::size_t k = t.first; k < static_cast<std::size_t>(t.last); ++k)
      if (const int i = row(k); row_[i])
        for (int c = 0; c < out_; ++c)
          values[static_cast<std::size_t>(out_) * i + c] = target_u_[out_ * far_block * (k / far_block) + far_block * c + k % far_block];
  }
}

/// Copies the source strengths into the order of the tree, and computes the strengths at the Chebyshev nodes of all clusters in use, from the leaves
/// upwards.
void TreeSum::spread_strengths(const std::array<const double*, 6>& strengths) {
  for (int c = 0; c < in_; ++c) {
    q_[c].resize(sources_.order().size());
    for (std::size_t k = 0; k < q_[c].size(); ++k) q_[c][k] = strengths[c][sources_.order()[k]];
    node_q_[c].assign(sources_.n_nodes(), 0);
  }
  const std::vector<Cluster>& all = sources_.all();
  const Charges points = charges(sources_.points(), q_), nodes = charges(sources_.nodes(), node_q_);
  const auto spread_to = [&](const Cluster& c, const Charges& from) {
    std::array<double*, 6> to{};
    for (int d = 0; d < in_; ++d) to[d] = &node_q_[d][c.first_node];
    std::vector<Pack>& scratch = scratch_.mine();
    scratch.resize(std::max(scratch.size(), static_cast<std::size_t>(in_) * c.n_nodes()));
    spread(in_, c, from, scratch.data(), to);
  };
  for (auto level = levels_[0].rbegin(); level != levels_[0].rend(); ++level)
    each_item(level->size(), [&](std::size_t number) {
      const Cluster& c = all[(*level)[number]];
      if (!in_use_[&c - all.data()]) return;
      if (c.leaf())
        spread_to(c, points.part(c.first, c.n_points()));
      else
        for (const int k : c.child)
          spread_to(c, all[k].bare ? points.part(all[k].first, all[k].n_points()) : nodes.part(all[k].first_node, all[k].n_nodes()));
    });
}

/// Marks the rows `wanted` and the target clusters that contain a target of these rows.
void TreeSum::mark_targets(std::span<const int> wanted) {
  row_.assign(n_trees_ * target_tree_.order().size(), 0);
  for (const int i : wanted) row_[i] = 1;
  wanted_.assign(targets_.size(), 0);
  for (std::size_t t = targets_.size(); t-- > 0;) {
    if (targets_[t].leaf())
      for (int k = targets_[t].first; k < targets_[t].last && !wanted_[t]; ++k) wanted_[t] = row_[row(k)];
    else
      wanted_[t] = wanted_[targets_[t].child[0]] || wanted_[targets_[t].child[1]];
  }
}

/// Divides the pair of clusters `target` and `source` recursively, and stores the pairs that are far apart or cannot be divided further. The sources
/// are displaced by the lattice vector images_[image].
void TreeSum::pair_up(const Cluster& target, const Cluster& source, int image) {
  if (!wanted_[&target - targets_.data()]) return;
  const Vec3& beyond = images_[static_cast<std::size_t>(image)];
  const bool source_far = source.serves(target, -beyond), target_far = target.serves(source, beyond);
  const bool many_targets = !target.bare, many_nodes = !source.bare;
  if ((source_far || !many_nodes) && (target_far || !many_targets)) return add_pair(target, many_targets, source, many_nodes, image);
  if (target.leaf() && source.leaf()) return add_pair(target, false, source, false, image);
  const bool source_to_blame = many_nodes && !source_far, target_to_blame = many_targets && !target_far;
  const bool halve_source = source_to_blame == target_to_blame ? source.radius > target.radius : source_to_blame;
  if (target.leaf() || (halve_source && !source.leaf()))
    for (const int child : source.child) pair_up(target, sources_.all()[child], image);
  else
    for (const int child : target.child) pair_up(targets_[child], source, image);
}

void TreeSum::add_pair(const Cluster& target, bool target_nodes, const Cluster& source, bool source_nodes, int image) {
  const auto number = [](const std::vector<Cluster>& all, const Cluster& cluster) { return static_cast<int>(&cluster - all.data()); };
  pairs_.push_back({number(targets_, target), number(sources_.all(), source), image, target_nodes, source_nodes});
}

long long TreeSum::work(const Pair& pair) const {
  const Cluster &target = targets_[pair.target], &source = sources_.all()[pair.source];
  const int n = pair.source_nodes ? source.n_nodes() : source.n_points();
  return static_cast<long long>(blocks_of(pair.target_nodes ? target.n_nodes() : target.n_points())) * n;
}

/// Adds the interactions of a pair at the blocks first_block .. last_block - 1 of the target's Chebyshev nodes or of its targets.
void TreeSum::add(const Pair& pair, int first_block, int last_block) {
  const Cluster& source = sources_.all()[pair.source];
  const bool target_nodes = pair.target_nodes, source_nodes = pair.source_nodes;
  const double* at = (target_nodes ? node_at_ : target_at_).data() + static_cast<std::size_t>(3) * far_block * first_block;
  double* u = (target_nodes ? node_u_ : target_u_).data() + static_cast<std::size_t>(out_) * far_block * first_block;
  const Charges from = source_nodes ? charges(sources_.nodes(), node_q_).part(source.first_node, source.n_nodes())
                                    : charges(sources_.points(), q_).part(source.first, source.n_points());
  const Vec3& beyond = images_[static_cast<std::size_t>(pair.image)];
  double sums[6 * far_block], seen[3 * far_block];
  for (int b = first_block; b < last_block; ++b, at += 3 * far_block, u += out_ * far_block) {
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < far_block; ++l) seen[far_block * c + l] = at[far_block * c + l] - beyond[c];
    kernel_(from, seen, sums);
    for (int l = 0; l < out_ * far_block; ++l) u[l] += sums[l];
  }
}

/// Interpolates the values at the Chebyshev nodes of each target cluster to the nodes of its children. In a leaf, and for a child that has no nodes,
/// interpolates to the targets themselves.
void TreeSum::interpolate_downwards() {
  const std::vector<Cluster>& all = targets_;
  const auto give_to_children = [&](int t) {
    if (!has_nodes_[t]) return;
    const double* from = &node_u_[static_cast<std::size_t>(out_) * far_block * all[t].first_block];
    const auto give = [&](int n, int block, const std::vector<double>& at, std::vector<double>& u) {
      const std::size_t first = static_cast<std::size_t>(far_block) * block;
      interpolate(out_, all[t], from, blocks_of(n), &at[3 * first], &u[out_ * first]);
    };
    const auto give_points = [&](const Cluster& c) { give(c.n_points(), c.first / far_block, target_at_, target_u_); };
    if (all[t].leaf()) return give_points(all[t]);
    for (const int child : all[t].child) {
      if (!wanted_[child]) continue;
      if (all[child].bare) {
        give_points(all[child]);
        continue;
      }
      give(all[child].n_nodes(), all[child].first_block, node_at_, node_u_);
      has_nodes_[child] = 1;
    }
  };
  for (const std::vector<int>& level : levels_[1]) each_item(level.size(), [&](std::size_t k) { give_to_children(level[k]); });
}

}  // namespace tanktread::stokes
