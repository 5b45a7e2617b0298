#!/usr/bin/python3
# label: long
# Tests of the accuracy that inputs/manual/accuracy/plane_wall.md states for a sphere next to a plane wall, for gaps
# from 2 to 0.003 radii, and of the migration of a capsule far from the wall.
import numpy

from harness import check, deck, main, run, series

SPHERE = """
Tanktread:
  Flow: {{type: {flow}}}
  Wall: {{contact gap: 1.0e-4}}
  Particle: {{shape: sphere, center: [0, 0, {height!r}], {motion}}}
  Surface: {{elements per side: 6}}
  Adaptation: {{enabled: true, film resolution: {film}}}
  Quadrature: {{tolerance: {tolerance}}}
  {time}
"""

CAPSULE = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: sphere, center: [0, 0, HEIGHT]}
  Membrane: {law: neo-Hookean, capillary number: 0.3}
  Surface: {elements per side: 6}
  Time: {final time: 10.0}
"""

# Gap: f; F_t, T_t; F_s, T_s; U, Omega (Brenner 1961; Goldman, Cox & Brenner 1967).
KNOWN = {1: (2.12553557, 1.38275238, 0.005024711, 1.33152305, 0.98542482, 0.96411948, 0.96450218),
         0.1: (11.45915720, 2.26430304, 0.088763344, 1.63254384, 0.95179124, 0.73889120, 0.75339762),
         0.01: (101.89617232, 3.42253297, 0.276517403, 1.69319022, 0.94482758, 0.52417244, 0.55230870)}


def _brenner(gap):
    """Returns the drag of a sphere that moves towards the wall, divided by its drag in unbounded fluid (Brenner
    1961)."""
    a = numpy.arccosh(1 + gap)
    n = numpy.arange(1, int(600 / a))
    n = n[(2 * n + 1) * a < 600]
    over = 2 * numpy.sinh((2 * n + 1) * a) + (2 * n + 1) * numpy.sinh(2 * a)
    under = 4 * numpy.sinh((n + 0.5) * a) ** 2 - ((2 * n + 1) * numpy.sinh(a)) ** 2
    return 4 / 3 * numpy.sinh(a) * numpy.sum(n * (n + 1) / ((2 * n - 1) * (2 * n + 3)) * (over / under - 1))


def _row(gap, film, tolerance):
    """Returns f; F_t, T_t; F_s, T_s; U, Omega for a gap (see KNOWN)."""
    height, unit = 1.0 + gap, 6 * numpy.pi
    found = []
    for name, flow, motion, values in (
            ("across", "quiescent", "motion: prescribed, velocity: [0, 0, -1]", {"drag_x3": unit}),
            ("along", "quiescent", "motion: prescribed, velocity: [1, 0, 0]", {"drag_x1": -unit, "torque_x2": 8 * numpy.pi}),
            ("held", "simple shear", "motion: prescribed", {"drag_x1": unit * height, "torque_x2": 4 * numpy.pi}),
            ("free", "simple shear", "motion: free", {"velocity_x1": height, "angular_velocity_x2": 0.5})):
        time = "Time: {scheme: bs3, fixed step: 1.0e-4, final time: 1.0e-4}\n  Output: {interval: 1.0e-4}" if name == "free" else ""
        results = f"{name} {gap} {film}"
        run(deck(SPHERE.format(flow=flow, height=height, motion=motion, film=film, tolerance=tolerance, time=time)), "--output", results, "--quiet")
        found += [abs(series(results, key)[0] / scale) for key, scale in values.items()]
    return numpy.array(found)


def the_influence_of_the_wall_on_a_sphere_is_the_known_one():
    for gap, film, tolerance, asked in (1, 0.7, 1e-6, 1e-6), (0.1, 0.35, 1e-7, 1e-6), (0.01, 0.5, 1e-7, 1e-4):
        off = _row(gap, film, tolerance) / KNOWN[gap] - 1
        check(numpy.abs(off).max() < asked, f"a gap of {gap}: {off}")
    across = _row(2, 0.7, 1e-7)[0]
    check(abs(across / _brenner(2) - 1) < 1e-6, f"a gap of 2: {across}")


def a_film_of_0_003_is_resolved():
    """Compares the drag across the gap with the exact solution, the drag along the wall with lubrication theory, F_t =
    -(8/15 + 64/375 gap) log gap + 0.95429 + 0.429 gap, and both with a finer mesh."""
    gap = 0.003
    found, finer = _row(gap, 0.5, 1e-8), _row(gap, 0.35, 1e-8)
    along = -(8 / 15 + 64 / 375 * gap) * numpy.log(gap) + 0.95429 + 0.429 * gap
    check(abs(found[0] / _brenner(gap) - 1) < 1e-3 and abs(found[1] / along - 1) < 1e-4, f"{found[:2]}, not {_brenner(gap)}, {along}")
    check(numpy.abs(found / finer - 1).max() < 1e-4, f"{found}, {finer} on a finer mesh")


def a_capsule_far_from_the_wall_migrates_with_the_velocity_of_its_stresslet():
    """Far from the wall the migration velocity is -9 S33/(64 pi z^2). Its relative error decreases like z^-2."""
    run(deck(CAPSULE.replace("HEIGHT", "0")), "--output", "alone", "--quiet")
    stresslet, ratios, heights = series("alone", "stresslet_33")[-1], [], []
    for height in 8, 16:
        run(deck(CAPSULE.replace("HEIGHT", str(height)) + "  Wall: {}\n"), "--output", f"at {height}", "--quiet")
        heights.append(series(f"at {height}", "centroid_x3")[-1])
        ratios.append(series(f"at {height}", "velocity_x3")[-1] * 64 * numpy.pi * heights[-1] ** 2 / (-9 * stresslet))
    near, far = numpy.array(heights) ** -2.0
    coefficient = (ratios[1] * near - ratios[0] * far) / (near - far)
    power = numpy.log((1 - ratios[0]) / (1 - ratios[1])) / numpy.log(heights[0] / heights[1])
    check(abs(coefficient - 1) < 1e-3 and abs(power + 2) < 0.2, f"{coefficient}, power {power}, ratios {ratios} at {heights}")


main()
