"""Maps of the atlas about the membrane (compression, pre-stress, bending, the form of the load) and about the particle
itself, at parameters beyond which no steady shape exists."""

from package import PENS, SHEAR, SIDE, lines, numpy, style, varied
import waves
from tanktread.figures import pushed as stuck

MARKS = (8, "x"), (10, "o-")  # elements per side of the coarse and the fine mesh, and their markers


def bursting(study, given, axes):
    for (name, (deck, settings, meshes)), color in zip(given["cases"].items(), style.RUNS):
        axis = axes[1 if "capsule" in name else 0]
        coarse, fine = (folds(study.run(f"inputs/{deck}.yaml", settings | {SIDE: n})) for n in meshes)
        for second, ca, d in fine.T:
            before = coarse[1:, coarse[0] == second]
            apart = abs(before[:, 0] - (ca, d)) if before.size else (numpy.nan, numpy.nan)
            yield name, second, ca, d, apart[0] / ca, apart[1]
        axis.plot(*coarse[:2], "x", color=color, ms=6, label=f"{name}: n = {meshes[0]}")
        axis.plot(*fine[:2], "o-", color=color, ms=3.5, label=f"n = {meshes[1]}")


def squeezing(study, given, axes):
    for n, mark in MARKS:
        outcome = study.run(given["deck"], given["base"] | {SIDE: n})
        size, ca, _ = folds(outcome)
        axes[0].plot(size, ca, mark, color=style.RUNS[0], ms=4, label=f"Continuation, n = {n}")
        yield from (("with a film", n, *pair) for pair in zip(size, ca))
    dry = [stuck.highest(*stuck.Pushed(outcome.run, 160, radius).through())[0] / stuck.drop_of_velocity(outcome.run)
           for radius in size]
    axes[0].plot(size, dry, "--", color=style.RUNS[1], label="without film and friction")
    yield from (("without film", "", *pair) for pair in zip(size, dry))


def wrinkling(study, given, axes):
    for (name, parity), color in zip(given["cases"].items(), style.RUNS):
        for n, mark in MARKS:
            onsets = []
            for ca, more in varied(given).items():
                bending, outcome = onset(study, given["deck"], parity | more | {SIDE: n})
                angle, wave, crests = waist_mode(outcome)
                onsets.append(bending)
                yield name, n, ca, bending, crests
                if ca == 0.2 and n == 10:
                    axes[1].plot(angle, wave / abs(wave).max(), color=color,
                                 label=f"{name}: {crests} crests, Ca = {ca:g}")
            axes[0].plot(given["values"], onsets, mark, color=color, ms=5, label=f"{name}, n = {n}")


def onset(study, deck, settings):
    """Returns the bending number at which the leading rate is zero, by the secant method in its logarithm, and the last
    run."""
    numbers, rates = [0.0045, 0.005], []
    for k in range(9):
        outcome = study.run(deck, settings | {"Membrane/bending number": float(f"{numbers[k]:.6g}")})
        rates.append(outcome.series["leading_rate"][-1])
        if abs(rates[k]) < 5e-3:
            break
        if k > 0:
            step = -rates[k] * numpy.log(numbers[k] / numbers[k - 1]) / (rates[k] - rates[k - 1])
            numbers.append(numbers[k] * numpy.exp(numpy.clip(step, -0.3, 0.3)))
    return numbers[k], outcome


def waist_mode(outcome):
    """Returns the angle (degrees) and the radial component of the leading mode that changes the shape, at the nodes in
    the plane normal to the axis, and its number of crests: the degree of the largest Fourier coefficient."""
    shot = outcome.run.snapshots()[-1]
    rates = {k: outcome.series[f"rate_{k}"][-1] for k, kind in outcome.run.summary["modes"].items() if kind == "shape"}
    waist = numpy.flatnonzero(abs(shot.points[:, 2]) < 1e-9)
    place = shot.points[waist, :2]
    angle = numpy.degrees(numpy.arctan2(place[:, 1], place[:, 0]))
    order = numpy.unique(numpy.round(angle, 6), return_index=True)[1]
    mode = shot.fields[f"mode {max(rates, key=rates.get)}"][waist, :2]
    wave = ((mode * place).sum(axis=1) / numpy.linalg.norm(place, axis=1))[order]
    turns = numpy.radians(angle[order])
    weight = (numpy.roll(turns, -1) - numpy.roll(turns, 1)) % (2 * numpy.pi)
    powers = [abs((weight * wave * numpy.exp(-1j * m * turns)).sum()) for m in range(30)]
    return angle[order], wave, int(numpy.argmax(powers))


def folds(outcome):
    """Returns rows of second parameter, critical Ca, and D at the fold, up to the last point that the run reached."""
    names, at = ("second_parameter", "parameter", "taylor_surface"), outcome.series["fold"] > 0
    return numpy.array([outcome.series[name][at] for name in names])


def load_form(study, given, axes):
    for axis, (ca, more) in zip(axes, varied(given).items()):
        for load, color, offset in ("strong", style.RUNS[1], -0.19), ("weak", style.RUNS[0], 0.19):
            for k, (mesh, settings) in enumerate(given["cases"].items()):
                outcome = study.run(given["deck"], given["base"] | settings | more | {"Membrane/load": load})
                yield ca, mesh, load, outcome.end, outcome.message[:100]
                axis.barh(k + offset, outcome.end, 0.34, color=color, label=f"{load} form" if k == 0 else None)
                axis.annotate(f"{outcome.end:.2f}", (0, k + offset), (3, 0), textcoords="offset points", va="center",
                              fontsize=7.5, color="white")
    axes[1].plot(0.664, 1 - 0.19, "x", color=style.INK, ms=7, mew=1.6, label="Maestre et al. 2017")


def buckling(study, given, axes):
    pens = [pen | {"linestyle": dash} for pen in PENS for dash in (":", "-")]
    return lines(study, axes, given, (
        "smallest_tension", lambda one: waves.share_of_waves(waves.spectrum(one.run.snapshots()[-1])[0])), pens=pens)


def pre_inflation(study, given, axes):
    ca, alpha = numpy.meshgrid(given["values"], given["inflations"])
    outcomes = study.all([(SHEAR, given["base"] | {"Membrane/capillary number": x, "Membrane/pre-inflation": y})
                          for x, y in zip(ca.flat, alpha.flat)])
    smallest = [outcome.series["smallest_tension"].min() if outcome.done else numpy.nan for outcome in outcomes]
    field = numpy.reshape(smallest, ca.shape)
    bound = numpy.nanmax(abs(field))
    filled = axes[0].contourf(ca, 100 * alpha, field, numpy.linspace(-bound, bound, 21), cmap=style.SIGNED)
    axes[0].contour(ca, 100 * alpha, field, [0], colors=style.INK, linewidths=1.4)
    axes[0].plot(ca, 100 * alpha, ".", color=style.INK, ms=2)
    axes[0].figure.colorbar(filled, label="smallest tension / G_s")
    return zip(ca.flat, alpha.flat, smallest)
