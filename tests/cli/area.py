#!/usr/bin/python3
# ranks: 2
# Tests of nearly area-preserving membranes, locally or globally: cost at a large area modulus, ranks, symmetry.
from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: red cell, radius: 1.3842, viscosity ratio: 0.5, orientation: [0, -45, 0]}
  Membrane: {law: Skalak, capillary number: 0.4, area dilatation: 1.0e4, area points: 1, bending number: 0.005}
  Surface: {elements per side: 6}
  Time: {final time: 3.0}
  Output: {interval: 3.0}
"""


def an_area_modulus_of_10000_needs_at_most_twice_the_evaluations_of_10():
    """Measured: the larger modulus takes 1.5 times the evaluations and 1.3 times the steps. If the iteration of a stage
    started from extrapolated slopes only (see Dynamics::improve_start), the step size would decrease without limit."""
    counts = []
    for c in 10, 10000:
        run(deck(DECK), "--set", f"Membrane/area dilatation={c}", "--output", f"c_{c}", "--quiet")
        counts.append((series(f"c_{c}", "evaluations")[-1], len(series(f"c_{c}", "time"))))
    (few, short), (many, long) = counts
    check(many <= 2 * few and long <= 2 * short, f"{many} evaluations for {few}, {long} steps for {short}")


def two_ranks_agree_with_one():
    words = ["--set", "Time/fixed step=0.01", "--set", "Time/final time=0.04", "--set", "Solvers/tolerance=1e-12", "--set", "Output/interval=0.04"]
    for ranks in 1, 2:
        run(deck(DECK), *words, "--output", f"on_{ranks}", "--quiet", ranks=ranks)
    one, two = (series(f"on_{ranks}", "taylor_inertia") for ranks in (1, 2))
    check(abs(one - two).max() < 1e-9, f"D differs by {abs(one - two).max()}")


def area_points_without_area_elasticity_have_no_effect():
    words = ["--set", "Membrane/area dilatation=0", "--set", "Surface/elements per side=3", "--set", "Time/fixed step=0.02",
             "--set", "Time/final time=0.04", "--set", "Output/interval=0.04", "--set", "Solvers/tolerance=1e-12", "--quiet"]
    for points in 0, 1:
        run(deck(DECK), *words, "--set", f"Membrane/area points={points}", "--output", f"points_{points}")
    zero, one = (series(f"points_{points}", "taylor_inertia") for points in (0, 1))
    check(abs(zero - one).max() < 1e-9, f"D differs by {abs(zero - one).max()}")


WHOLE = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: ellipsoid, semi-axes: [1.0, 1.0, 0.5]}
  Membrane: {law: neo-Hookean, capillary number: 0.3}
  Surface: {elements per side: 4}
  Time: {final time: 1.0, tolerance: 1e-5}
  Output: {interval: 1.0, power balance: true}
"""


def the_change_of_the_total_area_falls_like_the_inverse_of_its_modulus():
    """As K grows, the tension that keeps the area tends to a limit, so that the change of the area falls like 1/K. The
    power balance counts the stored energy as energy, not as work of an external force."""
    path, words = deck(WHOLE), ["--set", "Membrane/global area dilatation"]
    changes, counts = [], []
    for k in 0, 100, 1000:
        run(path, words[0], f"{words[1]}={k}", "--output", f"k_{k}", "--quiet")
        area = series(f"k_{k}", "area")
        changes.append(area[-1] / area[0] - 1)
        counts.append(series(f"k_{k}", "evaluations")[-1])
        flow, forces = series(f"k_{k}", "flow_power"), series(f"k_{k}", "force_power")
        check(abs(forces).max() < 1e-6 * abs(flow).max(), f"forces have the power {abs(forces).max()} of {abs(flow).max()}")
    check(changes[0] > 0.02 and abs(10 * changes[2] / changes[1] - 1) < 0.05, f"changes of the area {changes}")
    check(changes[2] < 0.02 * changes[0], f"changes of the area {changes}")
    check(counts[2] <= 2 * counts[0], f"evaluations {counts}")


def the_smallest_tension_includes_that_of_the_total_area():
    """A drop without other tension gradients has the tension sigma + K (A/A0 - 1) everywhere (3.26)."""
    run(deck(WHOLE), "--set", "Membrane/law=surface tension", "--set", "Membrane/global area dilatation=10", "--output", "drop", "--quiet")
    area, tension, compressed = (series("drop", name) for name in ("area", "smallest_tension", "compressed_area"))
    check(abs(tension - (1 + 10 * (area / area[0] - 1))).max() < 1e-12, f"tensions {tension} for areas {area}")
    check((compressed == (tension < 0)).all(), f"compressed fractions {compressed} for tensions {tension}")


def with_a_surfactant_the_smallest_tension_includes_both():
    """sigma(c) + K (A/A0 - 1) with the linear equation of state sigma(c) = 1 - E c, at the largest concentration."""
    soap = ("elasticity number=0.2", "Peclet number=10")
    run(deck(WHOLE), "--set", "Membrane/law=surface tension", "--set", "Membrane/global area dilatation=10", "--output", "soap", "--quiet",
        "--set", "Time/final time=0.3", *(word for key in soap for word in ("--set", "Interface/surfactant/" + key)))
    area, tension, largest = (series("soap", name) for name in ("area", "smallest_tension", "largest_concentration"))
    check(abs(tension - (1 - 0.2 * largest + 10 * (area / area[0] - 1))).max() < 1e-12, f"tensions {tension} for areas {area}, {largest}")


def the_total_area_is_the_same_with_symmetry_and_on_two_ranks():
    words = ["--set", "Membrane/global area dilatation=100", "--set", "Membrane/bending number=0.05", "--set", "Membrane/area difference modulus=2",
             "--set", "Membrane/area difference=0.9", "--set", "Time/fixed step=0.05", "--set", "Time/final time=0.2", "--set", "Solvers/tolerance=1e-12"]
    found = []
    for ranks, symmetry in ((1, "auto"), (1, "none"), (2, "none")):
        run(deck(WHOLE), *words, "--set", f"Symmetry/use={symmetry}", "--output", f"whole_{ranks}_{symmetry}", "--quiet", ranks=ranks)
        found.append([series(f"whole_{ranks}_{symmetry}", name)[-1] for name in ("taylor_inertia", "energy", "area")])
    check(max(abs(a / b - 1) for one in found[1:] for a, b in zip(found[0], one)) < 1e-9, found)


main()
