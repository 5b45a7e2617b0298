#!/usr/bin/python3
"""The paper's section 4.1: Figures 8, 9 and 10, Table 1, and error against work, for every surface and every way to
take the integrals.

Runs inputs/spheroid_cube.yaml and inputs/spheroid_polar.yaml with one key or another changed, keeps the results, and
draws what is there. A run that has been made already is not made again. The largest meshes take minutes; `--largest 2`
leaves them out.
"""

import argparse
import math
import pathlib
import sys

from package import answer, numpy, plt, style, tanktread

SIZES = [0, 1, 2, 3]  # 56, 218, 866, 3458 control points on the cube; 42, 146, 546, 2114 on the structured mesh

PAPER_TABLE = [(1.332e-3, 6.499e-4, 1.735e-6), (3.494e-4, 2.362e-4, 1.682e-6), (8.947e-5, 1.825e-4, 1.679e-6),
               (8.947e-5, 1.781e-4, 1.679e-6)]
PAPER_SLOPES = {"normal": (2.03, 1.62), "pressure": (1.61, 1.64), "drag": (2.21, 2.28)}  # structured, unstructured

FIXED = {"Quadrature/rule": "fixed", "Quadrature/points": 8}
SMOOTH = {"Quadrature/rule": "desingularised", "Quadrature/points": 8}
TRANSFORM = {"Surface/poles": "bezier transform"}
EIGHTFOLD = TRANSFORM | {"Surface/pole subdivisions": 3}


class Option:
    """A way to solve the problem: label, deck, settings, and how it is drawn. `paper`: one of the paper's own."""

    def __init__(self, name, label, mesh, settings, color, line="-", mark="o", paper=False):
        self.name, self.label, self.mesh, self.settings = name, label, mesh, settings
        self.pen = {"color": color, "linestyle": line, "marker": mark, "ms": 4.5, "mfc": "none" if paper else color,
                    "mew": 1.1}


OPTIONS = [Option("cube", "unstructured, rules by tolerance", "cube", {}, style.RUNS[0]),
           Option("c1", "structured, C1 poles, rules by tolerance", "polar", {"Surface/poles": "c1"}, style.RUNS[2]),
           Option("plain", "structured, plain poles, rules by tolerance", "polar", {"Surface/poles": "plain"},
                  style.RUNS[1]),
           Option("transform", "structured, Bézier transformation, rules by tolerance", "polar", TRANSFORM,
                  style.RUNS[3]),
           Option("cube_fixed", "unstructured, 8 × 8 Gauss", "cube", FIXED, style.RUNS[0], "--", "s", True),
           Option("plain_fixed", "structured, plain poles, 8 × 8 Gauss (standard)", "polar",
                  FIXED | {"Surface/poles": "plain"}, style.RUNS[1], "--", "s", True),
           Option("c1_smooth", "structured, C1 poles, desingularised", "polar", SMOOTH | {"Surface/poles": "c1"},
                  style.RUNS[4], "--", "D", True), Option("transform_fixed",
                                                          "structured, Bézier transformation, 8 × 8 Gauss", "polar",
                                                          FIXED | EIGHTFOLD, style.RUNS[3], "--", "s", True),]


class Study:
    """Runs of the two decks, made where they are missing."""

    def __init__(self, program, directory, makes):
        self.runs, self.makes = tanktread.Study(program, directory), makes

    def run(self, mesh, settings):
        """The final values of a run, with its directory; None where it is missing and may not be made, or failed."""
        deck = f"inputs/spheroid_{mesh}.yaml"
        where = self.runs.directory / self.runs.name([deck], settings)
        if not (self.makes or (where / "summary.yaml").exists()):
            return None
        outcome = self.runs.run(deck, settings)
        if not outcome.done:  # errors beyond what the deck as it stands expects are its end too
            print(f"  {outcome.message}", file=sys.stderr)
            return None
        return dict(outcome.final, directory=where)

    def at_size(self, option, size, largest):
        if size > largest:
            return None
        extent = {"Surface/elements per side": 3 * 2**size} if option.mesh == "cube" else {
            "Surface/azimuthal elements": 8 * 2**size, "Surface/meridional elements": 4 * 2**size}
        return self.run(option.mesh, option.settings | extent)


def slope(points, errors):
    """Mean order in the number of control points, by least squares, and that of the finest pair."""
    x, y = numpy.log(points), numpy.log(errors)
    return -numpy.polyfit(x, y, 1)[0], -(y[-1] - y[-2]) / (x[-1] - x[-2])


