#!/usr/bin/python3
# A run ends when its shape is steady, though the membrane treads and carries the mesh round the shape.
from harness import check, deck, main, run, series, summary

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 4}
  Time: {final time: 15, steady tolerance: 5.0e-4}
  Output: {interval: 15}
"""


def a_capsule_that_treads_is_found_steady_where_its_deformation_is():
    said = run(deck(DECK), "--output", "out", "--quiet").stderr
    check("steady at time" in said and summary("out")["status"] == "steady", said)
    times, d = series("out", "time"), series("out", "taylor_inertia")
    check(times[-1] < 10, f"found at {times[-1]} only")
    before = d[times > times[-1] - 1]  # of the last unit of time, in which the smooth part of the shape moved by no more than 2e-3
    check(abs(before - d[-1]).max() < 2e-3, before)
    check(series("out", "normal_velocity")[-1] > 5e-3, "the largest normal velocity would have told as well")


main()
