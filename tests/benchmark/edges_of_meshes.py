"""Maps of the atlas about the surface: poles, thin bodies, tips, meshes that are carried along."""

from package import draw, line, lines, numpy, panels, style, ticks

LOOKS = [(style.FAINT, "-", 3.5), (style.RUNS[1], "--", 1.4), (style.RUNS[3], "--", 1.4), (style.RUNS[0], "-", 1.4)]


def pole_treatment(study, given):
    figure, (axis,) = panels(given)
    rows = lines(study, [axis], given, lambda n: {
        "Surface/meridional elements": n, "Surface/azimuthal elements": 2 * n}, ("pressure_l2_error", "drag_error"),
        "n_control_points")
    for curve in axis.lines:
        curve.set_linestyle("--" if "Gauss" in curve.get_label() else "-")
    axis.legend(loc="best")
    return figure, rows


def gap(study, given):
    def thin(h):
        return {"Particle/semi-axes": f"[1.0, 1.0, {h}]"}

    figure, (left, right) = panels(given)
    tight = {h: given["base"] | thin(h) | {"Quadrature/tolerance": 1e-10} for h in given["values"]}
    rows = line(study, [left], "the mesh", given["deck"], tight, ("drag_error", "drag_x1"), color=style.FAINT,
                linestyle=(0, (4, 3)))
    true = {h: drag for _, h, _, drag, _ in rows}

    def error(outcome):
        return abs(outcome.final["drag_x1"] / true[outcome.run.value("Particle/semi-axes")[2]] - 1)

    rows += lines(study, (left, right), given, thin, (error, lambda one: one.kernel_evaluations))
    for axis in left, right:
        ticks(axis, given["values"])
    left.legend(loc="best")
    return figure, rows


def gap_tube(study, given):
    def radius(gap):
        return {"Particle/radius": round(1 - gap, 2)}

    finer = {gap: radius(gap) | given["base"] | given["reference"] for gap in given["values"]}
    rows = line(study, [], "n = 9", given["deck"], finer, ("velocity_x1",))
    true = {gap: velocity for _, gap, velocity, _ in rows} | given["exact"]

    def error(outcome):
        return abs(outcome.final["velocity_x1"] / true[round(1 - outcome.run.value("Particle/radius"), 2)] - 1)

    figure, (axis,) = panels(given)
    rows += lines(study, [axis], given, radius, (error,))
    ticks(axis, given["values"])
    axis.legend(loc="best")
    return figure, rows


def hyperbolic(study, given):
    figure, (left, right) = panels(given)
    rows = lines(study, (left, right), given, lambda ca: {"Membrane/capillary number": ca}, (
        lambda one: one.run.snapshots()[-1].fields["mean curvature"].min(), "smallest_tension", "taylor_inertia",
        "n_control_points"))
    for axis in left, right:
        axis.axhline(0, color=style.FAINT, linewidth=0.9)
    left.legend(loc="center right", bbox_to_anchor=(1, 0.33))
    return figure, rows


def tip_traction(study, given):
    figure, (outline, along) = panels(given)
    truth, rows = None, []
    for (name, settings), (color, dash, width) in zip(given["cases"].items(), LOOKS):
        outcome = study.run(given["deck"], given["base"] | settings)
        if not outcome.done:
            rows.append((name, "", "", "", outcome.message[:100]))
            continue
        place, height, size = draw.near_tip(outcome.run.snapshots()[-1], "traction")
        truth = truth or (height, size)
        error = numpy.max(abs(numpy.interp(truth[0], height, size) - truth[1])) / truth[1].max()
        rows.append((name, outcome.final["n_control_points"], error, outcome.final["taylor_inertia"], ""))
        for axis, values in (outline, place), (along, size):
            axis.plot(height, values, dash, color=color, linewidth=width,
                      label=f"{name}: {100 * error:.1f} %" if error > 0 else name)
    for axis in outline, along:
        axis.set_xlim(-0.3, 0.3)
    outline.set_ylim(bottom=outline.dataLim.y1 - 0.6)
    outline.legend(loc="lower center", title="control points: error of the traction")
    return figure, rows


def drop_mesh(study, given):
    figure, (left, right) = panels(given)
    rows, values = [], given["values"]
    for j, ((motion, settings), color) in enumerate(zip(given["cases"].items(), style.RUNS)):
        for k, ca in enumerate(values):
            outcome = study.run(given["deck"], given["base"] | settings | {"Membrane/capillary number": ca})
            stretch = _stretch(outcome.run.snapshots()[-1])
            left.barh(k + 0.27 * (j - 1), outcome.end, 0.24, color=color, label=f"`{motion}`" if k == 0 else None)
            right.barh(k + 0.27 * (j - 1), stretch, 0.24, color=color)
            rows.append((ca, motion, outcome.end, stretch, outcome.series["taylor_surface"][-1], outcome.message[:100]))
    for axis in left, right:
        axis.set_yticks(range(len(values)), [f"Ca = {ca:g}" for ca in values])
        axis.grid(visible=False, axis="y")
    right.set_xscale("log")
    figure.legend(*left.get_legend_handles_labels(), loc="upper right", ncols=3)
    return figure, rows


def _stretch(shot, k=3):
    """Returns the ratio of the largest area of a cell to the smallest one."""
    grid = shot.sampled(shot.points, k)
    along, across = numpy.diff(grid, axis=2)[:, :-1], numpy.diff(grid, axis=1)[:, :, :-1]
    areas = numpy.linalg.norm(numpy.cross(along, across), axis=-1).sum((1, 2))
    return areas.max() / areas.min()
