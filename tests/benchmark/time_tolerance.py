#!/usr/bin/python3
"""Whether Time/tolerance means what it says, and what it costs: errors of time integration alone, on one mesh.

    time_tolerance.py ratios     # viscosity ratios 0.05 to 50: error divided by tolerance, each implicit scheme
    time_tolerance.py scenes     # the same for scenes of other kinds, default scheme
    time_tolerance.py schemes    # evaluations and seconds of every scheme for an error below 1e-4
    time_tolerance.py figure     # error against work at four viscosity ratios, viscosity_ratio.png

The error is the largest difference of D (`taylor_inertia`, of the particle where it is largest) over the run to a
reference on the same mesh with the same integrals. Two references by different schemes are made; their difference is
printed. Runs are made once, under results/time_tolerance.
"""

import pathlib

from package import RATIO, SHEAR, SIDE, answer, command_line, expect, interpolation, numpy, plt, studies, style, table

BASE = {SIDE: 6, "Quadrature/tolerance": 1e-6}
LONG = {"Output/interval": 1e3, "Time/steady tolerance": 1e-13}  # pictures and an early end would shorten steps
RATIOS = [0.05, 0.2, 1, 2, 5, 10, 50]
NAMES = ["tr-bdf2", "bdf3", "auto", "bs3", "rkc2"]
SWEEP = [{"Time/tolerance": round(10 ** (-k / 4), 12)} for k in range(8, 25)]


def shear(ratio, **more):
    return SHEAR, BASE | {RATIO: ratio} | more


def of(deck, ratio=None, end=None, **more):
    """Returns the deck and the settings of a scene."""
    settings = {SIDE: 6} if deck in ("drop_uniaxial", "capsule_in_tube") else {}
    settings |= ({RATIO: ratio} if ratio else {}) | ({"Time/final time": end} if end else {})
    return f"inputs/{deck}.yaml", settings | more


SKALAK = {"Membrane/law": "Skalak"}
SCENES = {  # name: deck, settings
    "flow that oscillates, ratio 5": of("oscillating_shear", 5),
    "flow that oscillates, ratio 0.2": of("oscillating_shear", 0.2),
    "drop in extension, ratio 5": of("drop_uniaxial", 5, 4),
    "drop in extension, ratio 0.1": of("drop_uniaxial", 0.1, 4),
    "drop in shear, ratio 2": of("drop_uniaxial", 2, 4, **{
        "Flow/type": "simple shear", "Membrane/capillary number": 0.2}),
    "red cell stretched": of("red_cell_si"),
    "red cell in shear, ratio 5": of("shear_bending", 5, 3, **SKALAK | {
        "Particle/shape": "red cell", SIDE: 8, "Membrane/capillary number": 0.5}),
    "adaptive mesh": of("hyperbolic_skalak"),
    "adaptive mesh, ratio 5": of("hyperbolic_skalak", 5),
    "drop, adaptive mesh": of("drop_four_roll", None, 3),
    "two capsules, ratio 5": of("capsule_pair", None, 8, **{
        "Particles/defaults/viscosity ratio": 5, "Particles/defaults/Surface/elements per side": 4,
        "Particles/first/center": [-2, 0, 0.25], "Particles/second/center": [2, 0, -0.25]}),
    "lattice, ratio 5": of("sheared_lattice", None, 3, **{"Particles/capsule/viscosity ratio": 5}),
    "lattice, ratio 0.2": of("sheared_lattice", None, 3, **{"Particles/capsule/viscosity ratio": 0.2}),
    "viscous membrane": of("viscous_membrane", None, 6),
    "viscous membrane, ratio 5": of("viscous_membrane", 5, 6),
    "tube, ratio 5": of("capsule_in_tube", 5, 1),
    "tube, ratio 0.2": of("capsule_in_tube", 0.2, 1),
    "next to a wall, ratio 10": of("capsule_lifted_from_wall", 10, 3),
    "parabolic flow, ratio 5": of("parabolic_capsule", 5),
    "oblate, ratio 20": of("oblate_shear", 20, 6),
}
SCHEMES = {f"ratio {ratio:g}": shear(ratio) for ratio in RATIOS} | {
    "Ca = 0.02": shear(1, **{"Membrane/capillary number": 0.02, "Membrane/pre-inflation": 0.05, "Time/final time": 2}),
    "Ca = 2, Skalak": shear(1, **SKALAK | {"Membrane/capillary number": 2, "Time/final time": 3}),
    "Skalak, C = 100": shear(1, **SKALAK | {"Membrane/area dilatation": 100, "Time/final time": 3}),
    **{name: SCENES[name] for name in ("tube, ratio 5", "lattice, ratio 5", "two capsules, ratio 5",
                                       "drop in extension, ratio 5")}}


