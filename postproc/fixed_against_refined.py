#!/usr/bin/python3
"""A particle on a refined and on a fixed mesh: surfaces, sections, and the traction along the section (the paper's Figures 17 and 18)."""

import argparse

import numpy
from matplotlib.collections import LineCollection

import meshes
import read
import shape
import style
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("refined", help="directory of a run's results")
    parser.add_argument("fixed", nargs="+", help="of others, to be compared with it")
    parser.add_argument("-o", "--output", default="fixed_against_refined.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--field", default="traction", help="field along the section (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [read.run(directory) for directory in [arguments.refined, *arguments.fixed]]
    shots = [run.snapshot_at(None) for run in runs]
    extent = shots[0].points.max(0) - shots[0].points.min(0)
    tall = 4.2 * (extent[2] / extent[0] + 0.15)
    figure, axes = plt.subplots(2, max(2, len(runs)), figsize=(4.2 * max(2, len(runs)), tall + 3.6), height_ratios=[tall, 3], squeeze=False)
    norm, colours = shape.scale([shape.magnitude(shot.fields[arguments.field]) for shot in shots])
    for axis, run, shot in zip(axes[0], runs, shots):
        shape.draw_surface(axis, shot, arguments.field, norm, colours, -90, 20)
        axis.set_title(f"{run.name}: {run.series['n_control_points'][-1]:.0f} control points")
    figure.colorbar(plt.cm.ScalarMappable(norm, colours), cax=axes[0][0].inset_axes([0.3, -0.12, 0.5, 0.05]), orientation="horizontal",
                    label=arguments.field)
    for axis in axes[0][len(runs):]:
        axis.axis("off")

    outline, along = axes[1][0], axes[1][1]
    for axis in axes[1][2:]:
        axis.axis("off")
    curves = []
    for k, (run, shot, color) in enumerate(zip(runs, shots, style.RUNS)):
        middle = (shot.points.min(0) + shot.points.max(0)) / 2
        outline.add_collection(LineCollection(shape.section(shot, middle[1]) - middle[[0, 2]], colors=color, linewidths=1.6 if k == 0 else 1.1,
                                              linestyles="-" if k == 0 else (0, (4, 2))))
        outline.plot([], [], color=color, label=run.name)
        angle, values = profile(shot, arguments.field)
        curves.append((angle, values))
        along.plot(numpy.degrees(angle), values, color=color, linewidth=1.6 if k == 0 else 1.1, linestyle="-" if k == 0 else (0, (4, 2)))
    outline.set_aspect("equal")
    outline.autoscale_view()
    outline.set_xlabel("x₁")
    outline.set_ylabel("x₃")
    outline.legend(loc="upper center", bbox_to_anchor=(0.5, -0.6))
    along.set_xlabel("angle about the centre in the section x₂ = 0, degrees")
    along.set_ylabel(f"|{arguments.field}|")
    for run, (angle, values) in zip(runs[1:], curves[1:]):
        print(f"{run.name}: largest {arguments.field} {largest(values):.5g} against {largest(curves[0][1]):.5g}, "
              f"largest difference on the section {100 * difference(curves[0], (angle, values)):.2f} % of the largest")
    style.save(figure, arguments.output)


def profile(shot, field):
    """Magnitude of a field on the section, by angle."""
    angle, _, values = meshes.on_section(shot, field)
    return angle, numpy.linalg.norm(values, axis=1)


def largest(values):
    return numpy.max(values)


def difference(one, other):
    return numpy.max(abs(numpy.interp(one[0], *other, period=2 * numpy.pi) - one[1])) / largest(one[1])


if __name__ == "__main__":
    main()
