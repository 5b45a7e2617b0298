"""Computes a phase diagram of a particle: the border between two kinds of motion, as a function of a second key.

    tanktread-phases inputs/studies/red_cell_phases.yaml      # results/phases/borders.csv, runs.csv and phases.png
    tanktread-phases inputs/studies/red_cell_capillary.yaml --output results/capillary

For each value of the second key, bisection finds the value of the first key at which the motion changes.

A study is a YAML file with the keys

    deck         the deck
    motion       the motions that are distinguished, `shear` or `capillary`, see below
    set          settings of all runs
    along        the first key, {key, from, to, within}. within: factor to which a border is found, such as 1.05
    across       the second key, {key: its values}
    curves       {name: settings}. A setting may be a list with one value per value of `across`. `across` may have other
                 values in a curve
    begin        initial fraction of a run that is not analysed (default: 0.4)
    literature   {name: rows}, published borders. A row has the value across, the lowest and the highest value along

In `shear` the rotation of the shape is the change of `inclination`, and the rotation of the membrane relative to the
shape follows from `phase`. A run tumbles if its shape rotates by 90 degrees or more after `begin`. If its membrane also
rotates by 180 degrees or more, the motion is called `both`, and it counts as tumbling. A run treads (tank-treads) if
only its membrane rotates by 180 degrees or more. If neither happens, the search for this border ends with a message.

In a `capillary` the asymmetry of a cell is sqrt(d^2 + D^2 sin^2 2i). d is the distance of its centroid from the axis
divided by R_C (radius of the sphere with the particle's volume), D its Taylor parameter and i its inclination. The
asymmetry is 0 for shapes that are symmetric about the axis. After `begin` a run slips (the cell is a slipper) if the
asymmetry exceeds 0.1, or if its largest value in the last third of the time exceeds 0.005 and 1.5 times its largest
value in the first third. Otherwise the cell is a parachute.

The initial state is that of the deck. If both motions are stable, the border depends on the initial state.
"""

import collections
import functools

import numpy

from ..mistakes import Mistake, command_line, expect, log
from . import common, reading
from .reading import any_name, deck_key, number, read

NEAR = 1.5  # a border is first searched for between the previous border divided and multiplied by this factor
SWING = 0.5  # a shape that rotates by at least so many half turns tumbles; smaller rotations are oscillations
HALF = 180  # period of inclination and phase in degrees: the shape looks the same after half a turn
# Limits of the asymmetry sqrt(d^2 + D^2 sin^2 2i) (see above) in a capillary: above ASKEW the cell slips; an asymmetry
# below STRAIGHT may be a discretisation error.
ASKEW, STRAIGHT = 0.1, 0.005
GROWS = 1.5  # the asymmetry grows if it is more than this factor larger in the last third of the time than in the first

# A pair of motions. `below` (one or more names), `above`: names of the motions on the two sides of a border. `tell`:
# function that returns the name of the motion of a run, then two measures of it. `measures`: names of these measures.
Kind = collections.namedtuple("Kind", "below above tell measures")


def in_shear(series, begin):
    """Returns the motion after the fraction `begin` of the run: `tumbles`, `treads` (tank-treads), `both` or None
    (neither). Also returns the half turns of the shape, and of the membrane relative to the shape."""
    defined = ~numpy.isnan(series["inclination"])  # a shape with two equal semi-axes has no inclination
    time, phase, inclination = (series[name][defined] for name in ("time", "phase", "inclination"))
    late = time >= series["time"][0] + begin * numpy.ptp(series["time"])
    if not late.any():
        return None, numpy.nan, numpy.nan
    turned = -numpy.unwrap(inclination, period=HALF)  # rotation of the shape, positive in the same sense as the phase
    over, around = (numpy.ptp(angle[late]) / HALF for angle in (turned, phase - turned))
    once = around >= 1
    return (("both" if once else "tumbles") if over >= SWING else "treads" if once else None), over, around


def in_capillary(series, begin):
    """Returns the motion after the fraction `begin` of the run: `slips` or `parachute`. Also returns the largest
    asymmetry in the first and in the last third of this time."""
    time = series["time"]
    away = numpy.hypot(series["centroid_x2"], series["centroid_x3"]) / numpy.cbrt(3 * series["volume"] / (4 * numpy.pi))
    inclination = numpy.radians(numpy.nan_to_num(series["inclination"]))  # if it is NaN, D is 0
    askew = numpy.hypot(away, series["taylor_inertia"] * numpy.sin(2 * inclination))
    thirds = time[0] + (time[-1] - time[0]) * numpy.linspace(begin, 1, 301)
    first, middle, last = (values.max() for values in numpy.array_split(numpy.interp(thirds, time, askew), 3))
    slips = max(first, middle, last) > ASKEW or last > max(GROWS * first, STRAIGHT)
    return ("slips" if slips else "parachute"), first, last


