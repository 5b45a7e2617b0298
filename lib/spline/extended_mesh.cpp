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
    for (Ray e : trace.edges) {
      required_[e.vertex] |= std::uint8_t(1 << e.slot);
      required_[mesh_.lattice->neighbour[e.vertex][e.slot]] |= std::uint8_t(1 << mesh_.lattice->back[e.vertex][e.slot]);
    }
  missing_.clear();
}

Ray ExtendedMesh::canonical(Ray e) const {
  const int w = mesh_.lattice->neighbour[e.vertex][e.slot];
  return w < e.vertex ? Ray{w, mesh_.lattice->back[e.vertex][e.slot]} : e;
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
    for (std::size_t i = 0; i < path.size(); ++i) {
      t.edges.push_back(path[i]);
      t.vertices.push_back(step(*mesh_.lattice, path[i]));
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
  const Lattice& l = *mesh_.lattice;
  std::vector<int> touched, affected;
  for (Ray e : path) {
    touched.push_back(e.vertex);
    touched.push_back(l.neighbour[e.vertex][e.slot]);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (int v : touched)
    for (const Passing& p : passing_[v]) affected.push_back(p.junction);
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  for (int v : affected) erase(v);

  for (Ray e : path) {
    const int w = l.neighbour[e.vertex][e.slot], b = l.back[e.vertex][e.slot];
    if (present) {
      mesh_.edges[e.vertex] |= std::uint8_t(1 << e.slot);
      mesh_.edges[w] |= std::uint8_t(1 << b);
    } else {
      mesh_.edges[e.vertex] &= std::uint8_t(~(1 << e.slot));
      mesh_.edges[w] &= std::uint8_t(~(1 << b));
    }
    check_missing(canonical(e));
  }

  std::vector<int> again;
  std::set_union(touched.begin(), touched.end(), affected.begin(), affected.end(), std::back_inserter(again));
  for (int v : again) add(v);
}

std::pair<TJunction, TJunction> ExtendedMesh::crossing(int& cursor) const {
  auto at = crossed_.upper_bound(cursor);
  if (at == crossed_.end()) at = crossed_.begin();
  cursor = *at;
  const auto& here = passing_[*at];
  int lowest[2] = {-1, -1};  // of each axis
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
  for (Ray start : {Ray{v, k}, Ray{l.neighbour[v][k], l.back[v][k]}}) {
    // Look along the line behind the edge: the first vertex with an edge on the line.
    if (l.ends(start.vertex, start.slot)) continue;
    Ray r = step(l, start);
    while (!l.ends(r.vertex, r.slot) && l.valence(r.vertex) == 4 && !mesh_.edge(r.vertex, r.slot)) {
      r = step(l, r);
    }
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

bool ExtendedMesh::overlap(TJunction& a, TJunction& b) const {
  for (const auto& [vertex, trace] : traces_)
    for (std::size_t i = 1; i < trace.vertices.size() && trace.face[i]; ++i) {
      const Ray r = trace.vertices[i];
      const int along = r.slot & 1 ? 10 : 5;
      if (!touches(mesh_, r) || (mesh_.edges[r.vertex] & along)) continue;
      if (const Passing* other = facing(r.vertex, r.slot, vertex)) {
        a = {vertex, trace.missing};
        b = {other->junction, traces_.at(other->junction).missing};
        return true;
      }
    }
  return false;
}

int ExtendedMesh::overlaps() const {
  int n = 0;
  for (const auto& [vertex, trace] : traces_)
    for (std::size_t i = 1; i < trace.vertices.size() && trace.face[i]; ++i) {
      const Ray r = trace.vertices[i];
      if (touches(mesh_, r) && !(mesh_.edges[r.vertex] & (r.slot & 1 ? 10 : 5)) && facing(r.vertex, r.slot, vertex)) ++n;
    }
  return n / 2;
}

}  // namespace tanktread::spline
