#!/usr/bin/python3
"""A rigid spheroid in uniform flow: Figures 8, 9, 10 and Table 1 of Maestre et al. 2017, for all meshes and quadrature
rules.

Runs inputs/spheroid_cube.yaml and inputs/spheroid_polar.yaml with several settings. A run that exists already is not
repeated. The largest meshes take minutes; `--largest 2` leaves them out. To plot the error against the cost, use
work_precision.py with the study spheroid.yaml.
"""

import pathlib
import sys

from package import answer, command_line, numpy, plt, scenes_of, style, table, tanktread

SETTINGS, OPTIONS, PAPER, MESHES, PANELS, SERIES = scenes_of(__file__).values()
STAR = {"marker": "*", "linestyle": "none", "color": style.INK, "ms": 9, "label": "paper, Table 1", "zorder": 5}
BELOW = {"loc": "upper center", "ncol": 2, "bbox_to_anchor": (0.5, 0)}  # the legend of a figure


def made(study, mesh, settings):
    """Returns the outcome of a run; None if it failed."""
    outcome = study.run(f"inputs/spheroid_{mesh}.yaml", settings)
    if not outcome.done:  # a missed expectation (exit code 1) is not a failure here
        print(f"  {outcome.message}", file=sys.stderr)
    return outcome if outcome.done else None


def sizes(study, option, largest):
    """Returns the outcomes of an option on its meshes, from coarse to fine."""
    meshes = MESHES[option["mesh"]][:largest + 1]
    return [one for one in (made(study, option["mesh"], option["settings"] | mesh) for mesh in meshes) if one]


def slope(points, errors):
    """Returns the mean convergence order in the number of control points, by least squares, and the order of the finest
    pair of meshes."""
    x, y = numpy.log(points), numpy.log(errors)
    return -numpy.polyfit(x, y, 1)[0], -(y[-1] - y[-2]) / (x[-1] - x[-2])


def column(outcomes, key):
    return numpy.array([one.final[key] for one in outcomes])


def draw_convergence(axes, found, key, factor=1.0, options=OPTIONS, cut="", **more):
    """Draws a line for each option. Options with a fixed quadrature rule have dashed lines and their own markers."""
    for name in options:
        option, outcomes = OPTIONS[name], [one for one in found[name] if key in one.final]
        look = {"color": style.RUNS[option["color"]], "linestyle": "--" if "mark" in option else "-", "ms": 4.5,
                "marker": option.get("mark", "o"), "label": option["label"].replace(cut, "")} | more
        axes.loglog(column(outcomes, "n_control_points"), factor * column(outcomes, key), **look)
    axes.set_xlabel("control points")


def figure_8(found):
    figure, axes = plt.subplots(figsize=(5.6, 4.2))
    # the quadrature rule does not change the surface, so there is one curve per surface
    draw_convergence(axes, found, "normal_l2_error", options=list(OPTIONS)[:4], cut=", rules by tolerance")
    axes.plot(546, PAPER["table"][2][0], **STAR)
    axes.plot([700, 3000], [6e-4, 6e-4 * (3000 / 700) ** -PAPER["slopes"]["normal"][1]], color=style.FAINT,
              linewidth=0.9, label="paper's mean slope, unstructured: 1.62")
    axes.set(ylabel="L2 error of the normal", title="Figure 8: the normal")
    figure.legend(*axes.get_legend_handles_labels(), **BELOW)
    return figure


def figure_9(found):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6))
    draw_convergence(left, found, "pressure_l2_error")
    draw_convergence(right, found, "drag_error", 100.0)
    draw_convergence(right, found, "drag_error_of_traction", 100.0, ["cube"], linestyle=":", mfc="none",
                     label="unstructured, without the reciprocal theorem")
    for axes, paper in (left, PAPER["table"][3][1]), (right, PAPER["table"][3][2]):
        axes.plot(546, paper, **STAR)
    left.set(ylabel="L2 error of the pressure", title="Figure 9 (a): the pressure")
    right.set(ylabel="error of the drag, per cent", title="Figure 9 (b): the drag")
    figure.legend(*right.get_legend_handles_labels(), **BELOW)
    return figure


