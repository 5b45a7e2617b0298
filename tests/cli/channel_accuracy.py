#!/usr/bin/python3
# label: long
# Tests of the accuracy that inputs/manual/accuracy/channels.md states: the empty constriction, a slender one, straight
# and nearly straight channels, and particles in a channel and its mirror image, which has another mesh.
import pathlib

import h5py
import numpy

from harness import check, close, deck, main, run, series

EMPTY = 159.429662  # extra pressure drop of the round constriction, from an axisymmetric solution of this project

PASSES = """
Tanktread:
  Flow: {{type: duct}}
  {wall}
  Particle: {{radius: {radius}, center: {center}, viscosity ratio: 5}}
  Membrane: {{law: neo-Hookean, capillary number: 0.1}}
  Surface: {{elements per side: 4}}
  Quadrature: {{tolerance: {tolerance}}}
  Time: {{scheme: bs3, fixed step: 1.0e-6, final time: 1.0e-6}}
  Output: {{interval: 1.0e-6}}
"""
OF_PASSAGE = "velocity_x1", "velocity_x2", "disturbed_pressure_drop", "channel_pressure_drop"


def _empty(name, *lines, half_length=2.0, depth=0.5, ends=4.0):
    """Returns the extra pressure drop of an empty constriction, and the flow rates through ten cross-sections divided
    by the flow rate at the inlet. The deck must have a particle. It is held far from the constriction, where
    it changes neither the pressure drop nor the flow rates."""
    reach = half_length + ends
    scene = f"""
Tanktread:
  Flow: {{type: duct}}
  Channel: {{section: circle, profile: constriction, half length: {half_length}, depth: {depth}, start: {-reach}, end: {reach}}}
  Particle: {{radius: 0.4, center: [{2.2 - reach}, 0, 0], motion: prescribed}}
  Surface: {{elements per side: 3}}
"""
    run(deck(scene), *[word for line in lines for word in ("--set", line)], "--output", name, "--quiet")
    with h5py.File(f"{name}/channel.h5") as file:
        return series(name, "channel_extra_pressure_drop")[0], file["flow_rate"][:] / numpy.pi


def the_pressure_drop_of_an_empty_constriction_is_the_axisymmetric_one():
    extra, rates = _empty("default")
    close(extra, EMPTY, 1e-5 * EMPTY, "extra pressure drop on the default wall")
    check(numpy.ptp(rates) < 1e-5, f"flow rates on the default wall: {rates - 1}")
    extra, rates = _empty("finer", "Channel/azimuthal elements=32", "Quadrature/tolerance=1e-7")
    close(extra, EMPTY, 1e-6 * EMPTY, "extra pressure drop on a finer wall")
    check(len(rates) == 10 and numpy.abs(rates - 1).max() < 1e-6, f"flow rates: {rates - 1}")


def the_pressure_drop_of_a_slender_constriction_is_that_of_lubrication_theory():
    """The relative error of lubrication theory falls with the square of depth divided by length."""
    x = (numpy.arange(4000) + 0.5) / 4000
    mean = numpy.mean((1 - 0.1 * (1 + numpy.cos(numpy.pi * x))) ** -4.0 - 1)  # mean of R^-4 - 1 over the half length
    off = [_empty(f"length {w}", "Channel/azimuthal elements=16", half_length=w, depth=0.2)[0] / (16 * w * mean) - 1 for w in (4.0, 8.0, 16.0)]
    powers = numpy.diff(numpy.log(numpy.abs(off))) / numpy.log(0.5)
    check(abs(off[2]) < 2e-3 and numpy.abs(powers - 2).max() < 0.1, f"{off} off, powers {powers}")


def _passes(name, wall, center, radius=0.5, tolerance=1e-7):
    run(deck(PASSES.format(wall=wall, center=center, radius=radius, tolerance=tolerance)), "--output", name, "--quiet")
    return numpy.array([series(name, one)[0] if one in OF_PASSAGE[:3] or not wall.startswith("Tube") else numpy.nan for one in OF_PASSAGE])


def a_straight_channel_agrees_with_the_tube():
    tube = _passes("tube", "Tube: {azimuthal elements: 28, axial elements: 48}", "[0, 0, 0]")
    wall = "start: -3.3, end: 3.3, azimuthal elements: 24, axial elements: 48}"
    along = "Channel: {profile: straight, "
    # the velocity across is proportional to the curvature of the bend, all other changes to its square
    bent = f"bend radius: 1.0e4, bend start: -1.5, bend angle: {3e-4 * 180 / numpy.pi!r}, "
    for name, channel in ("straight", along + wall), ("bent", along + bent + wall):
        velocity, across, drop, _ = _passes(name, channel, "[0, 0, 0]")
        check(abs(velocity / tube[0] - 1) < 1e-6 and abs(drop / tube[2] - 1) < 1e-5, f"{name}: {velocity}, {drop}; the tube: {tube}")
        check(abs(across) < 5e-4, f"{name}: {across} across")


def _mirrored(name, walls, centers, along, radius):
    """Compares two mirrored problems on default walls and on finer walls: the velocities along and across the channel
    divided by the velocity along it, the pressure drop of the empty channel, and the total pressure drop."""
    for mesh, elements, bounds in (("default", ("", ", axial elements: 80"), (3e-5, 1e-4)),
                                   ("finer", (", axial elements: 90", ", azimuthal elements: 28, axial elements: 100"), (1e-5, 1e-6))):
        one, other = (numpy.abs(_passes(f"{name} {mesh} {k}", f"Channel: {{{walls[k]}{elements[k]}}}", centers[k], radius, 1e-6)) for k in (0, 1))
        other[:2] = other[:2] if along else other[1::-1]
        check(numpy.abs(one[:2] - other[:2]).max() < bounds[0] * one[0], f"{name}, {mesh}: velocities {one[:2]} and {other[:2]}")
        for k in 3, slice(2, 4):
            check(abs(one[k].sum() / other[k].sum() - 1) < bounds[1], f"{name}, {mesh}: pressure drops {one[2:]} and {other[2:]}")


def a_quarter_bend_agrees_with_its_mirror_image():
    length = numpy.pi
    bend = f"profile: straight, bend radius: 2.0, bend start: 0.0, start: -3.0, end: {length + 3!r}"
    _mirrored("bend", (bend, bend), ("[-0.5, 0.2, 0]", "[1.8, 2.5, 0]"), False, 0.4)


def a_constriction_without_symmetry_agrees_with_its_mirror_image():
    t = numpy.linspace(-1, 1, 41)
    s, f = 1.5 * (t - 0.25 * (1 - t * t)), 1 - 0.15 * (1 + numpy.cos(numpy.pi * t))
    for name, rows in ("fore", zip(s, f)), ("back", zip(-s[::-1], f[::-1])):
        pathlib.Path(f"{name}.csv").write_text("s,f\n" + "".join(f"{float(a)!r},{float(b)!r}\n" for a, b in rows))
    _mirrored("constriction", [f"profile: file, points: {name}.csv" for name in ("fore", "back")], ("[-0.5, 0.15, 0]", "[0.5, 0.15, 0]"), True, 0.3)


main()
