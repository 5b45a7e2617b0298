#!/usr/bin/python3
# ranks: 3
# Tests that the series and snapshots do not depend on the number of ranks (one, two, three).
import os
import pathlib
import re
import subprocess

import numpy
import yaml

from harness import PROGRAM, SOURCE, check, deck, difference, main, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 1.0}
"""
# slender, so that far sums use clusters
LONG = ["Particle/shape=ellipsoid", "Particle/semi-axes=[4.0, 0.6, 0.5]", "Surface/elements per side=6", "Quadrature/tolerance=1e-2"]
TWO = """
Tanktread:
  Flow: {type: simple shear}
  Particles:
    defaults: {Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}}
    left: {center: [-1.5, 0, 0]}
    right: {center: [1.5, 0, 0]}
"""
CLOCK = ["wall_seconds"]  # the only series that may differ


def _names(results):
    import h5py

    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return list(file["series"])


def _pictures(results):
    """Returns all arrays of all snapshots of a run."""
    import h5py

    arrays = {}
    for path in sorted(pathlib.Path(results).glob("snapshot_*.hdf")):
        with h5py.File(path, "r") as file:
            file["VTKHDF"].visititems(lambda name, item: arrays.update({f"{path.name} {name}": item[()]} if isinstance(item, h5py.Dataset) else {}))
    return arrays


def _kernel_evaluations(results):
    counts = yaml.safe_load((pathlib.Path(results) / "summary.yaml").read_text())["counts"]
    return sum(number for name, number in counts.items() if name.startswith("kernel_evaluations"))


def _compare_pictures(one, many):
    """Compares the snapshots of runs on one and on several ranks, to which each rank contributes its own nodes."""
    check(one.keys() == many.keys() and any(name.endswith("Normals") for name in one), one.keys() ^ many.keys())
    for name in one:
        check(one[name].shape == many[name].shape, f"{name}: another shape")
        off = numpy.max(abs(one[name] - many[name]))
        check(off <= 1e-9 * max(1, numpy.max(abs(one[name]))), f"{name} differs by {off:.2e}")


def _compare(*settings):
    """Checks that runs on one, two and three ranks agree to 1e-10."""
    words = [word for setting in settings for word in ("--set", setting)]
    for ranks in 1, 2, 3:
        run(deck(DECK), *words, "--output", f"on_{ranks}", "--overwrite", "--quiet", ranks=ranks)
    for ranks in 2, 3:
        # some parts are computed by every rank
        alone, together = _kernel_evaluations("on_1"), _kernel_evaluations(f"on_{ranks}")
        check(0.95 * alone <= together <= 1.3 * alone, f"{alone} kernel evaluations on one rank, {together} on {ranks}")
        _compare_pictures(_pictures("on_1"), _pictures(f"on_{ranks}"))
        check(_names("on_1") == _names(f"on_{ranks}"), "other series")
        for name in _names("on_1"):
            if name in CLOCK:
                continue
            one, many = series("on_1", name), series(f"on_{ranks}", name)
            off = difference(one, many, name)
            check(off <= 1e-10, f"{name} differs by {off:.2e} on {ranks} ranks")


def implicit_steps():
    _compare()


def explicit_steps():
    _compare("Time/scheme=bs3")


def the_scheme_quadrature_and_load_of_the_paper():
    _compare("Time/scheme=crank-nicolson", "Quadrature/rule=fixed", "Membrane/load measure=current", "Volume/constraint=flux",
             "Time/final time=0.2", "Time/initial step=0.01")


def far_sums_by_clusters():
    """Checks that clusters save work, and that ranks which share the far sum give the sum of one rank: with and without
    symmetry, and for a drop. The drop takes only one step, because rounding errors grow with each solve, and one more
    or fewer pair of clusters changes a velocity by 3e-5 at this tolerance."""
    evaluations = {}
    for far_sum in "dense", "tree":
        run(deck(DECK), *[word for setting in [*LONG, f"Quadrature/far sum={far_sum}", "Time/scheme=bs3", "Time/fixed step=0.01", "Time/final time=0.01"] for word in ("--set", setting)],
            "--output", far_sum, "--quiet")
        evaluations[far_sum] = _kernel_evaluations(far_sum)
    check(evaluations["tree"] < 0.8 * evaluations["dense"], f"{evaluations}: no clusters met")
    for symmetry in "auto", "none":
        _compare(*LONG, "Quadrature/far sum=tree", f"Symmetry/use={symmetry}", "Time/fixed step=0.01", "Time/final time=0.02")
    for scheme in "bs3", "tr-bdf2":
        _compare(*LONG, "Quadrature/far sum=tree", "Membrane/law=surface tension", "Membrane/load measure=current", "Particle/viscosity ratio=3",
                 f"Time/scheme={scheme}", "Time/fixed step=0.002", "Time/final time=0.002")


def a_red_cell():
    _compare("Particle/shape=red cell", "Membrane/law=Skalak", "Membrane/area dilatation=10", "Membrane/bending modulus=0.01", "Particle/viscosity ratio=5",
             "Surface/elements per side=4", "Time/fixed step=0.005", "Time/final time=0.01")


def a_membrane_of_another_law_in_another_flow():
    _compare("Membrane/law=Skalak", "Flow/type=planar hyperbolic", "Membrane/capillary number=0.6")


def two_particles_are_timed_phase_by_phase():
    words = [SOURCE / "tests/benchmark/scaling.py", deck(TWO), "--repeat", "1", "--no-capacity", "--program", PROGRAM, "--set", "Time/final time=0.1"]
    said = subprocess.run(words, capture_output=True, text=True)
    check(said.returncode == 0, said.stderr)
    found = re.search(r"difference of D +(\S+)", said.stdout)
    check("single layer" in said.stdout and found and float(found[1]) < 1e-10, said.stdout)


def more_ranks_than_cores_are_reported():
    """Ranks that may only run on one core share it. Other ranks of this test may run on all cores of the computer."""
    cores = sorted(os.sched_getaffinity(0))[:2]

    def said(*pinned):
        pin = f"cores=({' '.join(map(str, pinned))}); exec taskset -c ${{cores[$OMPI_COMM_WORLD_RANK]}} \"$0\" \"$@\""
        words = ["mpirun", "-n", str(len(pinned)), "bash", "-c", pin, str(PROGRAM), str(deck(DECK)), "--check", "--quiet"]
        return subprocess.run(words, capture_output=True, text=True, check=True).stderr

    one = said(cores[0], cores[0])
    check(one.count("tanktread: warning:") == 1 and "2 ranks share 1 core" in one and "mpirun -n 1" in one, one)
    check("share" not in run(deck(DECK), "--check", "--quiet").stderr, "of one process")
    if len(cores) > 1:
        check("share" not in said(*cores), "a core for each rank")
        check("2 ranks share 1 core" in said(cores[0], cores[1], cores[0]), "two of three ranks on one core")


main()
