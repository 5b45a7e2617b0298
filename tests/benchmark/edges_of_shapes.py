"""Maps of the atlas about the particle itself: where there is no steady shape any more."""

from package import SIDE, numpy, plt, style
from tanktread.figures import pushed as stuck

STUCK = "inputs/capsule_stuck_folds.yaml"
WRINKLED = "inputs/capsule_wrinkles.yaml"
MARKS = (8, "x"), (10, "o-")  # n, the coarse and the fine mesh


def bursting(study, given):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for (name, (deck, settings, meshes)), color in zip(given["cases"].items(), style.RUNS):
        axis = right if "capsule" in name else left
        coarse, fine = (folds(study.run(f"inputs/{deck}.yaml", settings | {SIDE: n})) for n in meshes)
        for second, ca, d in fine.T:
            before = coarse[1:, coarse[0] == second]
            apart = abs(before[:, 0] - (ca, d)) if before.size else (numpy.nan, numpy.nan)
            rows.append((name, second, ca, d, apart[0] / ca, apart[1]))
        axis.plot(*coarse[:2], "x", color=color, ms=6, label=f"{name}: n = {meshes[0]}")
        axis.plot(*fine[:2], "o-", color=color, ms=3.5, label=f"n = {meshes[1]}")
    left.set(xscale="log", xlabel="viscosity ratio λ")
    right.set_xlabel("pre-inflation")
    for axis in left, right:
        axis.set_ylabel("Ca at the fold")
        axis.legend()
    return figure, ["scene", "viscosity_ratio_or_pre_inflation", "capillary_number", "taylor_parameter",
                    "change_of_ca_relative", "change_of_d"], rows


def squeezing(study, given):
    figure, axis = plt.subplots(figsize=(5.6, 4.2))
    rows = []
    for n, mark in MARKS:
        outcome = study.run(STUCK, given["base"] | {SIDE: n})
        size, ca, _ = folds(outcome)
        axis.plot(size, ca, mark, color=style.RUNS[0], ms=4, label=f"Continuation, n = {n}")
        rows += [("with a film", n, *pair) for pair in zip(size, ca)]
    dry = [stuck.highest(*stuck.Pushed(outcome.run, 160, radius).through())[0] / stuck.drop_of_velocity(outcome.run)
           for radius in size]
    axis.plot(size, dry, "--", color=style.RUNS[1], label="without film and friction")
    rows += [("without film", "", *pair) for pair in zip(size, dry)]
    axis.set(xlabel="radius of the capsule over that of the channel", ylabel="Ca above which it passes")
    axis.legend()
    return figure, ["kind", "elements_per_side", "radius", "capillary_number"], rows


def wrinkling(study, given):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for (name, parity), color in zip(given["cases"].items(), style.RUNS):
        for n, mark in MARKS:
            onsets = []
            for ca in given["values"]:
                bending, outcome = onset(study, parity | {"Membrane/capillary number": ca, SIDE: n})
                angle, wave = along_waist(outcome)
                crests = number_of_crests(angle, wave)
                onsets.append(bending)
                rows.append((name, n, ca, bending, crests))
                if ca == 0.2 and n == 10:
                    right.plot(angle, wave / abs(wave).max(), color=color,
                               label=f"{name}: {crests} crests, Ca = {ca:g}")
            left.plot(given["values"], onsets, mark, color=color, ms=5, label=f"{name}, n = {n}")
    left.set(xlabel="Ca", ylabel="E_b/(G_s R²) at onset")
    right.set(xlabel="angle around the axis (degrees)", ylabel="radial part of the mode", ylim=(-1.1, 1.6))
    for axis in left, right:
        axis.legend()
    return figure, ["crests_even_or_odd", "elements_per_side", "capillary_number", "bending_number", "crests"], rows


def onset(study, settings):
    """Returns the bending number at which the leading rate passes through zero, by secants of its logarithm, and the
    last run."""
    known = []
    while len(known) < 9:
        number = (0.0045, 0.005)[len(known)] if len(known) < 2 else secant(known)
        outcome = study.run(WRINKLED, settings | {"Membrane/bending number": float(f"{number:.6g}")})
        known.append((number, outcome.series["leading_rate"][-1]))
        if abs(known[-1][1]) < 5e-3:
            break
    return known[-1][0], outcome


def secant(known):
    (a, f), (b, g) = known[-2:]
    return b * numpy.exp(numpy.clip(-g * numpy.log(b / a) / (g - f), -0.3, 0.3))


def along_waist(outcome):
    """Returns angle (degrees) and radial part of the first changing mode at the nodes of the plane across the axis."""
    shot = outcome.run.snapshots()[-1]
    rates = {k: outcome.series[f"rate_{k}"][-1] for k, kind in outcome.run.summary["modes"].items() if kind == "shape"}
    waist = numpy.flatnonzero(abs(shot.points[:, 2]) < 1e-9)
    place = shot.points[waist, :2]
    angle = numpy.degrees(numpy.arctan2(place[:, 1], place[:, 0]))
    order = numpy.unique(numpy.round(angle, 6), return_index=True)[1]
    mode = shot.fields[f"mode {max(rates, key=rates.get)}"][waist, :2]
    return angle[order], ((mode * place).sum(axis=1) / numpy.linalg.norm(place, axis=1))[order]


def number_of_crests(angle, wave):
    """Returns the degree of the largest Fourier coefficient."""
    turns = numpy.radians(angle)
    weight = (numpy.roll(turns, -1) - numpy.roll(turns, 1)) % (2 * numpy.pi)
    return int(numpy.argmax([abs((weight * wave * numpy.exp(-1j * m * turns)).sum()) for m in range(30)]))


def folds(outcome):
    """Returns rows of the second parameter, critical Ca and D there, as far as the run came."""
    series = outcome.series
    return numpy.array([series[name][series["fold"] > 0]
                        for name in ("second_parameter", "parameter", "taylor_surface")])
