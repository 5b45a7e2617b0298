#!/usr/bin/python3
"""The paper's section 4.1: Figures 8, 9 and 10 and Table 1, for every surface and every way to take the integrals.

Runs inputs/spheroid_cube.yaml and inputs/spheroid_polar.yaml with one key or another changed; a run that has been made
already is not made again. The largest meshes take minutes; `--largest 2` leaves them out. Error against work is the
study spheroid.yaml of work_precision.py.
"""

import pathlib
import sys

from package import SIDE, answer, command_line, numpy, plt, style, table, tanktread

SIZES = [0, 1, 2, 3]  # 56, 218, 866, 3458 control points on the cube; 42, 146, 546, 2114 on the structured mesh
# normal, pressure and drag (per cent) on the structured mesh of 546 control points, by azimuthal subdivisions
PAPER_TABLE = [(1.332e-3, 6.499e-4, 1.735e-6), (3.494e-4, 2.362e-4, 1.682e-6), (8.947e-5, 1.825e-4, 1.679e-6),
               (8.947e-5, 1.781e-4, 1.679e-6)]
PAPER_SLOPES = {"normal": (2.03, 1.62), "pressure": (1.61, 1.64), "drag": (2.21, 2.28)}  # structured, unstructured
FIXED = {"Quadrature/rule": "fixed", "Quadrature/points": 8}
SMOOTH = {"Quadrature/rule": "desingularised", "Quadrature/points": 8}
PLAIN, C1 = {"Surface/poles": "plain"}, {"Surface/poles": "c1"}
TRANSFORM = {"Surface/poles": "bezier transform"}
STAR = {"marker": "*", "linestyle": "none", "color": style.INK, "ms": 9, "label": "paper, Table 1", "zorder": 5}


def pen(color, fixed=None):
    """Returns how a curve is drawn: broken, with the mark `fixed`, if it is by a fixed rule."""
    return {"color": style.RUNS[color], "linestyle": "--" if fixed else "-", "marker": fixed or "o", "ms": 4.5}


# name: label, mesh, settings, pen
OPTIONS = {
    "cube": ("unstructured, rules by tolerance", "cube", {}, pen(0)),
    "c1": ("structured, C1 poles, rules by tolerance", "polar", C1, pen(2)),
    "plain": ("structured, plain poles, rules by tolerance", "polar", PLAIN, pen(1)),
    "transform": ("structured, Bézier transformation, rules by tolerance", "polar", TRANSFORM, pen(3)),
    "cube_fixed": ("unstructured, 8 × 8 Gauss", "cube", FIXED, pen(0, "s")),
    "plain_fixed": ("structured, plain poles, 8 × 8 Gauss (standard)", "polar", FIXED | PLAIN, pen(1, "s")),
    "c1_smooth": ("structured, C1 poles, desingularised", "polar", SMOOTH | C1, pen(4, "D")),
    "transform_fixed": ("structured, Bézier transformation, 8 × 8 Gauss", "polar",
                        FIXED | TRANSFORM | {"Surface/pole subdivisions": 3}, pen(3, "s")),
}


def made(study, mesh, settings):
    """Returns the final values of a run, with its directory; None if it failed."""
    outcome = study.run(f"inputs/spheroid_{mesh}.yaml", settings)
    if not outcome.done:  # errors beyond what the deck as it stands expects are its end too
        print(f"  {outcome.message}", file=sys.stderr)
        return None
    return dict(outcome.final, directory=outcome.directory)


def sizes(study, option, largest):
    """Returns the final values of an option on its meshes, coarse to fine."""
    _, mesh, settings, _ = OPTIONS[option]
    extents = [{SIDE: 3 * 2**size} if mesh == "cube" else {
        "Surface/azimuthal elements": 8 * 2**size, "Surface/meridional elements": 4 * 2**size}
        for size in SIZES[:largest + 1]]
    return [one for one in (made(study, mesh, settings | extent) for extent in extents) if one]


def slope(points, errors):
    """Returns the mean order in the number of control points, by least squares, and that of the finest pair."""
    x, y = numpy.log(points), numpy.log(errors)
    return -numpy.polyfit(x, y, 1)[0], -(y[-1] - y[-2]) / (x[-1] - x[-2])


def column(runs, key):
    return numpy.array([one[key] for one in runs])


def draw_convergence(axes, found, key, factor=1.0, options=OPTIONS, cut=""):
    for name in options:
        label, _, _, look = OPTIONS[name]
        runs = [one for one in found[name] if key in one]
        axes.loglog(column(runs, "n_control_points"), factor * column(runs, key), label=label.replace(cut, ""), **look)
    axes.set_xlabel("control points")


def legend_below(figure, axes):
    figure.legend(*axes.get_legend_handles_labels(), loc="upper center", ncol=2, bbox_to_anchor=(0.5, 0))


def figure_8(found, path):
    figure, axes = plt.subplots(figsize=(5.6, 4.2))
    # the rule does not change the surface: one curve a surface
    draw_convergence(axes, found, "normal_l2_error", options=list(OPTIONS)[:4], cut=", rules by tolerance")
    axes.plot(546, PAPER_TABLE[2][0], **STAR)
    guide = numpy.array([700, 3000])
    axes.plot(guide, 6e-4 * (guide / guide[0]) ** -PAPER_SLOPES["normal"][1], color=style.FAINT, linewidth=0.9,
              label="paper's mean slope, unstructured: 1.62")
    axes.set(ylabel="L2 error of the normal", title="Figure 8: the normal")
    legend_below(figure, axes)
    style.save(figure, path)


