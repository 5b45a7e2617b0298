#!/usr/bin/python3
# ranks: 2
# Membranes that nearly keep their area: what a resistance a thousand times as large costs, schemes, ranks.
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


def ten_thousand_takes_at_most_twice_the_evaluations_of_ten():
    """1.5 times, in 1.3 times the steps; where stages start as slopes point to, the step shrinks without end."""
    counts = []
    for c in 10, 10000:
        run(deck(DECK), "--set", f"Membrane/area dilatation={c}", "--output", f"c_{c}", "--quiet")
        counts.append((series(f"c_{c}", "evaluations")[-1], len(series(f"c_{c}", "time"))))
    (few, short), (many, long) = counts
    check(many <= 2 * few and long <= 2 * short, f"{many} evaluations for {few}, {long} steps for {short}")


def two_processes_do_what_one_does():
    words = ["--set", "Time/fixed step=0.01", "--set", "Time/final time=0.04", "--set", "Solvers/tolerance=1e-12", "--set", "Output/interval=0.04"]
    for ranks in 1, 2:
        run(deck(DECK), *words, "--output", f"on_{ranks}", "--quiet", ranks=ranks)
    one, two = (series(f"on_{ranks}", "taylor_inertia") for ranks in (1, 2))
    check(abs(one - two).max() < 1e-9, f"D differs by {abs(one - two).max()}")


main()
