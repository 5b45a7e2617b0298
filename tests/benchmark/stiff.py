#!/usr/bin/python3
"""Schemes of time integration against each other: error in D over the run against velocity evaluations and against
seconds, scene by scene.

    tests/benchmark/stiff.py build/release/app/tanktread results/stiff --elements 6

Runs every scene below by every scheme at several tolerances and once by tr-bdf2 at 1e-7, the reference. Results are
kept, and a run that has been made already is not made again; `--scenes` and `--schemes` choose. The table says what
each scheme needs for an error of 1e-3, 2e-4 and 5e-5 (between runs: by their logarithms), in evaluations and in
seconds, over the best scheme. Seconds are those of the integration, without diagnostics and output.
"""

import argparse
import pathlib
import sys

from package import answer, numpy, plt, style, tanktread

DECK = "inputs/shear_neo_hookean.yaml"  # of which every scene changes what it has otherwise
SHEAR, HYPERBOLIC = {"Flow/type": "simple shear"}, {"Flow/type": "planar hyperbolic"}


def membrane(law, ca, c=None, alpha=0):
    settings = {"Membrane/law": law, "Membrane/capillary number": ca, "Membrane/pre-inflation": alpha}
    return settings | ({"Membrane/area dilatation": c} if c is not None else {})


SCENES = {"A": ("neo-Hookean, shear, Ca = 0.3", SHEAR | membrane("neo-Hookean", 0.3), 7.5),
          "B": ("neo-Hookean, shear, Ca = 0.6", SHEAR | membrane("neo-Hookean", 0.6), 6.0),
          "C": ("Skalak C = 1, hyperbolic, Ca = 0.6", HYPERBOLIC | membrane("Skalak", 0.6, 1.0), 4.0),
          "D": ("Skalak C = 1, shear, Ca = 0.05, inflated by 5 %", SHEAR | membrane("Skalak", 0.05, 1.0, 0.05), 3.0),
          "G": ("neo-Hookean, shear, Ca = 0.02, inflated by 5 %", SHEAR | membrane("neo-Hookean", 0.02, None, 0.05),
                2.0), "E": ("Skalak C = 100, shear, Ca = 0.3", SHEAR | membrane("Skalak", 0.3, 100.0), 3.0),
          "L": ("neo-Hookean, shear, Ca = 0.3, viscosity ratio 5",
                SHEAR | membrane("neo-Hookean", 0.3) | {"Particle/viscosity ratio": 5.0}, 4.0),}

CN = {"Time/scheme": "crank-nicolson"}
SCHEMES = {
    "tr-bdf2": {"Time/scheme": "tr-bdf2"},
    "bdf3": {"Time/scheme": "bdf3"},
    "bs3": {"Time/scheme": "bs3"},
    "rkc2": {"Time/scheme": "rkc2"},
    "auto": {"Time/scheme": "auto"},
    "CN, paper": CN,
    "CN, Anderson": CN | {"Time/nonlinear solver": "anderson"},
    "CN, Newton-Krylov": CN | {"Time/nonlinear solver": "newton-krylov"},
}
TOLERANCES = [1e-3, 3e-4, 1e-4, 3e-5]
LEVELS = [1e-3, 2e-4, 5e-5]


def settings_of(scene, elements, time):
    end = SCENES[scene][2]
    return {"Surface/elements per side": elements, "Output/interval": end,
            "Time/final time": end} | SCENES[scene][1] | time


def error(result, reference):
    """Largest difference in D over the run; cubic through the four nearest steps of the reference, which are much
    shorter."""
    t, d, at = reference.series["time"], reference.series["taylor_inertia"], result.series["time"]
    first = numpy.clip(numpy.searchsorted(t, at) - 2, 0, len(t) - 4)
    value = numpy.zeros_like(at)
    for i in range(4):
        weight = numpy.ones_like(at)
        for j in range(4):
            if i != j:
                weight *= (at - t[first + j]) / (t[first + i] - t[first + j])
        value += weight * d[first + i]
    return numpy.max(numpy.abs(result.series["taylor_inertia"] - value))


def seconds(result):
    return sum(value for name, value in result.phases.items() if name not in ("diagnostics", "output"))