def figure_9(found, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6))
    draw_convergence(left, found, "pressure_l2_error")
    draw_convergence(right, found, "drag_error", 100.0)
    cube = [one for one in found["cube"] if "drag_error_of_traction" in one]
    right.loglog(column(cube, "n_control_points"), 100 * column(cube, "drag_error_of_traction"), ":", marker="o",
                 color=style.RUNS[0], ms=4.5, mfc="none", label="unstructured, without the reciprocal theorem")
    for axes, paper in (left, PAPER_TABLE[3][1]), (right, PAPER_TABLE[3][2]):
        axes.plot(546, paper, **STAR)
    left.set(ylabel="L2 error of the pressure", title="Figure 9 (a): the pressure")
    right.set(ylabel="error of the drag, per cent", title="Figure 9 (b): the drag")
    legend_below(figure, right)
    style.save(figure, path)


def figure_10(found, path):
    wanted = {"plain_fixed": "(a) plain poles, 8 × 8 Gauss", "cube": "(c) unstructured",
              "transform_fixed": "(b) Bézier transformation, 8 × 8 Gauss", "c1": "(d) C1 poles, rules by tolerance"}
    shown = [(found[name][2], title) for name, title in wanted.items() if len(found[name]) > 2]
    if not shown:
        return
    figure, grid = plt.subplots(1, len(shown), figsize=(3.1 * len(shown), 4.6), squeeze=False)
    for axes, (run, title) in zip(grid[0], shown):
        mesh = draw_pressure_error(axes, run, title)
    figure.colorbar(mesh, ax=grid, label="|p − exact| over the largest exact p", shrink=0.8)
    style.save(figure, path)


def draw_pressure_error(axes, run, title, k=6):
    """Draws the half x2 < 0 of the surface, seen along x2, coloured by the error of the pressure."""
    shot = tanktread.run(run["directory"]).snapshots()[-1]
    exact = abs(shot.fields["pressure"] - shot.fields["pressure error"]).max()
    points = shot.sampled(shot.points, k)
    error = numpy.clip(abs(shot.sampled(shot.fields["pressure error"], k)) / exact, 1e-7, None)
    near = points[..., 1].mean(axis=(1, 2)) < 1e-9
    norm = plt.matplotlib.colors.LogNorm(1e-7, 1e-2)
    for cell, values in zip(points[near], error[near]):
        mesh = axes.pcolormesh(cell[..., 0], cell[..., 2], values, shading="gouraud", cmap=style.FIELD, norm=norm,
                               rasterized=True)
        # the slim pieces of transformed elements would be all outline
        if numpy.linalg.norm(numpy.cross(cell[-1, -1] - cell[0, 0], cell[-1, 0] - cell[0, -1])) > 4e-4:
            edge = numpy.concatenate([cell[0], cell[:, -1], cell[-1, ::-1], cell[::-1, 0]])
            axes.plot(edge[:, 0], edge[:, 2], color="white", linewidth=0.25, alpha=0.6)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(f"{title}\n{run['n_control_points']:.0f} control points", fontsize=8.5)
    return mesh


def table_1(study):
    print("\nTable 1: structured mesh of 546 control points, Bezier transformation, n azimuthal subdivisions\n")
    rows = []
    for level, paper in enumerate(PAPER_TABLE):
        for label, settings in (("8 x 8 Gauss", FIXED), ("rules by tolerance", {})):
            run = made(study, "polar", TRANSFORM | settings | {"Surface/pole subdivisions": level})
            if run:
                values = run["normal_l2_error"], run["pressure_l2_error"], 100 * run["drag_error"], *paper
                rows.append([level, label, *(f"{value:.3e}" for value in values)])
    table(["n", "rule", "normal", "pressure", "drag, per cent", "paper: normal", "pressure", "drag, per cent"], rows)


def table_of_options(found):
    print("\nSlopes against the number of control points: mean over the meshes, finest pair; drag_error_of_traction "
          "is without the reciprocal theorem\n")
    keys = {"normal_l2_error": "normal", "pressure_l2_error": "pressure", "drag_error": "drag",
            "drag_error_of_traction": "", "solver_iterations": "", "kernel_evaluations": "", "wall_seconds": ""}
    rows = []
    for name, (label, mesh, *_) in OPTIONS.items():
        for key, of_paper in keys.items() if len(found[name]) > 1 else ():
            values = column(found[name], key)
            slopes = slope(column(found[name], "n_control_points"), values) if "error" in key else ()
            paper = PAPER_SLOPES[of_paper][mesh == "cube"] if of_paper else ""
            rows.append([label, key, ", ".join(f"{value:.3g}" for value in values),
                         ", ".join(f"{one:.2f}" for one in slopes), paper])
    table(["option", "series", "coarse to fine", "slopes", "paper"], rows)


def main():
    parser = command_line(__doc__)
    parser.add_argument("--results", default="results/spheroid", metavar="DIR", help="of runs (default: %(default)s)")
    parser.add_argument("-o", "--output", default=".", type=pathlib.Path, metavar="DIR",
                        help="of the pictures (default: %(default)s)")
    parser.add_argument("--largest", type=int, default=3, choices=SIZES[1:],
                        help="largest mesh of the four (default: %(default)s)")
    arguments = parser.parse_args()
    study = tanktread.Study(directory=arguments.results)
    found = {name: sizes(study, name, arguments.largest) for name in OPTIONS}
    table_of_options(found)
    table_1(study)
    figure_8(found, arguments.output / "spheroid_figure_8.png")
    figure_9(found, arguments.output / "spheroid_figure_9.png")
    figure_10(found, arguments.output / "spheroid_figure_10.png")


if __name__ == "__main__":
    answer(main)