def many(study, scene, variants):
    """Returns the outcomes of a scene with each of these settings in addition."""
    deck, base = scene
    return study.all([(deck, base | LONG | variant) for variant in variants])


def reference_of(study, scene, tolerance):
    """Returns a run by an explicit scheme, and its difference to one by an implicit scheme, whose steps err by less
    than their tolerance (4.31)."""
    first, second = many(study, scene, [{"Time/scheme": "bs3", "Time/tolerance": tolerance}, {
        "Time/scheme": "bdf3", "Time/newton iterations": 20, "Time/tolerance": 10 * tolerance}])
    expect(first.done and second.done, f"a reference of {scene[0]} fails: {first.message} {second.message}")
    return first, error(second, first)


def error(outcome, reference):
    """Returns the largest |D - reference's D| over the run, of the particle where it is largest."""
    return max(interpolation.difference(outcome.series["time"], outcome.series[name], reference.series["time"], values)
               for name, values in reference.series.items() if name.split("/")[-1] == "taylor_inertia")


def cheapest(outcomes, reference, level=1e-4):
    """Returns evaluations and processor seconds of the cheapest run with an error below the level; NaN if there is
    none."""
    good = [one for one in outcomes if one.done and error(one, reference) < level]
    return (min((one.counts["evaluations"] for one in good), default=numpy.nan),
            min((one.processor_seconds for one in good), default=numpy.nan))


def ratios(study, parsed):
    tolerances = [1e-3, 1e-4, 1e-5, 1e-6]

    def row(ratio):
        reference, difference = reference_of(study, shear(ratio), 1e-8)
        cells = [", ".join(f"{error(one, reference) / tolerance:.2f}" for one, tolerance in zip(many(
            study, shear(ratio), [{"Time/scheme": scheme, "Time/tolerance": one} for one in tolerances]), tolerances))
            for scheme in NAMES[:3]]
        return [f"{ratio:g}", *cells, f"{difference:.0e}"]

    table(["viscosity ratio", *(f"`{scheme}` at 1e-3 to 1e-6" for scheme in NAMES[:3]), "references differ by"],
          map(row, RATIOS))


def scenes(study, parsed):
    def row(name):
        reference, difference = reference_of(study, SCENES[name], 1e-7)
        pairs = zip(many(study, SCENES[name], [{"Time/tolerance": one} for one in (1e-4, 1e-5)]), (1e-4, 1e-5))
        return [name, *(f"{error(one, reference) / tolerance:.2f} ({one.counts['evaluations']})"
                        for one, tolerance in pairs), f"{difference:.0e}"]

    table(["scene", "error/tolerance (evaluations) at 1e-4", "at 1e-5", "references differ by"], map(row, SCENES))


def schemes(study, parsed):
    def row(name):
        reference, _ = reference_of(study, SCHEMES[name], 1e-7)
        found = [cheapest(many(study, SCHEMES[name], [{"Time/scheme": scheme} | one for one in SWEEP]), reference)
                 for scheme in NAMES]
        return [name, *(f"{evaluations}, {seconds:.2f} s" if seconds > 0 else "" for evaluations, seconds in found)]

    table(["evaluations and seconds for an error below 1e-4", *(f"`{name}`" for name in NAMES)], map(row, SCHEMES))


def figure(study, parsed):
    drawing, axes = plt.subplots(2, 4, figsize=(12, 6), sharey=True)
    for (upper, lower), ratio in zip(axes.T, (0.2, 1, 5, 20)):
        reference, _ = reference_of(study, shear(ratio), 1e-8)
        for name, color in zip(NAMES, style.RUNS):
            made = many(study, shear(ratio), [{"Time/scheme": name} | one for one in SWEEP])
            done = [one for one in made if one.done]
            errors = [error(one, reference) for one in done]
            pen = {"color": color, "label": name, "markersize": 4, "linewidth": 1}
            upper.loglog([one.processor_seconds for one in done], errors, ".-", **pen)
            lower.loglog([one.counts["evaluations"] for one in done], errors, ".-", **pen)
        upper.set(title=f"viscosity ratio {ratio:g}", xlabel="processor seconds")
        lower.set_xlabel("velocity evaluations")
    for axis in axes[:, 0]:
        axis.set_ylabel("largest error of D")
    axes[0, 0].legend(fontsize=8)
    style.save(drawing, parsed.output / "viscosity_ratio.png")


def main():
    tables = {one.__name__: one for one in (ratios, scenes, schemes, figure)}
    parser = command_line(__doc__)
    parser.add_argument("what", choices=tables)
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default: %(default)s)")
    studies.arguments(parser, pathlib.Path("results/time_tolerance"))
    parser.set_defaults(limit=900)
    parsed = parser.parse_args()
    tables[parsed.what](studies.study(parsed, parsed.jobs), parsed)


if __name__ == "__main__":
    answer(main)