def converge(study, largest):
    """{option name: list of final values, coarse to fine}"""
    found = {}
    for option in OPTIONS:
        runs = [study.at_size(option, size, largest) for size in SIZES]
        found[option.name] = [one for one in runs if one]
    return found


def column(runs, key):
    return numpy.array([one[key] for one in runs])


def draw_convergence(axes, found, key, factor=1.0, options=OPTIONS):
    for option in options:
        runs = [one for one in found[option.name] if key in one]
        if runs:
            axes.loglog(column(runs, "n_control_points"), factor * column(runs, key), label=option.label, **option.pen)
    axes.set_xlabel("control points")


def draw_guide(axes, points, start, order, text):
    end = start * (points[1] / points[0]) ** -order
    axes.plot(points, [start, end], color=style.FAINT, linewidth=0.9, zorder=1)
    axes.annotate(text, (points[1], end), color=style.FAINT, fontsize=8, xytext=(3, -2), textcoords="offset points")


def normal_far_from_extraordinary_points(run):
    """L2 error of the normal over what is at least 0.5 away, on the unit sphere, from the images of the cube's
    corners."""
    result = tanktread.run(run["directory"])
    axes = numpy.array(result.value("Particle/semi-axes"))
    snapshot = result.snapshots()[-1]
    exact = snapshot.points / axes**2
    exact /= numpy.linalg.norm(exact, axis=1)[:, None]
    difference = ((snapshot.fields["Normals"] - exact) ** 2).sum(axis=1)
    square = area = 0.0
    for cell in snapshot.cells:
        corners = snapshot.points[cell[:4]]
        middle = numpy.abs(corners.mean(axis=0) / axes)
        if numpy.linalg.norm(middle / numpy.linalg.norm(middle) - 3**-0.5) < 0.5:
            continue
        share = 0.5 * numpy.linalg.norm(numpy.cross(corners[2] - corners[0], corners[3] - corners[1]))
        square += share * difference[cell].mean()
        area += share
    return math.sqrt(square / area)


def figure_8(found, path):
    figure, axes = plt.subplots(figsize=(5.6, 4.2))
    # The rule does not change the surface: one curve a surface.
    draw_convergence(axes, found, "normal_l2_error",
                     options=[o for o in OPTIONS if o.name in ("cube", "c1", "plain", "transform")])
    points = column(found["cube"], "n_control_points")
    far = [normal_far_from_extraordinary_points(one) for one in found["cube"]]
    axes.loglog(points, far, color=style.RUNS[0], linestyle=":", marker="o", ms=4.5, mfc="none",
                label="unstructured, far from extraordinary points")
    print("\nNormal on the cube mesh, far from its extraordinary points:", " ".join(f"{error:.3e}" for error in far),
          "  slope %.2f, finest pair %.2f" % slope(points, far))
    axes.plot(546, PAPER_TABLE[2][0], "*", color=style.INK, ms=9, label="paper, Table 1", zorder=5)
    draw_guide(axes, (700, 3000), 6e-4, PAPER_SLOPES["normal"][1], "paper's mean slope,\nunstructured: 1.62")
    axes.set(ylabel="L2 error of the normal", title="Figure 8: the normal")
    for text in (line for line in axes.get_lines() if "," in str(line.get_label())):
        text.set_label(text.get_label().replace(", rules by tolerance", ""))
    figure.legend(*axes.get_legend_handles_labels(), loc="upper center", ncol=2, bbox_to_anchor=(0.5, 0))
    style.save(figure, path)


def figure_9(found, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6))
    draw_convergence(left, found, "pressure_l2_error")
    left.plot(546, PAPER_TABLE[3][1], "*", color=style.INK, ms=9, label="paper, Table 1", zorder=5)
    left.set(ylabel="L2 error of the pressure", title="Figure 9 (a): the pressure")
    draw_convergence(right, found, "drag_error", 100.0)
    cube = [one for one in found["cube"] if "drag_error_of_traction" in one]
    right.loglog(column(cube, "n_control_points"), 100 * column(cube, "drag_error_of_traction"), color=style.RUNS[0],
                 linestyle=":", marker="o", ms=4.5, mfc="none", label="unstructured, without the reciprocal theorem")
    right.plot(546, PAPER_TABLE[3][2], "*", color=style.INK, ms=9, label="paper, Table 1", zorder=5)
    right.set(ylabel="error of the drag, per cent", title="Figure 9 (b): the drag")
    handles, labels = right.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=2, bbox_to_anchor=(0.5, 0))
    style.save(figure, path)