def figure_10(found):
    """Returns the figure of the error of the pressure; None without runs on the third mesh."""
    shown = [(found[name][2], title) for name, title in PANELS.items() if len(found[name]) > 2]
    if not shown:
        return None
    figure, grid = plt.subplots(1, len(shown), figsize=(3.1 * len(shown), 4.6), squeeze=False)
    for axes, (outcome, title) in zip(grid[0], shown):  # the half x2 < 0 of the surface, seen along x2
        shot = outcome.run.snapshots()[-1]
        exact = abs(shot.fields["pressure"] - shot.fields["pressure error"]).max()
        points = shot.sampled(shot.points, 6)
        error = numpy.clip(abs(shot.sampled(shot.fields["pressure error"], 6)) / exact, 1e-7, None)
        near = points[..., 1].mean(axis=(1, 2)) < 1e-9
        for cell, values in zip(points[near], error[near]):
            mesh = axes.pcolormesh(cell[..., 0], cell[..., 2], values, shading="gouraud", cmap=style.FIELD,
                                   norm=plt.matplotlib.colors.LogNorm(1e-7, 1e-2), rasterized=True)
            # edges are left out where the Bezier transformation makes cells so narrow that the lines would cover them
            if numpy.linalg.norm(numpy.cross(cell[-1, -1] - cell[0, 0], cell[-1, 0] - cell[0, -1])) > 4e-4:
                edge = numpy.concatenate([cell[0], cell[:, -1], cell[-1, ::-1], cell[::-1, 0]])
                axes.plot(edge[:, 0], edge[:, 2], color="white", linewidth=0.25, alpha=0.6)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(f"{title}\n{outcome.final['n_control_points']:.0f} control points", fontsize=8.5)
    figure.colorbar(mesh, ax=grid, label="|p − exact p| / largest exact |p|", shrink=0.8)
    return figure


def table_1(study):
    print("\nTable 1: structured mesh of 546 control points, Bezier transformation, n azimuthal subdivisions\n")
    rows = []
    for level, paper in enumerate(PAPER["table"]):
        for label, settings in (("8 x 8 Gauss", SETTINGS["fixed"]), ("rules by tolerance", {})):
            outcome = made(study, "polar", SETTINGS["transform"] | settings | {"Surface/pole subdivisions": level})
            if outcome:
                *errors, drag = (outcome.final[f"{name}_error"] for name in ("normal_l2", "pressure_l2", "drag"))
                rows.append([level, label, *(f"{value:.3e}" for value in (*errors, 100 * drag, *paper))])
    table(["n", "rule", "normal", "pressure", "drag, per cent", "paper: normal", "pressure", "drag, per cent"], rows)


def table_of_options(found):
    print("\nSlopes against the number of control points: mean over the meshes, finest pair; drag_error_of_traction "
          "is without the reciprocal theorem\n")
    rows = []
    for name, option in OPTIONS.items():
        for key, of_paper in SERIES.items() if len(found[name]) > 1 else ():
            values = column(found[name], key)
            slopes = slope(column(found[name], "n_control_points"), values) if "error" in key else ()
            paper = PAPER["slopes"][of_paper][option["mesh"] == "cube"] if of_paper else ""
            rows.append([option["label"], key, ", ".join(f"{value:.3g}" for value in values),
                         ", ".join(f"{one:.2f}" for one in slopes), paper])
    table(["option", "series", "coarse to fine", "slopes", "paper"], rows)


def main():
    parser = command_line(__doc__)
    parser.add_argument("--results", default="results/spheroid", metavar="DIR",
                        help="directory of the runs (default: %(default)s)")
    parser.add_argument("-o", "--output", default=".", type=pathlib.Path, metavar="DIR",
                        help="directory of the figures (default: %(default)s)")
    parser.add_argument("--largest", type=int, default=3, choices=(1, 2, 3),
                        help="largest of the four meshes, which are numbered from 0 (default: %(default)s)")
    arguments = parser.parse_args()
    study = tanktread.Study(directory=arguments.results)
    found = {name: sizes(study, option, arguments.largest) for name, option in OPTIONS.items()}
    table_of_options(found)
    table_1(study)
    for number, figure in (8, figure_8(found)), (9, figure_9(found)), (10, figure_10(found)):
        if figure:
            style.save(figure, arguments.output / f"spheroid_figure_{number}.png")


if __name__ == "__main__":
    answer(main)
