#include "spline/extended_mesh.hpp"

#include <algorithm>

namespace tanktread::spline {

ExtendedMesh::ExtendedMesh(TMesh mesh) : mesh_(std::move(mesh)) {
  const int n = mesh_.lattice->vertices();
  passing_.resize(n);
  covered_.assign(n, {0, 0, 0, 0});
  for (const TJunction& t : t_junctions(mesh_)) add(t.vertex);
}

void ExtendedMesh::keep_extensions() {
  required_ = mesh_.edges;
  for (const auto& [vertex, trace] : traces_)
    for (Ray e : trace.edges) mesh_.lattice->set(required_, e, true);
  missing_.clear();
}

Ray ExtendedMesh::canonical(Ray e) const {
  const Ray reverse = mesh_.lattice->reverse(e);
  return reverse.vertex < e.vertex ? reverse : e;
}

void ExtendedMesh::check_missing(Ray e) {
  if (required_.empty() || !(required_[e.vertex] >> e.slot & 1)) return;
  if (mesh_.edge(e.vertex, e.slot) || covered_[e.vertex][e.slot])
    missing_.erase({e.vertex, e.slot});
  else
    missing_.insert({e.vertex, e.slot});
}

void ExtendedMesh::cover(Ray edge, int by) {
  const Ray e = canonical(edge);
  covered_[e.vertex][e.slot] = std::uint8_t(covered_[e.vertex][e.slot] + by);
  check_missing(e);
}

int ExtendedMesh::conflicts(int v, int heading) const {
  if (mesh_.lattice->valence(v) == 3) return 1;
  int n = 0;
  for (const Passing& p : passing_[v]) n += (p.heading ^ heading) & 1;
  return n;
}

void ExtendedMesh::add(int v) {
  Trace t;
  t.missing = missing_slot(mesh_, v);
  if (t.missing < 0) return;
  auto follow = [&](const std::vector<Ray>& path, bool face) {
    for (Ray e : path) {
      t.edges.push_back(e);
      t.vertices.push_back(step(*mesh_.lattice, e));
      t.face.push_back(face);
    }
  };
  t.vertices.push_back({v, t.missing});
  t.face.push_back(true);
  follow(face_extension(mesh_, {v, t.missing}), true);
  follow(edge_extension(mesh_, {v, t.missing}), false);
  for (std::size_t i = 0; i < t.vertices.size(); ++i) {
    const Ray r = t.vertices[i];
    const int n = conflicts(r.vertex, r.slot);
    crossings_ += n;
    if (n) crossed_.insert(r.vertex);
    passing_[r.vertex].push_back({v, r.slot, t.face[i]});
  }
  for (Ray e : t.edges) cover(e, 1);
  traces_.emplace(v, std::move(t));
}

void ExtendedMesh::erase(int v) {
  const auto found = traces_.find(v);
  const Trace& t = found->second;
  for (Ray e : t.edges) cover(e, -1);
  for (Ray r : t.vertices) {
    auto& here = passing_[r.vertex];
    here.erase(std::find_if(here.begin(), here.end(), [&](const Passing& p) { return p.junction == v; }));
    const int n = conflicts(r.vertex, r.slot);
    crossings_ -= n;
    if (n == 0) continue;
    bool still = false;
    for (const Passing& p : here) still = still || conflicts(r.vertex, p.heading);
    if (!still) crossed_.erase(r.vertex);
  }
  traces_.erase(found);
}

void ExtendedMesh::change(const std::vector<Ray>& path, bool present) {
  std::set<int> touched, affected;
  for (Ray e : path) touched.insert({e.vertex, mesh_.lattice->reverse(e).vertex});
  for (int v : touched)
    for (const Passing& p : passing_[v]) affected.insert(p.junction);
  for (int v : affected) erase(v);
  for (Ray e : path) {
    mesh_.set(e, present);
    check_missing(canonical(e));
  }
  touched.merge(affected);
  for (int v : touched) add(v);
}

std::pair<TJunction, TJunction> ExtendedMesh::crossing(int& cursor) const {
  auto at = crossed_.upper_bound(cursor);
  if (at == crossed_.end()) at = crossed_.begin();
  cursor = *at;
  const auto& here = passing_[*at];
  int lowest[2] = {-1, -1};  // for each axis, the T-junction of lowest index whose extension passes this vertex along the axis; -1 if none
  for (const Passing& p : here) {
    int& low = lowest[p.heading & 1];
    if (low < 0 || p.junction < low) low = p.junction;
  }
  const int a = lowest[0] >= 0 ? lowest[0] : lowest[1], b = lowest[1] >= 0 ? lowest[1] : a;
  return {{a, traces_.at(a).missing}, {b, traces_.at(b).missing}};
}

std::vector<TJunction> ExtendedMesh::around_missing() const {
  const Lattice& l = *mesh_.lattice;
  const auto [v, k] = *missing_.begin();
  std::vector<TJunction> out;
  for (Ray start : {Ray{v, k}, l.reverse({v, k})}) {
    if (l.ends(start.vertex, start.slot)) continue;
    Ray r = step(l, start);  // moves along the line of the missing edge to the first vertex at which the mesh has an edge on this line
    while (!l.ends(r.vertex, r.slot) && l.valence(r.vertex) == 4 && !mesh_.edge(r.vertex, r.slot)) r = step(l, r);
    const auto t = traces_.find(r.vertex);
    if (t != traces_.end() && t->second.missing == ((r.slot + 2) & 3)) out.push_back({r.vertex, t->second.missing});
  }
  return out;
}

const ExtendedMesh::Passing* ExtendedMesh::facing(int v, int heading, int junction) const {
  for (const Passing& p : passing_[v])
    if (p.face && p.junction != junction && p.heading == ((heading + 2) & 3)) return &p;
  return nullptr;
}

std::vector<std::pair<TJunction, TJunction>> ExtendedMesh::facing_pairs(std::size_t most) const {
  std::vector<std::pair<TJunction, TJunction>> found;
  for (const auto& [vertex, trace] : traces_)
    for (std::size_t i = 1; i < trace.vertices.size() && trace.face[i] && found.size() < most; ++i) {
      const Ray r = trace.vertices[i];
      if (!touches(mesh_, r) || (mesh_.edges[r.vertex] & (r.slot & 1 ? 10 : 5))) continue;
      if (const Passing* other = facing(r.vertex, r.slot, vertex))
        found.push_back({{vertex, trace.missing}, {other->junction, traces_.at(other->junction).missing}});
    }
  return found;
}

std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings) {
  const Lattice& l = *mesh.lattice;
  std::vector<int> out;
  if (l.extraordinary.empty()) return out;
  for (Ray e : path) {
    const PlacedEdge edge = placed(l, e);
    for (int corner = 0; corner < 4; ++corner) {
      const int point = l.point_at[edge.face][corner], h = point < 0 ? 1 : mesh.spacing[point];
      if (edge.line() % h == 0 || distances(l, edge, corner)[0] >= rings * h) continue;
      if (std::find(out.begin(), out.end(), point) == out.end()) out.push_back(point);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point) {
  const Lattice& l = *mesh.lattice;
  const int P = l.extraordinary[point], h = mesh.spacing[point];
  std::vector<std::vector<Ray>> out;
  for (int s = 0; s < 3; ++s)
    for (int at : {h / 2, 3 * h / 2})
      for (int turn : {1, 3}) {  // turns to the left and right of the mesh line from the extraordinary point
        Ray r{P, s};
        for (int i = 0; i < at; ++i) r = step(l, r);
        r.slot = (r.slot + turn) & 3;
        std::vector<Ray> path;
        for (int i = 0; i < 2 * h; ++i, r = step(l, r)) path.push_back(r);
        out.push_back(std::move(path));
      }
  return out;
}

int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings) {
  int halvings = 0;
  while (!paths.empty()) {
    const auto path = std::move(paths.back());
    paths.pop_back();
    for (auto broken = broken_zones(extended.mesh(), path, rings); !broken.empty(); broken = broken_zones(extended.mesh(), path, rings))
      for (int point : broken) {
        for (auto& cut : two_ring_cuts(extended.mesh(), point)) {
          extended.insert(cut);
          paths.push_back(std::move(cut));
        }
        extended.set_spacing(point, extended.mesh().spacing[point] / 2);
        ++halvings;
      }
  }
  return halvings;
}

}  // namespace tanktread::spline