def points(scene, scheme, study, elements, reference):
    """(error, evaluations, seconds, steps) of every run of a scheme, loose to tight."""
    found = []
    for tolerance in TOLERANCES if not scheme.startswith("CN") else [1e-4] if scheme == "CN, paper" else [1e-3, 1e-4]:
        time = SCHEMES[scheme] | {"Time/tolerance": tolerance}
        if scheme == "CN, paper":
            time |= {"Time/initial step": 0.01 * SCENES[scene][1]["Membrane/capillary number"]}
        result = study.run(DECK, settings_of(scene, elements, time))
        if not result.done:
            continue
        counts = result.counts
        found.append((error(result, reference), counts["evaluations"], seconds(result), counts["steps"]))
        print(f"  {scheme:18s} {tolerance:8.0e}  error {found[-1][0]:.2e}  steps {counts['steps']:5d}  evaluations "
              f"{counts['evaluations']:6d}  assemblies {counts['assemblies']:2d}  solves "
                                              f"{counts['linear_solves']:5d}  iterations "
                                              f"{counts['solver_iterations']:6d}  {found[-1][2]:8.3f} s",
              flush=True)
    return found


def cost_at(level, runs, column):
    """Least cost of an error of at most `level`, on the polygon through the runs in the plane of logarithms; not a
    number if none is so good."""
    good = [p for p in runs if p[0] <= level]
    if not good:
        return numpy.nan
    best = min(p[column] for p in good)
    for p, q in zip(runs, runs[1:]):
        if p[0] > level >= q[0] and q[0] > 0:
            weight = numpy.log(p[0] / level) / numpy.log(p[0] / q[0])
            best = min(best, numpy.exp((1 - weight) * numpy.log(p[column]) + weight * numpy.log(q[column])))
    return best


def table(scene, found):
    for column, name in ((1, "evaluations"), (2, "seconds")):
        print(f"{scene}: {name} for an error of " + ", ".join(f"{level:g}" for level in LEVELS) + ", over the best")
        costs = {scheme: [cost_at(level, runs, column) for level in LEVELS] for scheme, runs in found.items() if runs}
        least = numpy.nanmin(list(costs.values()), axis=0)
        for scheme, row in costs.items():
            print(f"  {scheme:18s}" + "".join(f"  {cost:9.3g} ({cost / best:6.2f})" for cost, best in zip(row, least)),
                  flush=True)


def draw(panels, column, label, path):
    columns = min(3, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.6 * columns, 3.1 * rows), squeeze=False)
    colors = {scheme: style.RUNS[i % len(style.RUNS)] for i, scheme in enumerate(SCHEMES)}
    for axis, (scene, found) in zip(axes.flat, panels.items()):
        for i, (scheme, runs) in enumerate(found.items()):
            if runs:
                axis.loglog([p[column] for p in runs], [p[0] for p in runs], color=colors[scheme],
                            marker=style.MARKS[list(SCHEMES).index(scheme) % 6], ms=4,
                            lw=1.8 if scheme == "auto" else 1, ls="--" if scheme.startswith("CN") else "-",
                            label=scheme)
        axis.set_title(f"{scene}: {SCENES[scene][0]}", fontsize=8)
        axis.set(xlabel=label, ylabel="largest error in D")
    for axis in list(axes.flat)[len(panels):]:
        axis.set_axis_off()
    axes.flat[0].legend(fontsize=7)
    style.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program tanktread")
    parser.add_argument("results", type=pathlib.Path, help="directory that the runs are kept in")
    parser.add_argument("--elements", type=int, default=6, help="elements per side (default: %(default)s)")
    parser.add_argument("--scenes", default=",".join(SCENES), help="letters (default: %(default)s)")
    parser.add_argument("--schemes", default=None, help="names, separated by semicolons (default: all)")
    parser.add_argument("-o", "--output", default="stiff", metavar="NAME",
                        help="pictures NAME_evaluations.png and NAME_seconds.png (default: %(default)s)")
    arguments = parser.parse_args()
    study = tanktread.Study(arguments.program, arguments.results, limit=900)
    schemes = arguments.schemes.split(";") if arguments.schemes else list(SCHEMES)
    panels = {}
    for scene in arguments.scenes.split(","):
        print(f"{scene}: {SCENES[scene][0]}, {6 * arguments.elements ** 2 + 2} control points", flush=True)
        best = {"Time/scheme": "tr-bdf2", "Time/tolerance": 1e-7}
        reference = study.run(DECK, settings_of(scene, arguments.elements, best))
        if not reference.done:
            sys.exit(f"stiff.py: there is no reference for {scene}")
        panels[scene] = {scheme: points(scene, scheme, study, arguments.elements, reference) for scheme in schemes}
        table(scene, panels[scene])
    draw(panels, 1, "velocity evaluations", f"{arguments.output}_evaluations.png")
    draw(panels, 2, "seconds", f"{arguments.output}_seconds.png")


answer(main)
