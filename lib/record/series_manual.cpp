#include "record/series_manual.hpp"

#include <map>
#include <ranges>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "deck/words.hpp"
#include "motion/spectrum.hpp"
#include "record/duct_arrays.hpp"
#include "record/numbers.hpp"
#include "scene/series/series.hpp"
#include "scene/series/run_totals.hpp"

namespace tanktread {

namespace {

/// Description of a field of the snapshots or of an entry of the summary. `of`: runs or particles for which it is recorded.
struct Entry {
  const char *name, *unit, *of, *description;
};

constexpr Entry fields[] = {
    {"Points", "length", "all", "position of the surface"},
    {"Normals", "1", "all", "unit normal of the surface, out of the particle"},
    {"load", "force/length^2", "capsule, drop",
     "load of the fluids on the membrane, force per unstressed area (3.7) or per current area (3.6), depending on Membrane/load measure"},
    {"traction", "force/length^2", "all",
     "load of the fluids on the membrane per current area; for a rigid body the traction on it, but with Solvers/rigid bodies `second "
     "kind` for one of several bodies the load Delta f of equation (2.23)"},
    {"displacement", "length", "capsule, drop", "displacement x - X of the surface from the unstressed shape X"},
    {"velocity", "length/time", "capsule, drop, free body",
     "velocity of the surface; for a free rigid body the velocity of its rigid motion"},
    {"smallest tension", "1", "capsule, drop",
     "smaller principal tension of the membrane (3.2), divided by the surface shear modulus, for a drop by the surface tension; includes "
     "the tension of Membrane/global area dilatation (3.26) and that of a surfactant"},
    {"largest tension", "1", "capsule, drop", "larger principal tension of the membrane, divided like `smallest tension`"},
    {"mean curvature", "1/length", "capsule, drop", "mean curvature 1/2 div n, with the unit normal n; 1/R for a sphere of radius R"},
    {"concentration", "1", "drop with surfactant", "concentration of surfactant divided by the initial concentration"},
    {"particle", "1", "several particles", "index of the particle, from 1 in the order of the deck"},
    {"into cell", "length", "in a Domain",
     "displacement that moves the particle from its position into the periodic cell around the origin, whose vectors are the series "
     "cell_#"},
    {"mode k", "1", "capsule, drop",
     "displacement of eigenmode k of the Spectrum, scaled to a largest displacement of 1; real part of an oscillating mode"},
    {"mode k imaginary", "1", "capsule, drop", "imaginary part of the displacement of the oscillating eigenmode k of the Spectrum"},
    {"pressure", "force/length^2", "prescribed body",
     "pressure p = -t.n on the rigid body, with the traction t and the normal n; its mean over the surface equals the mean of the exact "
     "solution, if that is known"},
    {"position error", "length", "with requested accuracy", "estimated error of the position of the surface, along its normal (9.1)"},
    {"pressure error", "force/length^2", "prescribed body",
     "error p - p_exact of the pressure on the rigid body, if the exact solution is known"},
};

std::string in_code(const char* word) { return "`" + std::string(word) + "`"; }

const std::string status_words = "why the run ended: " + in_code(output::run_status::done) + ", " + in_code(output::run_status::steady) + ", " +
                                 in_code(output::run_status::past) + " (Time/end when past), " + in_code(output::run_status::by_signal) + ", " +
                                 in_code(output::run_status::by_clock) + ", or " + in_code(output::run_status::failed) + " and the reason";

/// Returns the description of the kinds of eigenmodes.
std::string mode_words() {
  std::vector<std::string> others;
  for (const std::string& kind : motion::mode_kinds | std::views::drop(1)) others.push_back(in_code(kind.c_str()));
  return "kind of each eigenmode of the last spectrum: " + in_code(motion::mode_kinds.front().c_str()) + " changes the shape, " +
         deck::joined(others, " and ") + " do not";
}
const std::string kinds_of_modes = mode_words();

const Entry entries[] = {
    {"status", "", "all", status_words.c_str()},
    {"final", "", "all", "last value of every series; for a prescribed body also the vectors `drag` and `torque`"},
    {"final in SI", "", "all", "last value of every series in SI units, as a text with number and unit, if the deck has the section Units"},
    {"expect", "", "all",
     "for each expectation of the section Expect: name, computed value, expected value, error, with requested accuracy also the estimated "
     "error, and whether it is met"},
    {"estimated errors", "", "without requested accuracy",
     "errors of time integration and of quadrature; the error of the mesh is unknown"},
    {"error", "", "with requested accuracy",
     "last value of the estimated error of every series; `/error/<name>` in `run.h5` has all values"},
    {"accuracy", "", "with requested accuracy",
     "accuracy requests with their estimated errors, and the levels with their settings and wall-clock seconds"},
    {"counts", "1", "all", "amount of work of the whole run: the entries `counts/...` below"},
    {"counts/unknowns", "1", "prescribed body", "number of unknowns of the traction on the body"},
    {"seconds", "s", "all", "wall-clock time of the first MPI rank in each phase of the run; the sum is the time of the run"},
    {"memory", "bytes", "all", "largest memory in use: `largest of a rank` is the maximum over the MPI ranks, `all ranks` the sum"},
    {"plan", "", "all", "methods and parameters that the run chose, one line each"},
    {"numbers", "", "all", "derived and dimensionless quantities of the scene, listed below"},
    {"modes", "", "capsule, drop", kinds_of_modes.c_str()},
    {"warnings", "", "all", "limits of the method that the run came close to, one sentence each"},
    {"obstacles", "", "runs whose error cannot be estimated", "reasons for this, such as wrinkles that the mesh does not represent"},
};

/// Kind of runs or particles that have the same columns. If `extends`, the manual lists only the columns that the previous kind does not have.
struct Kind {
  const char* name;
  Columns columns;
  bool extends = false;
};

std::vector<Kind> kinds() {
  Scene deforming, free, free_in_tube, prescribed, several, returning;
  for (Scene* scene : {&deforming, &free, &free_in_tube, &prescribed, &returning, &several}) {
    scene->particles.resize(scene == &several ? 2 : 1);
    for (ParticleKind& kind : scene->particles) kind.surface.elements_per_side = 6;  // Scene::by_tractions asks for the number of points
  }
  free.particles.front().particle.motion = free_in_tube.particles.front().particle.motion = Motion::free;
  prescribed.particles.front().particle.motion = Motion::prescribed;
  free_in_tube.tube.present = true;
  several.particles.front().name = "one", returning.periodic.present = true;
  ParticleScene among_others = free.first();
  among_others.name = "one";
  Columns capsule = run_columns(deforming, true), spectrum, branch, folds, periodic;
  capsule.append(particle_columns(deforming.first(), true));
  motion::add_columns(std::vector<motion::Mode>(), 0, false, spectrum);
  motion::add_columns(std::complex<double>(), "k", spectrum);
  motion::BranchPoint().add_columns(false, branch), motion::BranchPoint().add_columns(true, folds);
  SteadyRow().add_columns(returning, periodic);
  return {{"capsule, drop", capsule},
          {"one of several rigid bodies", particle_columns(among_others, true)},
          {"free body", run_columns(free, true)},
          {"free body in a tube", run_columns(free_in_tube, true), true},
          {"prescribed body", run_columns(prescribed, true)},
          {"spectrum of a capsule or drop", spectrum},
          {"branch of steady shapes", branch},
          {"folds in a second parameter", folds, true},
          {"periodic motion", periodic},
          {"all particles together", run_columns(several, true)}};
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
  std::string text = std::string("\n| ") + heading + " | unit | recorded for | description |\n|---|---|---|---|\n";
  for (const Entry& one : list) text += line(one.name, one.unit, one.of, one.description);
  return text;
}

}  // namespace

Columns columns_of_all_runs() { return all_columns().first; }

std::string series_manual(const Registry& registry) {
  surface::TubeOptions circle;
  circle.radius = 1;
  std::string text =
      "# Output\n\nPrinted by `tanktread --reference-series`. Units are those of the deck. If the deck has the section Units, every series has "
      "an attribute `SI` with its SI unit, for example `1e-06 m/s`. Equation numbers refer to [lib/README.md](../lib/README.md).\n\n"
      "## Series\n\nThe data set `/series/<name>` in `run.h5` (for one of several particles `/series/<particle>/<name>`) has one value at the "
      "start and one per accepted time step. `Expect` accepts all of these names. The Taylor parameter, the inclination and tank-treading are "
      "measured in the plane of the flow, which the plan states. It is x1 x3, except for a `linear` flow in another plane, whose two directions "
      "then replace x1 and x3. A series whose description contains `NaN if` is NaN under that condition, and an `Expect` at such a time is "
      "missed. NaN in any other series ends the run.\n\n"
      "| series | unit | recorded for | description |\n|---|---|---|---|\n";
  const auto [all, owners] = all_columns();
  for (const Column& one : all.all())
    text += line(one.name, one.unit, (one.where.empty() || one.where[0] == ';' ? owners.at(one.name) : "") + one.where, one.description);
  const auto add = [&text](const std::vector<Column>& columns, const char* of) {
    for (const Column& one : columns) text += line(one.name, one.unit, of, one.description);
  };
  add(registry.loads.columns(), "Membrane/loads");
  add(registry.fields.columns(), "Interface/fields");
  add(registry.series.columns(), "Output/series");
  add(registry.equations.columns(), "Equations");
  text += "\n## Fields\n\nThe group `/VTKHDF` in `snapshot_<step>.hdf`, at the nodes of the snapshot.\n" + table("field", fields);
  text += "\n## The empty tube\n\nThe file `duct.h5` of a run in a tube.\n\n| array | unit | description |\n|---|---|---|\n";
  for (const output::Array& one : duct_arrays(stokes::DuctFlow(circle, 1, 1)))
    text += line(one.name, one.unit, "", one.description);
  text += "\n## The empty channel\n\nThe file `channel.h5` of a run in a channel. A periodic channel has no arrays whose names begin with "
          "`wall_`.\n\n| array | unit | description |\n|---|---|---|\n";
  for (const output::Array& one : described_channel_arrays()) text += line(one.name, one.unit, "", one.description);
  text += "\n## Summary\n\nThe file `summary.yaml`.\n" + table("entry", entries);
  const RunTotals none;
  each_count(none, [&](const char* name, const char* of, const char* description, auto) {
    text += line("counts/" + std::string(name), "1", of, description);
  });
  text +=
      "\n## Numbers\n\nThe entry `numbers` of the summary and of the plan. A number is left out if it is not defined for the scene.\n\n"
      "| number | unit | description |\n|---|---|---|\n";
  for (const Number& one : all_numbers()) text += line(one.name, one.unit, "", one.description);
  return text;
}

}  // namespace tanktread
