"""Maps of the atlas about the surface: poles, thin bodies, tips, meshes that are carried along."""

from package import PENS, draw, line, lines, numpy, style, varied

LOOKS = [(style.FAINT, "-", 3.5), (style.RUNS[1], "--", 1.4), (style.RUNS[3], "--", 1.4), (style.RUNS[0], "-", 1.4)]


def pole_treatment(study, given, axes):
    pens = [pen | {"linestyle": "--" if "Gauss" in name else "-"} for name, pen in zip(given["cases"], PENS)]
    return lines(study, axes, given, ("pressure_l2_error", "drag_error"), "n_control_points", pens)


def gap(study, given, axes):
    tight = {h: given["base"] | thin | {"Quadrature/tolerance": 1e-10} for h, thin in varied(given).items()}
    rows = line(study, axes[:1], "the mesh", given["deck"], tight, ("drag_error", "drag_x1"), **style.GUIDE)
    true = {h: drag for _, h, _, drag, _ in rows}
    return rows + lines(study, axes, given, (
        lambda one: abs(one.final["drag_x1"] / true[one.run.value("Particle/semi-axes")[2]] - 1),
        lambda one: one.kernel_evaluations))


def gap_tube(study, given, axes):
    finer = {gap: radius | given["base"] | given["reference"] for gap, radius in varied(given).items()}
    rows = line(study, [], "n = 9", given["deck"], finer, ("velocity_x1",))
    true = {gap: velocity for _, gap, velocity, _ in rows} | given["exact"]
    return rows + lines(study, axes, given, [
        lambda one: abs(one.final["velocity_x1"] / true[round(1 - one.run.value("Particle/radius"), 2)] - 1)])


def hyperbolic(study, given, axes):
    return lines(study, axes, given, (
        lambda one: one.run.snapshots()[-1].fields["mean curvature"].min(), "smallest_tension", "taylor_inertia",
        "n_control_points"))


def tip_traction(study, given, axes):
    truth = None
    for (name, settings), (color, dash, width) in zip(given["cases"].items(), LOOKS):
        outcome = study.run(given["deck"], given["base"] | settings)
        if not outcome.done:
            yield name, "", "", "", outcome.message[:100]
            continue
        place, height, size = draw.near_tip(outcome.run.snapshots()[-1], "traction")
        truth = truth or (height, size)
        error = numpy.max(abs(numpy.interp(truth[0], height, size) - truth[1])) / truth[1].max()
        yield name, outcome.final["n_control_points"], error, outcome.final["taylor_inertia"], ""
        for axis, values in zip(axes, (place, size)):
            axis.plot(height, values, dash, color=color, linewidth=width,
                      label=f"{name}: {100 * error:.1f} %" if error > 0 else name)
    axes[0].set_ylim(bottom=axes[0].dataLim.y1 - 0.6)


def drop_mesh(study, given, axes):
    for (motion, settings), color, offset in zip(given["cases"].items(), style.RUNS, (-0.27, 0, 0.27)):
        for k, (ca, more) in enumerate(varied(given).items()):
            outcome = study.run(given["deck"], given["base"] | settings | more)
            stretch = _stretch(outcome.run.snapshots()[-1])
            yield ca, motion, outcome.end, stretch, outcome.series["taylor_surface"][-1], outcome.message[:100]
            for axis, value in zip(axes, (outcome.end, stretch)):
                axis.barh(k + offset, value, 0.24, color=color, label=f"`{motion}`" if k == 0 else None)


def _stretch(shot, k=3):
    """Returns the ratio of the largest area of a cell to the smallest one."""
    grid = shot.sampled(shot.points, k)
    along, across = numpy.diff(grid, axis=2)[:, :-1], numpy.diff(grid, axis=1)[:, :, :-1]
    areas = numpy.linalg.norm(numpy.cross(along, across), axis=-1).sum((1, 2))
    return areas.max() / areas.min()
