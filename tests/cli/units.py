#!/usr/bin/python3
# Tests that results do not depend on units. If units differ by powers of two, the only difference is rounding in the
# radius of equal volume.
import math
import re

from harness import SOURCE, check, close, deck, main, refused, run, series, summary

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
    """Runs the scene in the given units."""
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


def a_membrane_with_bending_stiffness():
    _is_the_same_in_other_units(SHEAR)


def adaptive_meshes():
    for indicator in "error", "variation":
        one, *moved = _is_the_same_in_other_units(REFINED, indicator=indicator)
        check(moved[0] == moved[1] and len(moved[0]) == 1, "how far the surface was moved:", moved)
    check(one["n_control_points"][-1] > 56, "never refined")


def a_drop_that_relaxes():
    _is_the_same_in_other_units(DROP)


def a_capsule_in_a_tube():
    _is_the_same_in_other_units(TUBE)


def values_with_units_give_the_same_as_their_numbers():
    """Values with units (micrometres, seconds, piconewtons, and another choice) give the same result as their
    numbers."""
    said = """Tanktread:
  Units: {%s}
  Flow: {type: simple shear, shear rate: 100 1/s, viscosity: 35 mPa s}
  Particle: {radius: 2.5 um, center: [0, 0, 1 um], viscosity ratio: 2}
  Membrane: {law: Skalak, shear modulus: 5 uN/m, bending modulus: 2e-19 J}
  Surface: {elements per side: 3}
  Time: {final time: 4 ms}
  Output: {interval: 2 ms}
"""
    plain = said.replace("%s", "").replace("100 1/s", "100").replace("35 mPa s", "0.035").replace("2.5 um", "2.5").replace("1 um", "1")
    plain = plain.replace("5 uN/m", "5").replace("2e-19 J", "0.2").replace("4 ms", "0.004").replace("2 ms", "0.002").replace("  Units: {}\n", "")
    run(deck(plain), "--output", "plain", "--quiet")
    for name, choice, length in (("preset", "", 1), ("other", "length: 2.5e-4 centimeter, time: 10 ms, force: 1 nN", 2.5)):
        run(deck(said % choice), "--output", name, "--quiet")
        check(abs(series(name, "taylor_inertia") - series("plain", "taylor_inertia")).max() < 1e-11, name)
        check(abs(length**3 * series(name, "volume") - series("plain", "volume")).max() < 1e-10, name)
        check(summary(name)["final in SI"]["volume"].endswith("e-17 m^3"), summary(name)["final in SI"]["volume"])
    refused(["Flow/shear rate", "section Units", "100 1/s"], deck(said.replace("  Units: {%s}\n", "")), mistakes=8)
    refused(["Particle/radius", "another dimension", "2 uN"], deck(said % ""), "--set", "Particle/radius=2 uN")
    refused(["Particle/center", "1e999"], deck(said.replace("[0, 0, 1 um]", "[1e999, 0, 1 um]") % ""))
    refused(["Units/force", "unit of force", "1 kg"], deck(said % "force: 1 kg"))
    refused(["Units/length", "unit of length", "..."], deck(said % f"length: {'7' * 1000} um"))


def unusual_values_are_pointed_out():
    """A value a thousand times off, and a capillary number above 100, is named in the plan in one sentence; the decks
    with units have none."""
    given = "Units: {}, Flow: {shear rate: 100 1/s, viscosity: %s}, Particle: {radius: %s}, Membrane: {%s}, Time: {final time: 4 ms}"
    usual = ("1.2 mPa s", "4 um", "shear modulus: 5.3 uN/m, bending modulus: 2e-19 J")
    for words, *values in ([], *usual), (["Flow/viscosity is 1.2 Pa s"], "1.2 Pa s", *usual[1:]), \
            (["Particle/radius is 4e-12 m", "The capillary number is 9.057e-08, but"], usual[0], "4e-6", usual[2]), \
            (["Membrane/shear modulus is 5.3 N/m", "capillary number is"], *usual[:2], "shear modulus: 5.3 N/m"), \
            (["Membrane/bending modulus is 2e-37 J"], *usual[:2], "shear modulus: 5.3 uN/m, bending modulus: 2e-19"), \
            (["The capillary number is 200, but"], *usual[:2], "capillary number: 200"):
        lines = [line for line in run(deck("Tanktread: {" + given % tuple(values) + "}"), "--check").stdout.splitlines() if line.startswith("  unusual")]
        check(len(lines) == (words != []) and all(word in lines[0] for word in words), words, lines)
        check(not words or lines[0].count(": check ") == len(words), lines)
    for path in sorted((SOURCE / "inputs").glob("*.yaml")):
        if "  Units:" in path.read_text():
            check("  unusual" not in run(path, "--check").stdout, path)


def a_flow_rate_replaces_the_mean_velocity():
    """The flow rate divided by the area of the cross-section, in a channel at its inlet, is the mean velocity, with any
    unit, in periodic ducts and with either quantity held."""
    text = "Units: {}, Flow: {type: duct, viscosity: 1 mPa s, %s}, %s, Particle: {radius: 4 um}, Membrane: {shear modulus: 5 uN/m}, " \
        "Surface: {elements per side: 3}, Time: {final time: 2 ms}"
    area = math.pi * 10 * 10  # square micrometres
    ducts = {"Tube: {radius: 10 um, azimuthal elements: 8, axial elements: 8}": area,
             "Tube: {section: ellipse, semi-axes: [20 um, 5 um], periodic length: 30 um, azimuthal elements: 8, axial elements: 8}": area,
             "Channel: {radius: 10 um, profile: constriction, depth: 0.2, half length: 10 um, azimuthal elements: 8, axial elements: 12}": area,
             "Tube: {section: rectangle, sides: [20 um, 15 um], azimuthal elements: 8, axial elements: 8}": 300}
    for duct, area in ducts.items():
        for held in "flow rate", "pressure drop":
            for rate in "0.0012 µl/min", "20000 um^3/s":
                plan = run(deck("Tanktread: {" + text % (f"flow rate: {rate}, held: {held}", duct) + "}"), "--check").stdout
                check(f"mean velocity {20_000 / area:g}," in plan and "flow_rate 20000," in plan, duct, plan)
                close(float(re.search(r"    flow rate: (\S+)", plan)[1]), 20_000, 1e-9, "flow rate of the effective deck")
                check("mean velocity: " not in plan, plan)
    tube = next(iter(ducts))
    run(deck("Tanktread: {" + text % ("flow rate: 20000 um^3/s", tube) + "}"), "--output", "rate", "--quiet")
    run(deck("Tanktread: {" + text % (f"mean velocity: {20_000 / (math.pi * 100)!r}", tube) + "}"), "--output", "speed", "--quiet")
    speed = series("speed", "velocity_x1")
    check(abs(series("rate", "velocity_x1") - speed).max() < 1e-10 * abs(speed).max(), "another velocity")  # rounding in the area of the outline
    refused(["Flow/flow rate", "Flow/mean velocity", "contradict"], deck("Tanktread: {" + text % ("flow rate: 1, mean velocity: 1", tube) + "}"))
    refused(["Flow/flow rate", "duct", "simple shear"], "inputs/shear_neo_hookean.yaml", "--set", "Flow/flow rate=1")
    refused(["Flow/Q", "was Flow/flow rate meant?"], deck("Tanktread: {" + text % ("Q: 1", tube) + "}"))


main()
