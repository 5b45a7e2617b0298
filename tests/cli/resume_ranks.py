#!/usr/bin/python3
# ranks: 3
# Tests that a run resumed on another number of ranks gives the result of one rank: far sum by clusters, refinement,
# tube, drop.
# With the third argument `all`, tests every number of ranks from one to four, and prints the largest differences.
import shutil
import sys

import numpy

from harness import check, deck, main, run, series

NUMBERS = (1, 2, 3, 4) if "all" in sys.argv[3:] else (1, 3)
COMMON = """
  Time: {fixed step: 0.02, final time: 0.12}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.04}
"""
CLUSTERS = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {viscosity ratio: 2.0}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 5}
  Quadrature: {far sum: tree}
  Symmetry: {use: none}
"""
REFINED = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Membrane: {law: Skalak, capillary number: 0.6}
  Surface: {elements per side: 4, extraordinary points: catmull-clark}
  Adaptation: {enabled: true, surface tolerance: 1.0e-5, levels: 2}
"""
TUBE = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 10, axial elements: 10}
  Particle: {radius: 0.6, center: [0.0, 0.05, -0.15]}
  Membrane: {law: Skalak, capillary number: 0.1, pre-inflation: 0.02}
  Surface: {elements per side: 3}
"""
DROP = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {viscosity ratio: 2.0}
  Membrane: {law: surface tension, capillary number: 0.2}
  Surface: {elements per side: 4}
"""
OWN = ("wall_seconds", "solver_iterations", "velocity_iterations")  # depend on the machine or on the order of summation


def _names(results):
    import h5py

    with h5py.File(f"{results}/run.h5", "r") as file:
        return [name for name in file["series"] if name not in OWN and not name.startswith("kernel_evaluations")]


def _off(one, other):
    """Returns the largest difference of all series. A difference is divided by the largest value of the series if that
    is above 1."""
    worst = 0.0, "none"
    check(_names(one) == _names(other), one, other, "other series")
    for name in _names(one):
        a, b = series(one, name), series(other, name)
        check(a.shape == b.shape, f"{other}: {name} has {len(b)} rows, not {len(a)}")
        worst = max(worst, (float(numpy.nanmax(abs(a - b), initial=0) / max(1, numpy.nanmax(abs(a), initial=0))), name))
    return worst


def _compare(scene, text):
    deck(text + COMMON)
    for ranks in NUMBERS:
        run("deck.yaml", "--output", f"whole_{ranks}", "--quiet", ranks=ranks)
        run("deck.yaml", "--output", f"half_{ranks}", "--set", "Time/final time=0.08", "--quiet", ranks=ranks)
    for ranks in NUMBERS:
        _check(scene, f"{ranks} from the start", f"whole_{ranks}")
        for then in NUMBERS:
            if then == ranks:
                continue
            shutil.copytree(f"half_{ranks}", f"from_{ranks}_on_{then}")
            run("--resume", f"from_{ranks}_on_{then}", "--set", "Time/final time=0.12", "--quiet", ranks=then)
            _check(scene, f"{ranks}, then {then}", f"from_{ranks}_on_{then}")


def _check(scene, how, results):
    off, name = _off("whole_1", results)
    print(f"  {scene:10} on {how:20} {off:.1e} {name}")
    check(off <= 1e-10, f"{scene} on {how}: {name} differs by {off:.2e}")


def clusters():
    _compare("clusters", CLUSTERS)


def a_mesh_that_changes():
    _compare("refined", REFINED)
    check(len(set(series("whole_1", "n_control_points"))) > 1, "the mesh never changed")


def a_tube():
    _compare("tube", TUBE)


def a_drop():
    _compare("drop", DROP)


main()