def figure_10(study, found, path):
    wanted = [("plain_fixed", "(a) plain poles, 8 × 8 Gauss"),
              ("transform_fixed", "(b) Bézier transformation, 8 × 8 Gauss"), ("cube", "(c) unstructured"),
              ("c1", "(d) C1 poles, rules by tolerance")]
    shown = [(found[name][2], title) for name, title in wanted if len(found[name]) > 2]
    if not shown:
        return
    figure, all_axes = plt.subplots(1, len(shown), figsize=(3.1 * len(shown), 4.6))
    mesh = None
    for axes, (run, title) in zip(numpy.atleast_1d(all_axes), shown):
        mesh = draw_pressure_error(axes, run, title)
    figure.colorbar(mesh, ax=all_axes, label="|p − exact| over the largest exact p", shrink=0.8)
    style.save(figure, path)


def draw_pressure_error(axes, run, title):
    """The half x2 < 0 of the surface, seen along x2, coloured by the error of the pressure."""
    snapshot = tanktread.run(run["directory"]).snapshots()[-1]
    k = 6
    points = snapshot.sampled(snapshot.points, k)
    exact = numpy.abs(snapshot.fields["pressure"] - snapshot.fields["pressure error"]).max()
    error = numpy.clip(numpy.abs(snapshot.sampled(snapshot.fields["pressure error"], k)) / exact, 1e-7, None)
    near = points[..., 1].mean(axis=(1, 2)) < 1e-9
    points, error = points[near], error[near]
    corner = (numpy.arange(k)[:, None] * (k + 1) + numpy.arange(k)).ravel()
    two = numpy.concatenate([corner[:, None] + [0, 1, k + 1], corner[:, None] + [1, k + 2, k + 1]])
    triangles = (numpy.arange(len(points))[:, None, None] * (k + 1) ** 2 + two).reshape(-1, 3)
    mesh = axes.tripcolor(points[..., 0].ravel(), points[..., 2].ravel(), triangles, error.ravel(), shading="gouraud",
                          cmap=style.FIELD, norm=plt.matplotlib.colors.LogNorm(1e-7, 1e-2), rasterized=True)
    for cell in points:
        # the slim pieces of transformed elements would be all outline
        if numpy.linalg.norm(numpy.cross(cell[-1, -1] - cell[0, 0], cell[-1, 0] - cell[0, -1])) < 4e-4:
            continue
        edge = numpy.concatenate([cell[0], cell[:, -1], cell[-1, ::-1], cell[::-1, 0]])
        axes.plot(edge[:, 0], edge[:, 2], color="white", linewidth=0.25, alpha=0.6)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(f"{title}\n{run['n_control_points']:.0f} control points", fontsize=8.5)
    return mesh


def table_1(study):
    print("\nTable 1: structured mesh of 546 control points, Bezier transformation, n azimuthal subdivisions; drag in "
          "per cent")
    print(f"{'':30}{'normal':>11}{'pressure':>11}{'drag %':>11}   paper: normal, pressure, drag %")
    for level, paper in enumerate(PAPER_TABLE):
        for label, settings in (("8 x 8 Gauss", FIXED), ("rules by tolerance", {})):
            run = study.run("polar", TRANSFORM | settings | {"Surface/pole subdivisions": level})
            if run:
                print(f"n = {level}, {label:23} {run['normal_l2_error']:10.3e} {run['pressure_l2_error']:10.3e} "
                      f"{100 * run['drag_error']:10.3e}   {paper[0]:.3e}  {paper[1]:.3e}  {paper[2]:.3e}")


def table_of_options(found, largest):
    print("\nSlopes against the number of control points: mean over the meshes, finest pair; drag_error_of_traction "
          "is without the reciprocal theorem")
    keys = [("normal", "normal_l2_error"), ("pressure", "pressure_l2_error"), ("drag", "drag_error"),
            ("its traction's", "drag_error_of_traction")]
    for option in OPTIONS:
        runs = found[option.name]
        if len(runs) < 2:
            continue
        print(f"{option.label}")
        points = column(runs, "n_control_points")
        for name, key in keys:
            errors = column(runs, key)
            mean, finest = slope(points, errors)
            paper = PAPER_SLOPES.get(name)
            beside = f"   paper {paper[option.mesh == 'cube']:.2f}" if paper else ""
            print(f"  {name:14} " + " ".join(f"{e:10.3e}"
                                             for e in errors)
                  + f"   slope {mean:5.2f}, finest pair {finest:5.2f}{beside}")
        print("  iterations     " + " ".join(f"{one['solver_iterations']:10.0f}" for one in runs))
        print("  evaluations    " + " ".join(f"{one['kernel_evaluations']:10.3g}" for one in runs))
        print("  seconds        " + " ".join(f"{one['wall_seconds']:10.2f}" for one in runs))


