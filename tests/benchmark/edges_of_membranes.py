"""Maps of the atlas about the membrane: compression, pre-stress, bending, the form of the load."""

from package import PENS, RATIO, SHEAR, SIDE, final, line, numpy, plt, style, ticks
import waves

PLAIN = "tests/stability/shear.yaml"  # says nothing of the mesh


def load_form(study):
    """Strong and weak load, with the poles on x₁, x₂, x₃ and on the cube

    Neo-Hookean capsule in shear to γ̇t = 2, 146 control points with two poles (Bézier transformation) or 218 on the
    cube. The divergence of the tension (P-3), collocated, takes second derivatives of a cubic surface and is not the
    gradient of an energy: it feeds the shape's errors, first at the poles, and steps vanish when the surface folds. The
    paper sees it at γ̇t = 0.664 for Ca = 0.45 and poles on x₂ (cross).

    Survives: virtual work (3.5), wherever the poles are; every bar to the end is one."""
    end, rows = 2.0, []
    polar = {"Surface/mesh": "polar", "Surface/azimuthal elements": 16, "Surface/meridional elements": 8}
    meshes = {f"poles on {axis}": polar | {"Surface/pole axis": axis} for axis in ("x1", "x2", "x3")}
    meshes["cube"] = {"Surface/mesh": "cube", SIDE: 6}
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.6), sharey=True)
    for axis, ca in zip(axes, (0.3, 0.45, 0.6)):
        for load, color, offset in (("strong", style.RUNS[1], -0.19), ("weak", style.RUNS[0], 0.19)):
            for k, (mesh, settings) in enumerate(meshes.items()):
                outcome = study.run(PLAIN, settings | {
                    "Membrane/capillary number": ca, "Membrane/load": load, "Time/final time": end,
                    "Time/minimum step": 1e-6, "Output/interval": end})
                axis.barh(k + offset, outcome.end, 0.34, color=color, label=f"{load} form" if k == 0 else None)
                axis.annotate(f"{outcome.end:.2f}", (0, k + offset), (3, 0), textcoords="offset points", va="center",
                              fontsize=7.5, color="white")
                rows.append((ca, mesh, load, outcome.end, outcome.message[:100]))
        axis.set(title=f"Ca = {ca:g}", xlabel="time reached", xlim=(0, end))
        axis.grid(visible=False, axis="y")
    axes[1].plot(0.664, 1 - 0.19, "x", color=style.INK, ms=7, mew=1.6, label="paper")
    axes[0].set_yticks(range(len(meshes)), meshes)
    axes[0].invert_yaxis()
    figure.legend(*axes[1].get_legend_handles_labels(), loc="upper right", ncols=3)
    return figure, ["capillary_number", "mesh", "load", "time_reached", "message"], rows


def buckling(study):
    """Low capillary numbers: an unsupported membrane buckles, and what prevents it

    Capsule in shear to γ̇t = 4 on two meshes (218 and 488 control points). Left: the smallest principal tension at the
    end; below zero a membrane without bending stiffness is unstable, the faster the shorter the wave. Right: how much
    of its load per area is in waves too short for the flow (spherical harmonics of degree 9 and more); where two meshes
    differ there, waves follow the mesh.

    Survives: a bending modulus, pre-inflation by 5 %, or Ca between the windows of compression (0.45 to 0.6 for this
    law). A viscous filling (λ = 5) only delays."""
    values = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6]
    cures = {"bending 0.02 R²G_s": lambda ca: {"Membrane/bending modulus": 0.02 / ca}, "as it is": lambda ca: {},
             "pre-inflation 5 %": lambda ca: {"Membrane/pre-inflation": 0.05}, "λ = 5": lambda ca: {RATIO: 5.0}}
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4))
    rows = []
    for (name, cure), pen in zip(cures.items(), PENS):
        for n, dash in (6, ":"), (9, "-"):
            jobs = {ca: (SHEAR, cure(ca) | {SIDE: n, "Membrane/capillary number": ca, "Time/final time": 4.0,
                                            "Output/interval": 1.0}) for ca in values}
            rows += line(study, (left, right), f"{name}, n = {n}", jobs, (
                final("smallest_tension"), lambda one: waves.short_share(one.run)), linestyle=dash, **pen)
    left.axhline(0, color=style.FAINT, linewidth=0.9)
    for axis, label in (left, "smallest tension over G_s"), (right, "share of the load in degrees ≥ 9"):
        ticks(axis, values, "Ca")
        axis.set_ylabel(label)
    right.set_yscale("log")
    left.legend(loc="best", fontsize=7)
    return figure, ["cure", "capillary_number", "smallest_tension", "short_share", "message"], rows


def pre_inflation(study):
    """How much pre-inflation keeps a capsule under tension

    Neo-Hookean capsule in shear, 98 control points: the smallest principal tension over G_s while it goes to its steady
    shape (γ̇t = 3). Below the line through zero the membrane is compressed at some place and time and needs resistance
    to bending.

    Survives: α above the line; 1 % at Ca = 0.02, 2.3 % at 0.1, 4 % at 0.3. Beyond Ca = 0.6 the compression is that of
    the tips."""
    capillary, inflation = [0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.9], [0.0, 0.01, 0.02, 0.03, 0.05, 0.08]
    pairs = [(ca, alpha) for alpha in inflation for ca in capillary]
    outcomes = study.all([(SHEAR, {SIDE: 4, "Membrane/capillary number": ca, "Membrane/pre-inflation": alpha,
                                   "Time/final time": 3.0, "Output/interval": 3.0}) for ca, alpha in pairs])
    smallest = [outcome.series["smallest_tension"].min() if outcome.done else numpy.nan for outcome in outcomes]
    field = numpy.reshape(smallest, (len(inflation), len(capillary)))
    bound = numpy.nanmax(abs(field))
    x, y = numpy.meshgrid(capillary, 100 * numpy.array(inflation))
    figure, axis = plt.subplots(figsize=(7.2, 4.6))
    filled = axis.contourf(x, y, field, numpy.linspace(-bound, bound, 21), cmap=style.SIGNED)
    axis.contour(x, y, field, [0], colors=style.INK, linewidths=1.4)
    axis.plot(x, y, ".", color=style.INK, ms=2)
    ticks(axis, capillary, "Ca")
    axis.set_ylabel("pre-inflation α, per cent")
    axis.grid(visible=False)
    figure.colorbar(filled, label="smallest tension over G_s")
    rows = [(*pair, value) for pair, value in zip(pairs, smallest)]
    return figure, ["capillary_number", "pre_inflation", "smallest_tension"], rows


MAPS = [load_form, buckling, pre_inflation]
