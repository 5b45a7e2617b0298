#!/usr/bin/python3
# ranks: 2
# Tests of Contact/limiter: it keeps a gap at the limit, by known, equal and opposite forces that vanish before contact.
import h5py
import numpy

from harness import check, close, deck, main, refused, run, series, summary

SPHERES = """
Tanktread:
  Flow: {type: quiescent}
  Particles:
    defaults: {motion: free, Surface: {elements per side: 4}}
    left: {center: [-1.04, 0.0, 0.0], force: [10.0, 0.0, 0.0]}
    right: {center: [1.04, 0.0, 0.0], force: [-10.0, 0.0, 0.0]}
  Contact: {limit: 0.05, limiter: true}
  Solvers: {tolerance: 1.0e-12}
  Time: {final time: 4.0}
  Output: {interval: 1.0}
"""
CAPSULES = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Particles:
    defaults: {Membrane: {capillary number: 0.3, pre-inflation: 0.05}, Surface: {elements per side: 3}}
    below: {center: [0.0, 0.02, -1.1]}
    above: {center: [0.0, -0.02, 1.1], viscosity ratio: 2.0}
  Contact: {limit: 0.19, limiter: true}
  Solvers: {tolerance: 1.0e-12}
  Time: {final time: 0.6}
  Output: {interval: 0.2}
"""


LATTICE = """
Tanktread:
  Flow: {type: quiescent}
  Domain: {side lengths: [5.0, 5.0, 5.0]}
  Particles:
    ball: {motion: free, center: [-1.04, 0.0, 0.0], force: [2.0, 0.0, 0.0], Surface: {elements per side: 3}}
    cell: {center: [1.04, 0.0, 0.0], Membrane: {law: Skalak, shear modulus: 2.0}, Surface: {elements per side: 3}}
  Contact: {limit: 0.1, limiter: true}
  Time: {final time: 0.01}
"""


def the_forces_of_a_contact_cancel_in_the_mean_pressure_gradient_of_a_lattice():
    deck(LATTICE)
    run("deck.yaml", "--output", "lattice", "--quiet")
    check(series("lattice", "contact_force")[-1] > 0.1, "they are in contact")
    check(abs(series("lattice", "pressure_gradient_x1") - 2.0 / 125).max() < 1e-12, "it is not the force on the ball per volume of the cell")


def the_contact_force_equals_the_force_that_drives_the_spheres():
    for solver in ("first kind", "second kind"):
        deck(SPHERES)
        run("deck.yaml", "--output", solver, "--quiet", "--set", f"Solvers/rigid bodies={solver}")
        gap, force, time = (series(solver, name) for name in ("smallest_gap", "contact_force", "time"))
        check(force[0] == 0 and gap[0] > 0.06, "they start apart")
        check(((gap > 0.05 * (1 + 1e-4)) == (force == 0)).all(), solver, "there is a force just where the gap is the limit", gap, force)
        check(gap.min() > 0.05 * (1 - 1e-4), gap.min())
        close(force[-1], 10, 1e-5, f"{solver}: the force between them")
        steps = numpy.diff(time)
        close(series(solver, "contact_impulse")[-1], (force[1:] * steps).sum(), 1e-9, "the impulse")
        for name, sign in (("left", 1), ("right", -1)):
            close(series(solver, f"{name}/centroid_x1")[-1], -sign * 1.025, 1e-3, name)
            close(series(solver, f"{name}/drag_x1")[-1], 0, 1e-5, f"drag of {name}, on which no more force is left")
        check(any("limiter" in sentence for sentence in summary(solver)["warnings"]), "no warning")


def a_step_that_moves_particles_too_far_is_shortened():
    deck(SPHERES)
    run("deck.yaml", "--output", "long", "--quiet", "--set", "Time/initial step=1", "--set", "Time/tolerance=0.1",
        "--set", "Particles/left/force=[200, 0, 0]", "--set", "Particles/right/force=[-200, 0, 0]")
    check(series("long", "rejected_steps").sum() > 0, "no step was given up")
    check(series("long", "smallest_gap").min() > 0.05 * (1 - 1e-4), series("long", "smallest_gap"))
    close(series("long", "contact_force")[-1], 200, 2e-5, "the force between them")


def without_the_limiter_the_run_ends_at_contact():
    deck(SPHERES)
    error = run("deck.yaml", "--output", "ended", "--quiet", "--set", "Contact/limiter=false", code=3).stderr
    check("touch" in error and "Contact/limit" in error, error)
    with h5py.File("ended/run.h5") as file:
        check("contact_force" not in file["series"], "a series that nobody asked for")


def a_post_that_ends_a_run_is_named():
    said = run(deck("""
Tanktread:
  Flow: {type: quiescent, gravity: [1.0, 0.0, 0.0]}
  Domain: {periodic: x1 x2 x3, side lengths: [6.0, 6.0, 3.0]}
  Particles:
    cell: {center: [-1.9, 0.3, 0.0], radius: 0.8, Membrane: {law: Skalak, shear modulus: 20.0}, Surface: {elements per side: 4}, density difference: 6.0}
    stake: {shape: cylinder, axis: x3, radius: 0.7, Surface: {azimuthal elements: 12, axial elements: 4}}
  Contact: {limit: 0.1}
  Quadrature: {tolerance: 1.0e-2}
  Time: {final time: 30.0}
