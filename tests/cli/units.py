#!/usr/bin/python3
# A scene is the same in any units, but for the rounding of the radius of equal volume where the units differ by powers of two.
import re

from harness import check, deck, main, run, series

LENGTH, TIME, VISCOSITY = 2.0**-18, 2.0**-7, 2.0**-10  # about 4 micrometres, 8 ms, 1 mPa s
STRESS = VISCOSITY / TIME

SHEAR = """
  Flow: {{type: simple shear, shear rate: {rate!r}, viscosity: {viscosity!r}}}
  Particle: {{radius: {length!r}, viscosity ratio: 2}}
  Membrane: {{law: Skalak, capillary number: 0.3, bending modulus: {bending!r}}}
"""
REFINED = """
  Flow: {{type: planar hyperbolic, shear rate: {rate!r}, viscosity: {viscosity!r}}}
  Particle: {{radius: {length!r}}}
  Membrane: {{law: Skalak, capillary number: 0.6}}
  Adaptation: {{enabled: true, indicator: {indicator}}}
"""
DROP = """
  Flow: {{type: quiescent, viscosity: {viscosity!r}}}
  Particle: {{shape: ellipsoid, semi-axes: [{length!r}, {length!r}, {longer!r}]}}
  Membrane: {{law: surface tension, surface tension: {tension!r}}}
"""
TUBE = """
  Flow: {{type: duct, mean velocity: {speed!r}, viscosity: {viscosity!r}}}
  Tube: {{radius: {longer!r}, azimuthal elements: 12, axial elements: 9}}
  Particle: {{radius: {length!r}}}
  Membrane: {{capillary number: 0.1}}
"""


def _series(scene, name, length, time, viscosity, **words):
    """Runs the scene in units of such a size."""
    stress = viscosity / time
    text = scene.format(length=length, longer=2 * length, rate=1 / time, viscosity=viscosity, bending=0.05 * stress * length**3,
                        tension=2 * stress * length, speed=length / time, **words)
    common = f"  Surface: {{elements per side: 3}}\n  Time: {{final time: {0.4 * time!r}}}\n  Output: {{interval: {0.4 * time!r}}}\n"
    said = run(deck("Tanktread:" + text + common), "--output", name, "--overwrite", "--quiet").stderr
    return {key: series(name, key) for key in ("taylor_inertia", "volume_error", "smallest_tension", "n_control_points")}, re.findall(r"by (\S+) R_C", said)


def _is_the_same_in_other_units(scene, **words):
    one, remarks = _series(scene, "one", 1.0, 1.0, 1.0, **words)
    other, other_remarks = _series(scene, "other", LENGTH, TIME, VISCOSITY, **words)
    for name, values in one.items():
        check(len(values) == len(other[name]), f"{len(values)} and {len(other[name])} steps")
        check(abs(values - other[name]).max() < 1e-12, f"{name} differs by {abs(values - other[name]).max():.2g}")
    return one, remarks, other_remarks


def a_membrane_that_resists_bending():
    _is_the_same_in_other_units(SHEAR)


def meshes_that_refine_themselves():
    for indicator in "error", "variation":
        one, *moved = _is_the_same_in_other_units(REFINED, indicator=indicator)
        check(moved[0] == moved[1] and len(moved[0]) == 1, "how far the surface was moved:", moved)
    check(one["n_control_points"][-1] > 56, "never refined")


def a_drop_that_relaxes():
    _is_the_same_in_other_units(DROP)


def a_capsule_in_a_tube():
    _is_the_same_in_other_units(TUBE)


main()