MOTIONS = {"shear": Kind(("tumbles", "both"), "treads", in_shear,
                         ("half turns of the shape", "half turns of the membrane")),
           "capillary": Kind(("slips",), "parachute", in_capillary,
                             ("asymmetry in the first third", "asymmetry in the last third"))}


def _in_curve(given, name):
    """Returns the values of a key in a curve: a list from a list or a range, otherwise a single value."""
    return reading.values(given, name) if isinstance(given, (list, dict)) else reading.setting(given, name)


KINDS = {"motion": reading.word(*MOTIONS), "set": reading.SETTINGS,
         "along": {"key": reading.text, "from": number, "to": number, "within": number},
         "across": {deck_key: reading.values},
         "curves": {any_name: {deck_key: _in_curve}}, "begin": number, "literature": {any_name: [[number]]}}


class Diagram:
    """Phase diagram of a study file. `borders`: {curve: rows}. A row contains the value of the key across, the values
    of the key along that are just below and just above the border, and how the search ended."""

    def __init__(self, path, runs):
        given = reading.study_of(path, KINDS)
        self.runs, self.decks, self.fixed = runs, given["deck"], given["set"]
        self.kind = MOTIONS[given.get("motion", "shear")]
        # texts for a search that finds no border in its range
        self.to_here, self.from_here = f"{self.kind.below[0]} to here", f"{self.kind.above} from here"
        self.along, across, curves = given["along"], given["across"], given["curves"]
        expect(set(self.along) == {"key", "from", "to", "within"}, f"{path}: along has key, from, to and within")
        low, high, within = self.range = [self.along[name] for name in ("from", "to", "within")]
        expect(0 < low < high and within > 1, f"{path}: along needs positive values that ascend and a factor above 1, "
                                              f"but is from {low} to {high} within {within}")
        expect(len(across) == 1 and curves, f"{path}: across has one key, and curves one or more")
        self.across, self.begin = next(iter(across)), given.get("begin", 0.4)
        expect(0 <= self.begin < 1, f"{path}: begin is a share of a run, from 0 to less than 1, but is {self.begin:g}")
        self.literature = given["literature"]
        for name, rows in self.literature.items():
            expect(all(len(row) == 3 for row in rows),
                   f"{path}: {name}: literature has rows of a value across, the lowest and the highest one along")
        self.rows = {name: self.settings(name, across | keys) for name, keys in curves.items()}
        self.borders, self.made = {name: [] for name in curves}, {}  # runs by (curve, value across, value along)

    def settings(self, name, keys):
        """Returns the settings of a curve: one dict for each of its values of the key across."""
        at = read(keys[self.across] if isinstance(keys[self.across], list) else [keys[self.across]], [number],
                  f"{name}: {self.across}")
        lists = {key: given for key, given in keys.items() if isinstance(given, list)} | {self.across: at}
        for key, one in lists.items():
            expect(len(one) == len(at), f"{name}: {key} has {len(one)} values where {self.across} has {len(at)}")
        return [keys | dict(zip(lists, row)) for row in zip(*lists.values())]

    def holds(self, name, row, value):
        """Returns True if the run with this value of the key along has the motion below the border. Makes the run if it
        is not in `made`, and stores its motion, measures, time and directory there."""
        key = name, row[self.across], value
        if key not in self.made:
            outcome = self.runs.run(self.decks, self.fixed | row | {self.along["key"]: value})
            said, *measures = (self.kind.tell(outcome.series, self.begin) if outcome.done else
                               ("not run to its end: " + outcome.message, numpy.nan, numpy.nan))
            self.made[key] = said or "neither", *measures, outcome.processor_seconds, outcome.directory.name
            told = ", ".join(f"{label} {measure:.3g}" for label, measure in zip(self.kind.measures, measures))
            log.info(f"{name}, {self.across} {row[self.across]:g}, {self.along['key']} {value:.4g}: "
                     f"{said or 'neither'} ({told}; {outcome.processor_seconds:.0f} processor seconds)")
        motion = self.made[key][0]
        expect(motion != "neither",
               f"it neither {self.kind.below[0]} nor {self.kind.above}: it needs a later Time/final time")
        expect(motion in (*self.kind.below, self.kind.above), motion)
        return motion != self.kind.above

    def border(self, name, row, last):
        """Returns the values of the key along just below and just above the border, and how the search ended (see
        common.edge). `last`: border found for the previous row, near which the search starts; or None."""
        low, high, factor = self.range
        holds = functools.partial(self.holds, name, row)
        if last:
            near, far = max(low, last / NEAR), min(high, last * NEAR)
            low, high = (low, near) if not holds(near) else (far, high) if holds(far) else (near, far)
        return common.edge(holds, low, high, factor)

    def find(self):
        last = None
        for name, row in ((name, row) for name, rows in self.rows.items() for row in rows):
            at = row[self.across]
            try:
                low, high, how = self.border(name, row, last)
            except Mistake as mistake:
                low, high, how = numpy.nan, numpy.nan, str(mistake)
            last = low if how == "edge" else last
            end = {"fails from here": self.from_here, "holds to here": self.to_here}.get(how, how)
            self.borders[name].append((at, low, high, end))

    def write(self, directory):
        borders = [(name, *row) for name, rows in self.borders.items() for row in rows]
        common.write_table(directory / "borders.csv", [
            "curve", self.across, f"{self.kind.below[0]} at", f"{self.kind.above} at", "how"], borders)
        common.write_table(directory / "runs.csv", [
            "curve", self.across, self.along["key"], "motion", *self.kind.measures, "processor seconds", "directory"],
            [(*key, *run) for key, run in self.made.items()])

    found = property(lambda self: any(numpy.isfinite(row[1:3]).any() for rows in self.borders.values() for row in rows),
                     doc="Whether there is anything to draw.")

    def draw(self, axes=None):
        """Returns a figure of the borders between the motions, with the borders published in the literature."""
        from matplotlib.ticker import LogLocator, NullLocator

        from ..figures import style

        def bars(at, low, high, **look):
            middle = numpy.sqrt(low * high)
            axes.errorbar(at, middle, [middle - low, high - middle], capsize=2, **look)

        figure, (axes,) = style.panels(axes, 1, 1, 6.2, 4.2)
        for (name, rows), color in zip(self.borders.items(), style.RUNS * len(self.borders)):
            edges = numpy.array(sorted(row[:3] for row in rows if row[3] == "edge")).reshape(-1, 3)
            if len(edges):
                bars(*edges.T, fmt="o-", color=color, markersize=3.5, label=name)
            for how, at, mark in (self.from_here, 2, "v"), (self.to_here, 1, "^"):
                there = numpy.reshape([(row[0], row[at]) for row in rows if row[3] == how], (-1, 2))
                label = None if len(edges) or not len(there) else name + (", below" if mark == "v" else ", above")
                axes.plot(*there.T, mark, color=color, markersize=6, label=label)
        for (name, rows), mark in zip(self.literature.items(), style.MARKS[1:] * len(self.literature)):
            bars(*numpy.reshape(rows, (-1, 3)).T, fmt=mark, color=style.FAINT, markersize=4, linewidth=0.8, label=name)
        axes.set(xscale="log", yscale="log", xlabel=self.across, ylabel=self.along["key"])
        for axis, words in (axes.xaxis, {"xscale": "linear"}), (axes.yaxis, {}):
            # the axis spans less than a factor of ten, or contains 0: the logarithmic locator would set too few ticks
            if axis.get_data_interval()[0] <= 0 or numpy.divide(*axis.get_view_interval()[::-1]) < 10:
                axes.set(**words)
                axis.set_major_locator(axis.get_major_locator() if words else LogLocator(subs=(1, 1.5, 2, 3, 4, 6)))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_locator(NullLocator())
        axes.text(0.02, 1.01, f"above: {self.kind.above}; below: {self.kind.below[0]}", transform=axes.transAxes,
                  color=style.FAINT)
        axes.legend(loc="upper left", bbox_to_anchor=(-0.1, -0.14))
        return figure


def main():
    parser = command_line(__doc__)
    parser.add_argument("study", help="YAML file of the study")
    common.arguments(parser, "results/phases", limit=None)
    parsed = parser.parse_args()
    diagram = Diagram(parsed.study, common.study(parsed))
    try:
        diagram.find()
    finally:  # if the search is interrupted, write what has been found
        diagram.write(parsed.output)
        if diagram.found:
            from ..figures import style

            style.save(style.draw(diagram.draw), parsed.output / "phases.png")
    expect(diagram.found,
           f"no border was found, and nothing is drawn: {parsed.output / 'borders.csv'} says how each search ended")
