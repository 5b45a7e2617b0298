#!/usr/bin/python3
"""Rates of the harmonics 2 to 6 of drops and of a neo-Hookean capsule in a fluid at rest, against their closed forms (4.18), (4.19).

    tests/benchmark/relaxation_rates.py build/release/app/tanktread [n ...]

On meshes of n elements a side, 6, 8 and 12 if none is given. Of each harmonic those modes count that keep all three mirror planes, or all but x3 = 0 if it is
odd, for which velocities are of the whole surface: they are left out where n is above 8. The error is the largest of theirs, the order that between the last two
meshes. Prints a table.
"""
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy
import yaml

HARMONICS = range(2, 7)
LARGEST_ODD = 8  # n
SCENES = {f"drop, viscosity ratio {ratio:g}": ratio for ratio in (0.1, 1.0, 10.0)} | {"capsule, slow": None, "capsule, fast": None}


def drop_rate(l, ratio):
    """(4.18), of sigma/(mu R)."""
    a, b = (2 * l * l + 4 * l + 3) * ratio + 2 * l * (l + 2), 2 * l * l + 1 + 2 * (l * l - 1) * ratio
    return -(l - 1) * l * (l + 1) * (l + 2) * (2 * l + 1) * (ratio + 1) / (a * b)


def capsule_rates(l, dilatation=3.0):
    """The slow and the fast one of (4.19), of G/(mu R)."""
    k, n = dilatation, l * (l + 1)
    load = numpy.array([[-4 * k, 2 * k * n], [2 * k, -k * n - (n - 2)]])
    waves = numpy.array([[-(l + 1), l], [1, 1]])
    layer = numpy.diag([l / ((2 * l + 1) * (2 * l + 3)), (l + 1) / ((2 * l + 1) * (2 * l - 1))])
    slow, fast = sorted(numpy.linalg.eigvals(waves @ layer @ numpy.linalg.inv(waves) @ load).real, key=abs)
    return float(slow), float(fast)


def exact(scene, l):
    return drop_rate(l, SCENES[scene]) if SCENES[scene] else capsule_rates(l)[scene.endswith("fast")]


def modes(program, scene, n, odd):
    """Rates of the modes that lie nearest to the middle of the harmonics', but of rigid motions and of the volume."""
    drop = SCENES[scene] is not None
    membrane = {"law": "surface tension", "surface tension": 1.0} if drop else {"shear modulus": 1.0}
    rates = [exact(scene, l) for l in HARMONICS]
    number = 5 * n  # slow modes of higher harmonics, which bend only, lie between those of the harmonics looked at
    spectrum = {"number": number, "near": (min(rates) + max(rates)) / 2}
    if odd:
        spectrum["parity"] = [1, 1, -1]
    deck = {"Flow": {"type": "quiescent"}, "Particle": {"shape": "sphere", "viscosity ratio": SCENES[scene] or 1.0}, "Membrane": membrane,
            "Surface": {"elements per side": n}, "Quadrature": {"tolerance": 1e-7}, "Solvers": {"projection": "least squares"}, "Spectrum": spectrum}
    with tempfile.TemporaryDirectory() as folder:
        path, results = pathlib.Path(folder) / "deck.yaml", pathlib.Path(folder) / "results"
        path.write_text(yaml.safe_dump({"Tanktread": deck}))
        subprocess.run([program, path, "--output", results, "--quiet"], check=True)
        summary = yaml.safe_load((results / "summary.yaml").read_text())
    kinds = summary["modes"]
    return [summary["final"][f"rate_{k}"] for k in range(1, number + 1) if kinds[str(k)] == "shape"]


def error(rates, value, count):
    """Relative, of as many as the harmonic has of this parity."""
    return sorted(abs(rate / value - 1) for rate in rates)[count - 1]


def main():
    program, *meshes = sys.argv[1:]
    meshes = sorted(int(n) for n in meshes) or [6, 8, 12]
    titles = "| scene | harmonic | rate | " + " | ".join(f"n = {n}" for n in meshes) + " | order |"
    print(titles + "\n" + "|---" * (titles.count("|") - 1) + "|")
    for scene in SCENES:
        found = {(n, odd): modes(program, scene, n, odd) for odd in (False, True) for n in meshes if not odd or n <= LARGEST_ODD}
        for l in HARMONICS:
            value, odd = exact(scene, l), l % 2 == 1
            count = (l + 1) // 2 if odd else l // 2 + 1  # of these parities
            errors = {n: error(found[n, odd], value, count) for n in meshes if (n, odd) in found}
            (n, coarse), (m, fine) = list(errors.items())[-2:]
            cells = " | ".join(f"{errors[n]:.1e}" if n in errors else "" for n in meshes)
            print(f"| {scene} | {l} | {value:.8f} | {cells} | {math.log(coarse / fine) / math.log(m / n):.1f} |", flush=True)


if __name__ == "__main__":
    main()
