"""Maps of the atlas about the particle itself: where there is no steady shape any more."""

from package import SIDE, numpy, plt, style
from tanktread.figures import pushed as stuck

DROP = "inputs/drop_folds.yaml"
SHEARED = "inputs/drop_shear_folds.yaml"
CAPSULE = "inputs/capsule_branch.yaml"
STUCK = "inputs/capsule_stuck_folds.yaml"
WRINKLED = "inputs/capsule_wrinkles.yaml"
ELLIPSOID = {"Flow/type": "planar hyperbolic", "Particle/shape": "ellipsoid",
             "Particle/semi-axes": "[1.8785, 0.7653, 0.6957]",
             "Particle/initial shape/stretch": "[0.7167, 1.1541, 1.2091]"}  # 2.7 : 1.1 : 1, at first 1.6 : 1.05 : 1
INFLATED = {"Continuation/second parameter": "Membrane/pre-inflation",
            "Continuation/second values": "[0.15, 0.2, 0.3, 0.4]", "Continuation/points": 12}


def bursting(study):
    """Where drops and capsules burst: the folds of their steady branches

    Left: critical Ca = μEa/σ of drops against their viscosity in uniaxial extension (-x₁/2, -x₂/2, x₃)E and planar
    hyperbolic flow (x₁, 0, -x₃)E, and in simple shear at the rate E. Right: critical Ca = μEa/G_s of neo-Hookean
    capsules in uniaxial extension against the pre-inflation of the radius. Each is a fold that `Continuation` locates
    and goes on with; the table has D there, and how far the mesh before is off.

    Survives: smaller Ca. Skalak membranes harden, and have no fold."""
    curves = [("drop, uniaxial", DROP, {}, (5, 6)), ("drop, planar", DROP, ELLIPSOID, (5, 6)),
              ("drop, shear", SHEARED, {}, (7, 8)), ("neo-Hookean capsule, uniaxial", CAPSULE, INFLATED, (10, 12))]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for (name, deck, settings, meshes), color in zip(curves, style.RUNS):
        axis = right if "capsule" in name else left
        coarse, fine = (folds(study.run(deck, settings | {SIDE: n})) for n in meshes)
        for second, ca, d in fine.T:
            before = coarse[1:, coarse[0] == second]
            apart = abs(before[:, 0] - (ca, d)) if before.size else (numpy.nan, numpy.nan)
            rows.append((name, second, ca, d, apart[0] / ca, apart[1]))
        axis.plot(coarse[0], coarse[1], "x", color=color, ms=6, label=f"{name}: n = {meshes[0]}")
        axis.plot(fine[0], fine[1], "o-", color=color, ms=3.5, label=f"n = {meshes[1]}")
    left.set(xscale="log", xlabel="viscosity ratio λ")
    right.set_xlabel("pre-inflation")
    for axis in left, right:
        axis.set_ylabel("Ca at the fold")
        axis.legend()
    return figure, ["scene", "viscosity_ratio_or_pre_inflation", "capillary_number", "taylor_parameter",
                    "change_of_ca_relative", "change_of_d"], rows


def squeezing(study):
    """The largest capsule that a constriction lets through

    Neo-Hookean capsules, pre-inflated by 0.1, in a round channel that narrows to half its radius, the pressure drop
    held. Smaller ones than the curve tells pass; larger ones rest before the throat, on a branch of steady shapes whose
    fold, in the pressure drop or in the size, is that curve. Ca = μV/G_s, V being the mean velocity of the empty
    channel. The wall repels the membrane, so that a film stays; broken line: a membrane without film and friction,
    axisymmetric, whatever the viscosity ratio (postproc/tanktread-figure stuck).

    Survives: a smaller or softer capsule, a larger pressure drop."""
    figure, axis = plt.subplots(figsize=(5.6, 4.2))
    values, rows = "[0.65, 0.6, 0.55]", []
    for n, mark in ((8, "x"), (10, "o-")):
        outcome = study.run(STUCK, {SIDE: n, "Continuation/second values": values})
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


def wrinkling(study):
    """How stiff against bending a capsule must be to stay smooth

    Neo-Hookean capsule in uniaxial extension, not pre-inflated: its waist is compressed. Left: the bending number
    E_b/(G_s R²) at which the leading mode of the smooth steady shape has the rate zero, for waves with an even and with
    an odd number of crests around the axis (Spectrum/parity), on two meshes; below, they grow. Right: that mode along
    the waist; the table has the number of its crests.

    Survives: a stiffer membrane, pre-inflation."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    numbers, rows = (0.1, 0.15, 0.2, 0.3), []
    for parity, name, color in (("[1, 1, 1]", "even", style.RUNS[0]), ("[-1, 1, 1]", "odd", style.RUNS[1])):
        for n, mark in ((8, "x"), (10, "o-")):
            onsets = []
            for ca in numbers:
                bending, outcome = onset(study, {"Membrane/capillary number": ca, "Spectrum/parity": parity,
                                                 SIDE: n})
                angle, wave = along_waist(outcome)
                crests = number_of_crests(angle, wave)
                onsets.append(bending)
                rows.append((name, n, ca, bending, crests))
                if ca == 0.2 and n == 10:
                    right.plot(angle, wave / abs(wave).max(), color=color,
                               label=f"{name}: {crests} crests, Ca = {ca:g}")
            left.plot(numbers, onsets, mark, color=color, ms=5, label=f"{name}, n = {n}")
    left.set(xlabel="Ca", ylabel="E_b/(G_s R²) at onset")
    right.set(xlabel="angle around the axis (degrees)", ylabel="radial part of the mode", ylim=(-1.1, 1.6))
    for axis in left, right:
        axis.legend()
    return figure, ["crests_even_or_odd", "elements_per_side", "capillary_number", "bending_number", "crests"], rows


def onset(study, settings):
    """The bending number at which the leading rate passes through zero, by secants of its logarithm; and the last
    run."""
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
    step = -g * numpy.log(b / a) / (g - f)
    return b * numpy.exp(numpy.clip(step, -0.3, 0.3))


def along_waist(outcome):
    """Angle (degrees) and radial part of the first changing mode at the nodes of the plane across the axis."""
    shot = outcome.run.snapshots()[-1]
    kinds = outcome.run.summary["modes"]
    rates = {k: outcome.series[f"rate_{k}"][-1] for k, kind in kinds.items() if kind == "shape"}
    mode = shot.fields[f"mode {max(rates, key=rates.get)}"]
    waist = numpy.flatnonzero(abs(shot.points[:, 2]) < 1e-9)
    angle = numpy.degrees(numpy.arctan2(shot.points[waist, 1], shot.points[waist, 0]))
    order = numpy.unique(numpy.round(angle, 6), return_index=True)[1]
    across = shot.points[waist, :2] / numpy.linalg.norm(shot.points[waist, :2], axis=1)[:, None]
    return angle[order], (mode[waist, :2] * across).sum(axis=1)[order]


def number_of_crests(angle, wave):
    """The degree of the largest Fourier coefficient."""
    turns = numpy.radians(angle)
    weight = (numpy.roll(turns, -1) - numpy.roll(turns, 1)) % (2 * numpy.pi)
    return int(numpy.argmax([abs((weight * wave * numpy.exp(-1j * m * turns)).sum()) for m in range(30)]))


def folds(outcome):
    """Rows: the second parameter, critical Ca and D there; as far as the run came."""
    series = outcome.series
    return numpy.array([series[name][series["fold"] > 0]
                        for name in ("second_parameter", "parameter", "taylor_surface")])


MAPS = [bursting, squeezing, wrinkling]
