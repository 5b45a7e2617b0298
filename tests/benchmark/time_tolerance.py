#!/usr/bin/python3
"""Measures the error of time integration relative to Time/tolerance, and its cost. The mesh is the same in all runs.

    time_tolerance.py ratios     # error / tolerance of each implicit scheme at viscosity ratios from 0.05 to 50
    time_tolerance.py scenes     # error / tolerance of the default scheme in other scenes
    time_tolerance.py positions  # error of positions / tolerance of the default scheme for particles that travel
    time_tolerance.py schemes    # evaluations and seconds that every scheme needs for an error below 1e-4
    time_tolerance.py figure     # error against cost at four viscosity ratios, viscosity_ratio.png

The error is the largest difference of the Taylor parameter D (`taylor_inertia`) over the run from a reference with the
same mesh and quadrature. If there are several particles, the one with the largest error counts. Two references are made
by different schemes, and their difference is printed. The error of positions is that of the centroids, divided by
R_C. Runs are kept under results/time_tolerance and are not repeated.
"""


from package import (RATIO, SHEAR, SIDE, answer, command_line, expect, interpolation, numpy, plt, scenes_of, studies,
                     style, table, tanktread)

BASE = {SIDE: 6, "Quadrature/tolerance": 1e-6}
LONG = {"Output/interval": 1e3}  # snapshots would shorten steps
TO_THE_END = {"Time/steady tolerance": 1e-13}  # for decks that end where the shape is steady
RATIOS = [0.05, 0.2, 1, 2, 5, 10, 50]
NAMES = ["tr-bdf2", "bdf3", "auto", "bs3", "rkc2"]
SWEEP = [{"Time/tolerance": round(10 ** (-k / 4), 12)} for k in range(8, 25)]


def shear(ratio, **more):
    return SHEAR, BASE | {RATIO: ratio} | more


def scene(given):
    """Returns the deck and the settings of a scene in scenes/time_tolerance.yaml."""
    settings = dict(given)
    return f"inputs/{settings.pop('deck')}.yaml", settings


GIVEN = scenes_of(__file__)
SCENES = {name: scene(given) for name, given in GIVEN["scenes"].items()}
TRAVELLING = {name: scene(given) for name, given in GIVEN["travelling"].items()}
SCHEMES = {f"ratio {ratio:g}": shear(ratio) for ratio in RATIOS} | {
    name: shear(1, **given) for name, given in GIVEN["sheared"].items()} | {
    name: SCENES[name] for name in GIVEN["compared"]}


def many(study, scene, variants):
    """Returns the outcomes of a scene, one for each of the given additional settings."""
    deck, base = scene
    ends_early = "steady tolerance" in tanktread.deck_at(deck).read_text(encoding="utf-8")
    return study.all([(deck, base | LONG | (TO_THE_END if ends_early else {}) | variant) for variant in variants])


def reference_of(study, scene, tolerance):
    """Returns a run with an explicit scheme, and its difference from a run with an implicit scheme. In the implicit
    run, the error of a step is kept below a fraction of the tolerance (4.31)."""
    first, second = many(study, scene, [{"Time/scheme": "bs3", "Time/tolerance": tolerance}, {
        "Time/scheme": "bdf3", "Time/newton iterations": 20, "Time/tolerance": 10 * tolerance}])
    expect(first.done and second.done, f"a reference of {scene[0]} fails: {first.message} {second.message}")
    return first, error(second, first)


def error(outcome, reference):
    """Returns the largest |D - D of the reference| over the run; for several particles, the largest of their errors."""
    return max(interpolation.difference(outcome.series["time"], outcome.series[name], reference.series["time"], values)
               for name, values in reference.series.items() if name.split("/")[-1] == "taylor_inertia")


def error_of_positions(outcome, reference):
    """Returns the largest distance of a centroid over the run from that of the reference, along an axis, divided by
    R_C."""
    errors = []
    for name, values in reference.series.items():
        particle, _, quantity = name.rpartition("/")
        if not quantity.startswith("centroid_x"):
            continue
        volume = reference.series[f"{particle}/volume" if particle else "volume"][0]
        errors.append(interpolation.difference(outcome.series["time"], outcome.series[name], reference.series["time"], values)
                      / numpy.cbrt(3 * volume / (4 * numpy.pi)))
    return max(errors)


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


def positions(study, parsed):
    tolerances = (1e-3, 1e-4)

    def row(name):
        sharp = {"Time/newton tolerance": 0.02, "Time/tolerance": 1e-6}
        first, second = many(study, TRAVELLING[name], [sharp, sharp | {"Time/scheme": "bdf3", "Time/newton iterations": 20}])
        expect(first.done and second.done, f"a reference of {name} fails: {first.message} {second.message}")
        made = many(study, TRAVELLING[name], [{"Time/tolerance": one} for one in tolerances])
        return [name, *(f"{error_of_positions(one, first) / tolerance:.2f} ({one.counts['evaluations']})"
                        for one, tolerance in zip(made, tolerances)), f"{error_of_positions(second, first):.0e}"]

    table(["scene", "error/tolerance (evaluations) at 1e-3", "at 1e-4", "references differ by"], map(row, TRAVELLING))


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
    tables = {one.__name__: one for one in (ratios, scenes, positions, schemes, figure)}
    parser = command_line(__doc__)
    parser.add_argument("what", choices=tables)
    studies.arguments(parser, "results/time_tolerance", limit=900, jobs=1)
    parsed = parser.parse_args()
    tables[parsed.what](studies.study(parsed), parsed)


if __name__ == "__main__":
    answer(main)