"""), "--output", "out", code=3).stderr
    check("Particles/cell would cross Particles/stake near" in said, said)


def _same(one, other, tolerance):
    for name in ("smallest_gap", "contact_force", "contact_impulse", "below/taylor_inertia", "above/centroid_x3", "stresslet_11"):
        a, b = series(one, name), series(other, name)
        check(len(a) == len(b), f"{other}: {len(b)} rows, not {len(a)}")
        check(numpy.abs(a - b).max() <= tolerance * max(1, numpy.abs(a).max()), f"{other}: {name} is off by {numpy.abs(a - b).max():.1e}")


def the_limiter_holds_capsules_on_any_ranks_and_after_resumption():
    deck(CAPSULES)
    run("deck.yaml", "--output", "whole", "--quiet")
    gap, force = series("whole", "smallest_gap"), series("whole", "contact_force")
    held = gap < 0.19 * (1 + 1e-4)
    check(held.any() and not held[0] and not held[-1] and (held == (force > 0)).all(), "held where they would be closer, and let go", gap, force)
    check(gap.min() > 0.19 * (1 - 1e-4), gap.min())
    for name in ("below", "above"):
        check(numpy.abs(series("whole", f"{name}/volume_error")).max() < 1e-12, name, "lost volume")
    run("deck.yaml", "--output", "two", "--quiet", ranks=2)
    _same("whole", "two", 1e-10)
    run("deck.yaml", "--output", "part", "--quiet", "--set", "Time/final time=0.2")
    check(series("part", "contact_force")[-1] > 0, "it pauses before they meet")
    run("--resume", "part", "--quiet", "--set", "Time/final time=0.6")
    _same("whole", "part", 1e-13)


def the_limiter_acts_between_periodic_images():
    deck("""
Tanktread:
  Flow: {type: planar hyperbolic}
  Domain: {side lengths: [5.0, 5.0, 2.4]}
  Particles:
    defaults: {Surface: {elements per side: 3}}
    one: {Membrane: {capillary number: 0.3}, Adaptation: {enabled: false}}
  Contact: {limit: 0.3, limiter: true}
  Time: {final time: 0.6}
  Output: {interval: 0.6}
""")
    run("deck.yaml", "--output", "lattice", "--quiet")
    gap, force = series("lattice", "smallest_gap"), series("lattice", "contact_force")
    check(force[-1] > 0 and abs(gap[-1] - 0.3) < 3e-5 and gap.min() > 0.3 * (1 - 1e-4), gap, force)


def the_limiter_keeps_drops_apart():
    """The contact force dents the interfaces, and the smallest gap moves to the rim of the dent."""
    deck("""
Tanktread:
  Flow: {type: planar hyperbolic}
  Particles:
    defaults: {Membrane: {law: surface tension, surface tension: 5.0}, Surface: {elements per side: 4}}
    one: {center: [0, 0, 1.3]}
    two: {center: [0, 0, -1.3]}
  Contact: {limit: 0.05, limiter: true}
  Time: {final time: 2.0}
  Output: {interval: 1.0}
""")
    run("deck.yaml", "--output", "drops", "--quiet")
    gap, force = series("drops", "smallest_gap"), series("drops", "contact_force")
    # tolerance: a second contact of the pair is added when its gap is 1 % below the required gap, which may be 1 % below the limit
    check(force[-1] > 0 and gap.min() > 0.05 * (1 - 0.02), gap, force)


def the_contact_force_vanishes_when_the_flow_reverses():
    """After the reversal of the flow at time 0.2, the period along x3 and the gap to the periodic image grow in every
    step."""
    deck("""
Tanktread:
  Flow: {type: planar hyperbolic, history: {times: [0.2, 0.2], amplitudes: [1.0, -1.0]}}
  Domain: {side lengths: [5.0, 5.0, 2.4]}
  Particles:
    defaults: {Surface: {elements per side: 3}}
    one: {Membrane: {capillary number: 0.3}}
  Contact: {limit: 0.37, limiter: true}
  Time: {scheme: bs3, fixed step: 0.02, final time: 0.3}
  Output: {interval: 0.3}
""")
    run("deck.yaml", "--output", "reversed", "--quiet")
    gap, force = series("reversed", "smallest_gap"), series("reversed", "contact_force")
    held = gap < 0.37 * (1 + 1e-4)
    check(held.any() and not held[-1] and (held == (force > 0)).all(), "there is a force just where the gap is the limit", gap, force)


def mistakes_are_reported():
    deck(SPHERES)
    refused(["Contact/limit", "-0.1"], "deck.yaml", "--set", "Contact/limit=-0.1")
    refused(["Contact/limit", "0"], "deck.yaml", "--set", "Contact/limit=0")
    deck(SPHERES.replace("limit: 0.05, ", ""))
    refused(["Contact/limiter", "needs Contact/limit"], "deck.yaml")
    deck(CAPSULES)
    refused(["Contact/limiter", "strong"], "deck.yaml", "--set", "Particles/defaults/Membrane/load=strong", "--set", "Volume/constraint=flux")


main()
