#!/usr/bin/python3
# ranks: 2
# Tests that results do not depend on the number of threads, and how the number is chosen and recorded.
import os
import pathlib
import sys

import h5py
import numpy
from harness import PROGRAM, SOURCE, check, deck, main, refused, run, series

sys.path.insert(0, str(SOURCE / "postproc"))

CAPSULE = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {viscosity ratio: 3}
  Membrane: {law: Skalak, area dilatation: 10, bending modulus: 0.01, capillary number: 0.3}
  Surface: {elements per side: 8}
  Time: {final time: 0.2}
  Output: {interval: 0.1}
"""
TUBE = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle}
  Particles:
    defaults: {radius: 0.5, Membrane: {capillary number: 0.1}, Surface: {elements per side: 4}}
    one: {center: [-0.7, 0, 0.1]}
    other: {center: [0.7, 0, 0]}
  Time: {final time: 0.05}
"""
LATTICE = """
Tanktread:
  Flow: {type: simple shear}
  Domain: {side lengths: [5, 5, 5]}
  Particles:
    one: {Interface: {}, Membrane: {law: surface tension, capillary number: 0.2}, Surface: {elements per side: 4}}
    other: {center: [0, 0, 2.5], Membrane: {capillary number: 0.3}, Surface: {elements per side: 4}}
  Time: {final time: 0.01}
"""


def _numbers(results):
    """Returns every series but those in seconds, and the fields and positions of the snapshots."""
    import tanktread

    made = tanktread.Run(results)
    found = {name: values for name, values in made.series.items() if made.units[name] != "s"}
    for k, shot in enumerate(made.snapshots()):
        found |= {f"{k}/{name}": values for name, values in shot.fields.items()} | {f"{k}/points": shot.points}
    return found


def _equal(text, *settings):
    for n in 1, 2, 3:
        run(deck(text), *settings, "--threads", n, "--output", f"on_{n}", "--quiet")
    one = _numbers("on_1")
    check(any(name.endswith("/points") for name in one), "no snapshots")
    for n in 2, 3:
        several = _numbers(f"on_{n}")
        check(several.keys() == one.keys(), f"other names on {n} threads")
        for name, values in one.items():
            check(numpy.asarray(values).tobytes() == numpy.asarray(several[name]).tobytes(), f"{name} differs on {n} threads")


def a_capsule_has_the_same_bits():
    _equal(CAPSULE)


def capsules_in_a_tube_have_the_same_bits():
    _equal(TUBE)


def particles_on_a_lattice_have_the_same_bits():
    _equal(LATTICE, "--set", "Quadrature/far sum=tree")


def a_failure_in_a_loop_is_the_same():
    said = {run(deck(CAPSULE), "--set", "Membrane/capillary number=1000", "--set", "Time/scheme=bs3", "--set", "Time/fixed step=0.1", "--threads", n,
                "--set", "Time/final time=20", "--set", "Output/interval=20", "--output", f"on_{n}", "--quiet", code=3).stderr.replace(f"on_{n}", "out")
            for n in (1, 2)}
    check(len(said) == 1, *said)


def the_number_is_chosen_stated_and_recorded():
    text = CAPSULE.replace("elements per side: 8", "elements per side: 3")

    def kernels(*arguments, **environment):
        os.environ |= environment
        said = run(deck(text), "--check", "--quiet", *arguments).stdout
        return next(line for line in said.splitlines() if line.startswith("  kernels"))

    check(kernels("--threads", "3", OMP_NUM_THREADS="2").endswith(", 3 threads"), "the option")
    check(kernels(OMP_NUM_THREADS="2,1").endswith(", 2 threads"), "the variable")
    del os.environ["OMP_NUM_THREADS"]
    cores = len(os.sched_getaffinity(0))
    check(kernels().endswith(f", {cores} thread{'s' if cores > 1 else ''}"), kernels())
    run(deck(text), "--threads", "2", "--output", "out", "--quiet")
    with h5py.File("out/run.h5") as file:
        check(str(file["provenance"].attrs["threads"]) in ("2", "b'2'"), dict(file["provenance"].attrs))
    refused(["--threads"], deck(text), "--threads", "0")


def two_ranks_agree_with_two_threads():
    run(deck(CAPSULE), "--threads", "2", "--output", "threads", "--quiet")
    run(deck(CAPSULE), "--threads", "1", "--output", "ranks", "--quiet", ranks=2)
    for name in "taylor_inertia", "volume", "length_x1":
        one, other = series("threads", name), series("ranks", name)
        check(abs(one - other).max() <= 1e-10 * abs(one).max(), name, abs(one - other).max())


main()
