#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "record/duct_picture.hpp"
#include "record/plan.hpp"
#include "scene/series/series.hpp"
#include "scene/series/run_totals.hpp"

namespace tanktread {

namespace {

/// Description of a field of the snapshots or of an entry of the summary.
struct Entry {
  const char *name, *unit, *of, *description;
};

constexpr Entry fields[] = {
    {"Points", "length", "all", "places of the surface"},
    {"Normals", "1", "all", "unit normals, out of the particle"},
    {"load", "force/length^2", "capsule, drop",
     "load of the fluids on the membrane, per unstressed area (3.7) or per present area (3.6), as Membrane/load measure says"},
    {"traction", "force/length^2", "all", "the load per present area; of a rigid body alone the traction on it, among others "
     "the load of (2.23)"},
    {"displacement", "length", "capsule, drop", "x - X from the unstressed shape"},
    {"velocity", "length/time", "capsule, drop, free body", "of the fluids on the surface; of a free body its own"},
    {"smallest tension", "1", "capsule, drop",
     "smaller principal tension of the law (3.2), without that of the whole area (3.26), over G_s, of a drop over sigma"},
    {"largest tension", "1", "capsule, drop", "the larger one"},
    {"mean curvature", "1/length", "capsule, drop", "chi = 1/2 div n (P-36), 1/R of a sphere"},
    {"concentration", "1", "drop with surfactant", "of surfactant over the initial one"},
    {"particle", "1", "several particles", "number of the particle, from 1 in the order of the deck"},
    {"into cell", "length", "in a Domain", "what takes the particle from where it has come to into the cell around the origin, of vectors cell_#"},
    {"mode k", "1", "capsule, drop", "displacement of mode k of a spectrum, at its largest 1; of one that oscillates its real part"},
    {"mode k imaginary", "1", "capsule, drop", "its imaginary part"},
    {"pressure", "force/length^2", "prescribed body",
     "p = -t.n of the traction t on the body, its mean over the surface as of the exact solution"},
    {"position error", "length", "with requested accuracy", "estimated error of the position of the surface, along its normal (9.1)"},
    {"pressure error", "force/length^2", "prescribed body", "p - p_exact, where the exact solution is known"},
};

constexpr Entry entries[] = {
    {"status", "", "all", "why the run ended: `done`, `steady`, `past` (Time/end when past), `stopped: ` by what, `failed: ` and the reason"},
    {"final", "", "all", "last value of every series; of a prescribed body also the vectors `drag` and `torque`"},
    {"final in SI", "", "all", "the same in SI units, with the list Units, as texts: a number and its unit"},
    {"expect", "", "all", "of every Expect: name, value found, value expected, error, with requested accuracy also the estimated error, and whether "
     "it passed"},
    {"estimated errors", "", "without requested accuracy", "errors of time integration and of quadrature; the error of the mesh is unknown"},
    {"error", "", "with requested accuracy", "last value of the estimated error of every series; `/error/<name>` in `run.h5` has all values"},
    {"accuracy", "", "with requested accuracy", "requests with their estimated errors, and the levels with their settings and seconds"},
    {"counts", "1", "all", "work of the whole run"},
    {"counts/unknowns", "1", "prescribed body", "unknowns of the traction"},
    {"counts/solver_iterations_in_all", "1", "prescribed body", "with those of the solves that correct the forces (2.11)"},
    {"seconds", "s", "all", "wall time of the first rank by phase, which add up to the run's"},
    {"memory", "bytes", "all", "the most that a process has had: `largest of a rank`, and of all together, `all ranks`"},
    {"plan", "", "all", "what the run chose to compute, a line each"},
    {"numbers", "", "all", "derived and dimensionless numbers of the scene, below"},
    {"modes", "", "capsule, drop", "of each mode of the last spectrum: `shape`, or `translation`, `rotation`, `volume`, which change none"},
    {"warnings", "", "all", "edges of the method that the run came near to, a sentence each"},
};

/// Kind of runs or particles that have the same columns. If `extends`, the manual lists only the columns that the previous kind does not have.
struct Kind {
  const char* name;
  Columns columns;
  bool extends = false;
};

std::vector<Kind> kinds() {
  Scene deforming, free, free_in_tube, prescribed, several, returning;
  free.particle.motion = free_in_tube.particle.motion = Motion::free, prescribed.particle.motion = Motion::prescribed;
  free_in_tube.tube.present = true;
  several.particles.resize(1), returning.periodic.present = true;
  Scene among_others = free;
  among_others.name = "one";
  Columns capsule = run_columns(deforming, true), spectrum, branch, folds, periodic;
  capsule.append(particle_columns(deforming, true));
  motion::add_columns(std::vector<motion::Mode>(), false, spectrum);
  motion::Mode().add_columns("k", spectrum);
  motion::BranchPoint().add_columns(false, branch), motion::BranchPoint().add_columns(true, folds);
  SteadyRow().add_columns(returning, periodic);
  return {{"capsule, drop", capsule},
          {"rigid one of several", particle_columns(among_others, true)},
          {"free body", run_columns(free, true)},
          {"free body in a tube", run_columns(free_in_tube, true), true},
          {"prescribed body", run_columns(prescribed, true)},
          {"spectrum of a capsule or drop", spectrum},
          {"branch of steady shapes", branch},
          {"folds in a second parameter", folds, true},
          {"periodic motion", periodic},
          {"several particles together", run_columns(several, true)}};
}

/// Returns the columns of all kinds of runs and particles, and for each column name the kinds that have it.
std::pair<Columns, std::map<std::string, std::string>> all_columns() {
  std::map<std::string, std::string> owners;
  std::set<std::string> before, here;
  Columns all;
  for (const Kind& kind : kinds()) {
    before = std::exchange(here, {});
    for (Column column : kind.columns.all()) {
      std::string& of = owners[column.name];
      if (!here.insert(column.name).second || (kind.extends && before.contains(column.name))) continue;
      if (of.empty()) column.undefined_if.clear(), all.add(0, column);
      of += (of.empty() ? "" : ", ") + std::string(kind.name);
    }
  }
  put_in_order(all);
  return {all, owners};
}

std::string line(std::string_view name, std::string_view unit, std::string_view of, std::string description) {
  for (size_t at = 0; (at = description.find('|', at)) != description.npos; at += 2) description.insert(at, 1, '\\');
  return "| `" + std::string(name) + "` | " + std::string(unit) + (of.empty() ? "" : " | " + std::string(of)) + " | " + description + " |\n";
}

template <class List>
std::string table(const char* heading, const List& list) {
  std::string text = std::string("\n| ") + heading + " | unit | of | what it is |\n|---|---|---|---|\n";
  for (const Entry& one : list) text += line(one.name, one.unit, one.of, one.description);
  return text;
}

}  // namespace

std::string series_manual(const Registry& registry) {
  surface::TubeOptions circle;
  circle.radius = 1;
  std::string text =
      "# What comes out\n\nPrinted by `tanktread --reference-series`. Units are those of the deck; with its list Units every series has an attribute "
      "`SI` that says what its unit is, `1e-06 m/s`. Equation numbers are those of "
      "[lib/README.md](../lib/README.md).\n\n## Series\n\n`/series/<name>` in `run.h5`, of one of several particles "
      "`/series/<particle>/<name>`, a value a finished step and one for the start; "
      "`Expect` takes all of "
      "these names. D, inclination and tank-treading are measured in the plane of the flow, which the plan names: x1 x3 but for a `linear` "
      "flow "
      "in another plane, whose two directions then stand for x1 and x3. A series whose description has the words `NaN if` may be undefined: it is "
      "NaN under that condition, and an `Expect` at such a time is missed. NaN in any other series ends the run.\n\n"
      "| series | unit | of | what it is |\n|---|---|---|---|\n";
  const auto [all, owners] = all_columns();
  for (const Column& one : all.all())
    text += line(one.name, one.unit, (one.where.empty() || one.where[0] == ';' ? owners.at(one.name) : "") + one.where, one.description);
  const auto add = [&text](const std::vector<Column>& columns, const char* of) {
    for (const Column& one : columns) text += line(one.name, one.unit, of, one.description);
  };
  add(registry.loads.columns(), "Membrane/loads");
  add(registry.fields.columns(), "Interface/fields");
  add(registry.series.columns(), "Output/series");
  text += "\n## Fields\n\n`/VTKHDF` in `snapshot_<step>.hdf`, at the nodes of the picture.\n" + table("field", fields);
  text += "\n## The empty tube\n\n`duct.h5`, of a run in a tube.\n\n| array | unit | what it is |\n|---|---|---|\n";
  for (const output::Array& one : duct_picture(stokes::DuctFlow(circle, 1, 1)))
    text += line(one.name, one.unit, "", one.description);
  text += "\n## Summary\n\n`summary.yaml`.\n" + table("entry", entries);
  const RunTotals none;
  each_count(none, [&](const char* name, const char* of, const char* description, auto) {
    text += line("counts/" + std::string(name), "1", of, description);
  });
  text +=
      "\n## Numbers\n\n`numbers` of the summary and of the plan, where they have a meaning.\n\n| number | unit | what it is "
      "|\n|---|---|---|\n";
  for (const Number& one : all_numbers()) text += line(one.name, one.unit, "", one.description);
  return text;
}

}  // namespace tanktread