def work(study, path):
    """Error of drag and pressure against seconds and kernel evaluations, for one option after another, at 866 or 546
    control points."""
    sweeps = [("cube", "unstructured, tolerance 1e-3 … 1e-10", "cube", {}, "tolerance"),
              ("c1", "structured, C1 poles, tolerance", "polar", {"Surface/poles": "c1"}, "tolerance"),
              ("plain", "structured, plain poles, tolerance", "polar", {"Surface/poles": "plain"}, "tolerance"),
              ("transform", "structured, Bézier transformation, tolerance", "polar", TRANSFORM, "tolerance"),
              ("cube_fixed", "unstructured, fixed rule, 4 … 16 points", "cube", {"Quadrature/rule": "fixed"}, "points"),
              ("cube_smooth", "unstructured, desingularised, points", "cube", {"Quadrature/rule": "desingularised"},
               "points"),
              ("plain_fixed", "structured, plain poles, fixed rule, points", "polar",
               {"Quadrature/rule": "fixed", "Surface/poles": "plain"}, "points"),
              ("c1_smooth", "structured, C1 poles, desingularised, points", "polar",
               {"Quadrature/rule": "desingularised", "Surface/poles": "c1"}, "points"),]
    figure, grid = plt.subplots(2, 2, figsize=(10.5, 7.6), sharey="row")
    for i, (name, label, mesh, settings, key) in enumerate(sweeps):
        values = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10] if key == "tolerance" else [4, 6, 8, 12, 16]
        runs = [study.run(mesh, settings | {"Particle/forces": "integral", f"Quadrature/{key}": value})
                for value in values]
        runs = [one for one in runs if one]
        pen = {"color": style.RUNS[i % 4], "linestyle": "-" if key == "tolerance" else "--",
               "marker": style.MARKS[i // 4], "ms": 4, "label": label}
        for row, error in enumerate(("pressure_l2_error", "drag_error")):
            for axes, cost in zip(grid[row], ("kernel_evaluations", "wall_seconds")):
                axes.loglog(column(runs, cost), column(runs, error), **pen)
        for value, one in zip(values, runs):
            print(f"{name:14} {key} {value:8g}: pressure {one['pressure_l2_error']:.3e}, drag {one['drag_error']:.3e}, "
                  f"{one['kernel_evaluations']:.3g} kernel evaluations, {one['wall_seconds']:.2f} s")
    for row, name in enumerate(("L2 error of the pressure", "error of the drag (integral of the traction)")):
        grid[row][0].set_ylabel(name)
    grid[1][0].set_xlabel("kernel evaluations")
    grid[1][1].set_xlabel("seconds, one core")
    grid[0][0].set_title("866 control points unstructured, 546 structured")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=2, bbox_to_anchor=(0.5, 0))
    style.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=tanktread.PROGRAM, type=pathlib.Path, help="default: %(default)s")
    parser.add_argument("--results", default="results/spheroid", metavar="DIR",
                        help="where runs are kept (default: %(default)s)")
    parser.add_argument("-o", "--output", default=".", type=pathlib.Path, metavar="DIR",
                        help="of the pictures (default: %(default)s)")
    parser.add_argument("--largest", type=int, default=3, choices=SIZES[1:],
                        help="largest mesh of the four (default: %(default)s)")
    parser.add_argument("--read-only", action="store_true", help="draw what is there, run nothing")
    parser.add_argument("--no-work", action="store_true", help="leave out error against work")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    study = Study(arguments.program, arguments.results, not arguments.read_only)
    found = converge(study, arguments.largest)
    table_of_options(found, arguments.largest)
    table_1(study)
    figure_8(found, arguments.output / "spheroid_figure_8.png")
    figure_9(found, arguments.output / "spheroid_figure_9.png")
    figure_10(study, found, arguments.output / "spheroid_figure_10.png")
    if not arguments.no_work:
        print()
        work(study, arguments.output / "spheroid_work.png")


if __name__ == "__main__":
    answer(main)
