#!/usr/bin/python3
"""Relaxation rates of the spherical harmonics of degrees 2 to 6 on drops and on a neo-Hookean capsule in a fluid at
rest, compared with the exact rates (4.18) and (4.19) in lib/README.md.

    tests/benchmark/relaxation_rates.py [n ...]

The meshes have n elements per side (default: 6, 8 and 12). Of each degree, only modes with certain mirror symmetries
are computed: for even degrees those symmetric about all three coordinate planes, for odd degrees those symmetric about
x1 = 0 and x2 = 0 but antisymmetric about x3 = 0. Odd degrees need velocities on the whole surface and are left out if n
is above 8. The error of a degree is the largest relative error of its modes. The order is the convergence order between
the last two meshes. Runs are kept under results/relaxation_rates.
"""

from package import RATIO, SCENES, SIDE, answer, command_line, expect, numpy, table, tanktread

HARMONICS = range(2, 7)
LARGEST_ODD = 8  # n
SPHERES = {"drop, viscosity ratio 0.1": 0.1, "drop, viscosity ratio 1": 1.0, "drop, viscosity ratio 10": 10.0,
          "capsule, slow": None, "capsule, fast": None}


def drop_rate(l, ratio):
    """Returns (4.18) in sigma/(mu R)."""
    a, b = (2 * l * l + 4 * l + 3) * ratio + 2 * l * (l + 2), 2 * l * l + 1 + 2 * (l * l - 1) * ratio
    return -(l - 1) * l * (l + 1) * (l + 2) * (2 * l + 1) * (ratio + 1) / (a * b)


def capsule_rates(l, dilatation=3.0):
    """Returns the slow and the fast rate of (4.19) in G/(mu R)."""
    k, n = dilatation, l * (l + 1)
    load = numpy.array([[-4 * k, 2 * k * n], [2 * k, -k * n - (n - 2)]])
    waves = numpy.array([[-(l + 1), l], [1, 1]])
    layer = numpy.diag([l / ((2 * l + 1) * (2 * l + 3)), (l + 1) / ((2 * l + 1) * (2 * l - 1))])
    return sorted(numpy.linalg.eigvals(waves @ layer @ numpy.linalg.inv(waves) @ load).real, key=abs)


def exact(scene, l):
    return drop_rate(l, SPHERES[scene]) if SPHERES[scene] else float(capsule_rates(l)[scene.endswith("fast")])


def modes(study, scene, n, odd):
    """Returns the rates of modes near the middle of the exact rates, without rigid motions and the volume mode."""
    membrane = {"Membrane/law": "surface tension", "Membrane/surface tension": 1.0} if SPHERES[scene] else {
        "Membrane/shear modulus": 1.0}
    rates = [exact(scene, l) for l in HARMONICS]
    number = 5 * n  # slow bending modes of higher harmonics have rates in the same range
    spectrum = {"Spectrum/number": number, "Spectrum/near": (min(rates) + max(rates)) / 2}
    outcome = study.run(SCENES / "relaxation_rates.yaml", membrane | spectrum | {RATIO: SPHERES[scene] or 1.0, SIDE: n}
                        | ({"Spectrum/parity": [1, 1, -1]} if odd else {}))
    expect(outcome.done, outcome.message)
    kinds = outcome.run.summary["modes"]
    return [outcome.final[f"rate_{k}"] for k in range(1, number + 1) if kinds[str(k)] == "shape"]


def rows(study, meshes):
    for scene in SPHERES:
        found = {(n, odd): modes(study, scene, n, odd) for odd in (False, True) for n in meshes
                 if not odd or n <= LARGEST_ODD}
        for l in HARMONICS:
            value, odd = exact(scene, l), l % 2 == 1
            count = (l + 1) // 2 if odd else l // 2 + 1  # modes of the harmonic that have this parity
            errors = {n: sorted(abs(rate / value - 1) for rate in found[n, odd])[count - 1] for n in meshes
                      if (n, odd) in found}
            (n, coarse), (m, fine) = list(errors.items())[-2:]
            yield [scene, l, f"{value:.8f}", *(f"{errors[n]:.1e}" if n in errors else "" for n in meshes),
                   f"{numpy.log(coarse / fine) / numpy.log(m / n):.1f}"]


def main():
    parser = command_line(__doc__)
    parser.add_argument("meshes", nargs="*", type=int, metavar="n", help="elements per side (default: 6 8 12)")
    meshes = sorted(parser.parse_args().meshes) or [6, 8, 12]
    study = tanktread.Study(directory="results/relaxation_rates")
    table(["scene", "harmonic", "rate", *(f"n = {n}" for n in meshes), "order"], rows(study, meshes))


if __name__ == "__main__":
    answer(main)
