"""Maps of the atlas about the membrane (compression, pre-stress, bending, the form of the load) and about the particle
itself, where there is no steady shape any more."""

from package import PENS, RATIO, SHEAR, SIDE, line, numpy, panels, plt, style, ticks
import waves
from tanktread.figures import pushed as stuck

MARKS = (8, "x"), (10, "o-")  # n, the coarse and the fine mesh


def bursting(study, given):
    figure, (left, right) = panels(given)
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
    for axis in left, right:
        axis.legend()
    return figure, rows


def squeezing(study, given):
    figure, (axis,) = panels(given)
    rows = []
    for n, mark in MARKS:
        outcome = study.run(given["deck"], given["base"] | {SIDE: n})
        size, ca, _ = folds(outcome)
        axis.plot(size, ca, mark, color=style.RUNS[0], ms=4, label=f"Continuation, n = {n}")
        rows += [("with a film", n, *pair) for pair in zip(size, ca)]
    dry = [stuck.highest(*stuck.Pushed(outcome.run, 160, radius).through())[0] / stuck.drop_of_velocity(outcome.run)
           for radius in size]
    axis.plot(size, dry, "--", color=style.RUNS[1], label="without film and friction")
    rows += [("without film", "", *pair) for pair in zip(size, dry)]
    axis.legend()
    return figure, rows


def wrinkling(study, given):
    figure, (left, right) = panels(given)
    rows = []
    for (name, parity), color in zip(given["cases"].items(), style.RUNS):
        for n, mark in MARKS:
            onsets = []
            for ca in given["values"]:
                bending, outcome = onset(study, given["deck"], parity | {"Membrane/capillary number": ca, SIDE: n})
                angle, wave = along_waist(outcome)
                crests = number_of_crests(angle, wave)
                onsets.append(bending)
                rows.append((name, n, ca, bending, crests))
                if ca == 0.2 and n == 10:
                    right.plot(angle, wave / abs(wave).max(), color=color,
                               label=f"{name}: {crests} crests, Ca = {ca:g}")
            left.plot(given["values"], onsets, mark, color=color, ms=5, label=f"{name}, n = {n}")
    right.set_ylim(-1.1, 1.6)
    for axis in left, right:
        axis.legend()
    return figure, rows


def onset(study, deck, settings):
    """Returns the bending number at which the leading rate passes through zero, by secants of its logarithm, and the
    last run."""
    numbers, rates = [0.0045, 0.005], []
    while len(rates) < 9:
        if len(rates) > 1:
            step = -rates[-1] * numpy.log(numbers[-1] / numbers[-2]) / (rates[-1] - rates[-2])
            numbers.append(numbers[-1] * numpy.exp(numpy.clip(step, -0.3, 0.3)))
        number = numbers[len(rates)]
        outcome = study.run(deck, settings | {"Membrane/bending number": float(f"{number:.6g}")})
        rates.append(outcome.series["leading_rate"][-1])
        if abs(rates[-1]) < 5e-3:
            break
    return number, outcome


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


def load_form(study, given):
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.6), sharey=True)
    rows = []
    for axis, ca in zip(axes, given["values"]):
        for load, color, offset in (("strong", style.RUNS[1], -0.19), ("weak", style.RUNS[0], 0.19)):
            for k, (mesh, settings) in enumerate(given["cases"].items()):
                outcome = study.run(given["deck"], given["base"] | settings | {"Membrane/capillary number": ca,
                                                                       "Membrane/load": load})
                axis.barh(k + offset, outcome.end, 0.34, color=color, label=f"{load} form" if k == 0 else None)
                axis.annotate(f"{outcome.end:.2f}", (0, k + offset), (3, 0), textcoords="offset points", va="center",
                              fontsize=7.5, color="white")
                rows.append((ca, mesh, load, outcome.end, outcome.message[:100]))
        axis.set(title=f"Ca = {ca:g}", xlabel="time reached", xlim=(0, given["base"]["Time/final time"]))
        axis.grid(visible=False, axis="y")
    axes[1].plot(0.664, 1 - 0.19, "x", color=style.INK, ms=7, mew=1.6, label="paper")
    axes[0].set_yticks(range(len(given["cases"])), given["cases"])
    axes[0].invert_yaxis()
    figure.legend(*axes[1].get_legend_handles_labels(), loc="upper right", ncols=3)
    return figure, rows


def buckling(study, given):
    cures = {"bending 0.02 R²G_s": lambda ca: {"Membrane/bending modulus": 0.02 / ca}, "as it is": lambda ca: {},
             "pre-inflation 5 %": lambda ca: {"Membrane/pre-inflation": 0.05}, "λ = 5": lambda ca: {RATIO: 5.0}}
    figure, (left, right) = panels(given)
    rows = []
    for (name, cure), pen in zip(cures.items(), PENS):
        for n, dash in (6, ":"), (9, "-"):
            jobs = {ca: given["base"] | cure(ca) | {SIDE: n, "Membrane/capillary number": ca} for ca in given["values"]}
            rows += line(study, (left, right), f"{name}, n = {n}", SHEAR, jobs, (
                "smallest_tension", lambda one: waves.Spectrum(one.run.snapshots()[-1]).short), linestyle=dash, **pen)
    left.axhline(0, color=style.FAINT, linewidth=0.9)
    for axis in left, right:
        ticks(axis, given["values"])
    left.legend(loc="best", fontsize=7)
    return figure, rows


def pre_inflation(study, given):
    capillary, inflation = given["values"], given["inflations"]
    pairs = [(ca, alpha) for alpha in inflation for ca in capillary]
    outcomes = study.all([(SHEAR, given["base"] | {"Membrane/capillary number": ca, "Membrane/pre-inflation": alpha})
                          for ca, alpha in pairs])
    smallest = [outcome.series["smallest_tension"].min() if outcome.done else numpy.nan for outcome in outcomes]
    field = numpy.reshape(smallest, (len(inflation), len(capillary)))
    bound = numpy.nanmax(abs(field))
    x, y = numpy.meshgrid(capillary, 100 * numpy.array(inflation))
    figure, (axis,) = panels(given)
    filled = axis.contourf(x, y, field, numpy.linspace(-bound, bound, 21), cmap=style.SIGNED)
    axis.contour(x, y, field, [0], colors=style.INK, linewidths=1.4)
    axis.plot(x, y, ".", color=style.INK, ms=2)
    ticks(axis, capillary)
    axis.grid(visible=False)
    figure.colorbar(filled, label="smallest tension over G_s")
    rows = [(*pair, value) for pair, value in zip(pairs, smallest)]
    return figure, rows
