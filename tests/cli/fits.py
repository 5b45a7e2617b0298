#!/usr/bin/python3
# Tests of fits: they return the parameters that produced the data, report undetermined unknowns, and reject wrong
# studies in one sentence. Tests of outlines.
import copy
import os
import pathlib
import re
import sys
import types
from unittest import mock

import numpy
import yaml

from matplotlib import path
from scipy import spatial
from harness import PROGRAM, SOURCE, check, close, deck, main, package

os.environ["TANKTREAD"] = str(PROGRAM)
sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import lagrange
from tanktread.mistakes import Mistake
from tanktread.studies import fit, fit_data, fit_report, phases, silhouette, sweep

SHEAR = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3 }
  Time: { final time: 1.0, tolerance: 1.0e-6 }
  Output: { interval: 0.5 }
"""
STILL = """
Tanktread:
  Flow: { type: quiescent }
  Particle: { shape: sphere, radius: 1.0, initial shape: { stretch: [1.2, 1.0, 0.9], volume: own } }
  Membrane: { law: neo-Hookean, shear modulus: 1.0 }
  Surface: { elements per side: 5 }
  Time: { final time: 1.0e-6 }
"""


def _fit(text, code=0):
    pathlib.Path("experiment.yaml").write_text(text if isinstance(text, str) else yaml.safe_dump(text, sort_keys=False))
    result = package("fit", "experiment.yaml", "--jobs", "1")
    check(result.returncode == code and "Traceback" not in result.stderr, result.stdout, result.stderr)
    return result.stdout if code == 0 else "".join(line for line in result.stderr.splitlines(True) if not re.search(r"\d+ runs", line))  # progress


def _found(law="the deck's law"):
    return {name: (one["value"], one["error"]) for name, one in yaml.safe_load(open("results/experiment/fit.yaml"))[law]["unknown"].items()}


def _ellipse(a, b, n=60):
    angle = 2 * numpy.pi * numpy.arange(n) / n
    return numpy.column_stack([a * numpy.cos(angle), b * numpy.sin(angle)])


def a_value_has_the_digits_of_its_error():
    for given, text in (((3.298808, 0.0003), "3.29881 ± 0.00030"), ((34.6, 0.0149), "34.600 ± 0.015"), ((123456.0, 12.3), "123456 ± 12"), ((0.5, 12.0), "0.5 ± 12"),
                        ((0.0, 0.01), "0.0 ± 0.010")):
        check(fit_report.stated(*given) == text, fit_report.stated(*given), "instead of", text)


def an_error_of_the_runs_is_smooth_along_a_curve_and_does_not_average_out():
    """A curve of 2000 points. Its noise is a fifth of the discretisation error of the runs, which is smooth in time.
    Each residual still has unit variance."""
    times, noise = numpy.linspace(0.0, 3.0, 2000), numpy.random.default_rng(1).normal(size=2000)
    numpy.savetxt("curve.csv", numpy.column_stack([times, 1e-3 * noise]), delimiter=",")
    datum = fit_data.SeriesData({"series": "y", "curve": "curve.csv", "error": 1e-3}, "data", pathlib.Path())
    datum.discretisation = 5e-3
    for wave in 0.0, 1.0, 2.0, 3.0:  # up to one and a half periods
        square = (datum.residuals((times, 5e-3 * numpy.cos(wave * times)), [])**2).sum()
        check(abs(square - 2000) < 5 * numpy.sqrt(2 * 2000), f"wave number {wave}: chi square {square}")


def a_fit_to_curves_recovers_two_unknowns_and_the_law():
    deck(SHEAR)
    truth = tanktread.run(pathlib.Path("deck.yaml").resolve(), {"Membrane/capillary number": 0.2, "Particle/viscosity ratio": 2.0})
    for name in "taylor_inertia", "inclination":
        rows = numpy.column_stack([truth.series["time"], truth.series[name]])[3:]
        numpy.savetxt(f"{name}.csv", rows, delimiter=",", header="time,value", comments="")
    data = [{"series": "taylor_inertia", "curve": "taylor_inertia.csv", "error": 1e-3}, {"series": "inclination", "curve": "inclination.csv", "error": 0.1}]
    said = _fit({"deck": "deck.yaml", "unknown": {"Membrane/capillary number": {"start": 0.6}, "Particle/viscosity ratio": {"start": 0.5}},
                 "laws": {"neo-Hookean": {"Membrane/law": "neo-Hookean"}, "stiff": {"Membrane/law": "Skalak", "Membrane/area dilatation": 50.0}},
                 "experiments": {"shear": {"data": data}}, "next": {"Flow/shear rate": [1.0, 2.0]}})
    found = _found("neo-Hookean")
    close(found["Membrane/capillary number"][0], 0.2, 2e-5, "Ca")
    close(found["Particle/viscosity ratio"][0], 2.0, 2e-3, "viscosity ratio")
    check(0 < found["Membrane/capillary number"][1] < 0.05, found)
    check("laws, best first: neo-Hookean" in said and "tell neo-Hookean from the others" in said, said)
    check(said.count("a further experiment, Flow/shear rate") == 2 and "correlation of" in said, said)


def a_fit_to_a_relaxation_recovers_the_viscosity_of_a_membrane():
    """The data are the ratio of length to width of an ellipsoid that relaxes, with an unknown origin of time. Each law
    has its own unknown and start value."""
    deck("""
Tanktread:
  Units: { length: 1 um, time: 1 s, force: 1 nN }
  Flow: { type: quiescent }
  Particle: { shape: sphere, viscosity ratio: 2.0, initial shape: { stretch: [1.5, 1.0, 0.75] } }
  Membrane: { law: neo-Hookean, shear modulus: 1.0, shear viscosity: 0.5 }
  Surface: { elements per side: 3 }
  Time: { final time: 6.0, tolerance: 1.0e-5 }
""")
    truth = tanktread.run(pathlib.Path("deck.yaml").resolve(), {"Membrane/shear viscosity": 0.4, "Time/maximum step": 0.05}).series
    times = numpy.linspace(0.5, 4.5, 12)
    ratio = numpy.interp(times, truth["time"], truth["length_x1"] / truth["length_x3"])
    numpy.savetxt("curve.csv", numpy.column_stack([times - 0.5, ratio]), delimiter=",")
    datum = {"series": "length_x1", "over": "length_x3", "curve": "curve.csv", "error": 1e-3, "origin": "free"}
    laws = {"neo-Hookean": {"unknown": {"Membrane/shear viscosity": {"start": 1.5}}}, "without": {"unknown": {"Particle/viscosity ratio": 4.0},
                                                                                                "Membrane/shear viscosity": 0.0}}
    said = _fit({"deck": "deck.yaml", "laws": laws, "experiments": {"let go": {"data": [datum]}}})
    value, error = _found("neo-Hookean")["Membrane/shear viscosity"]
    close(value, 0.4, 1e-3, "surface viscosity")  # tolerance: the data are interpolated linearly between steps of at most 0.05
    check(0 < error < 0.02 and " nN s/µm (" in said, said)
    check("Particle/viscosity ratio" in _found("without"), said)


def undetermined_unknowns_are_reported():
    deck(STILL)
    numpy.savetxt("circle.csv", _ellipse(1.2, 0.9), delimiter=",")
    one = {"deck": "deck.yaml", "unknown": {"Particle/radius": 1.3, "Membrane/shear modulus": 1.0},
           "experiments": {"still": {"data": [{"outline": "circle.csv", "scale": 1.0, "error": 0.01}]}}}
    said = _fit(one)
    check("Membrane/shear modulus: not determined" in said, said)
    found = _found()
    close(found["Particle/radius"][0], 1.0, 1e-3, "radius")
    one["experiments"]["still"]["data"][0]["scale error"] = "free"
    del one["unknown"]["Membrane/shear modulus"]
    check("Particle/radius: not determined" in _fit(one), "a size from a picture without a scale")
    one["experiments"]["still"]["data"][0]["scale error"] = 0.02
    _fit(one)
    close(_found()["Particle/radius"][1], 0.02, 4e-4, "error of the radius, which is that of the scale")


def a_known_value_contributes_to_the_fit():
    deck(STILL)
    numpy.savetxt("circle.csv", _ellipse(1.2, 0.9), delimiter=",")
    said = _fit({"deck": "deck.yaml", "unknown": {"Particle/radius": {"start": 1.1, "known": 1.2, "error": 1e-4}},
                 "experiments": {"still": {"data": [{"outline": "circle.csv", "scale": 1.0, "error": 0.05}]}}})
    close(_found()["Particle/radius"][0], 1.2, 1e-3, said)


def an_unknown_at_a_bound_is_reported():
    deck(STILL.replace("per side: 5", "per side: 3"))
    data = [{"series": "length_x1", "value": 2.4, "error": 0.03}, {"series": "length_x3", "value": 1.8, "error": 0.03}]  # radius 1, error 0.01
    for given, bound in (({"start": 1.1, "from": 1.05}, "from"), ({"start": 0.9, "to": 0.97}, "to"), ({"start": 1.1, "from": 0.98, "to": 1.2}, None)):
        said = _fit({"deck": "deck.yaml", "unknown": {"Particle/radius": given}, "experiments": {"still": {"data": data}}})
        one = yaml.safe_load(open("results/experiment/fit.yaml"))["the deck's law"]["unknown"]["Particle/radius"]
        close(one["value"], given[bound] if bound else 1.0, 1e-3, "radius")
        check(one.get("at bound") == bound and ("lies at its bound" in said) == bool(bound), said)
        check(bound is None or f"Particle/radius lies at its bound `{bound}`: a {'smaller' if bound == 'from' else 'larger'} value" in said, said)


def the_outline_of_a_shape_is_exact():
    deck(STILL.replace("initial shape:", "orientation: [0.0, 30.0, 0.0], initial shape:"))
    shot = tanktread.run("deck.yaml").snapshots()[0]
    turn = numpy.radians(30)
    turned = _ellipse(1.2, 0.9) @ [[numpy.cos(turn), -numpy.sin(turn)], [numpy.sin(turn), numpy.cos(turn)]]
    curve = silhouette.seen(shot)
    # tolerance: discretisation error of the coarse mesh
    check(abs(curve.distances(turned)).max() < 2e-4, abs(curve.distances(turned)).max())
    close(abs(curve.distances(1.01 * turned)).max(), 0.012, 3e-4, "a distance outside")
    check(curve.distances(0.9 * turned).max() < 0, "a point inside is outside")


def _shapes():
    """Returns {name: (map of points of the unit sphere (..., 3), axis of view)} of shapes with hidden hollows, corners and bends."""
    def parachute(x):
        return numpy.stack([0.25 * x[..., 0] - 0.9 * (x[..., 1]**2 + x[..., 2]**2), x[..., 1], x[..., 2]], -1)

    def hollow(x):
        depth = numpy.where(x[..., 0] < 0, numpy.exp(-(x[..., 1]**2 + x[..., 2]**2) / 0.3), 0)
        return numpy.stack([x[..., 0] * (1 - depth), x[..., 1], x[..., 2]], -1)

    def red_cell(x):
        square = x[..., 0]**2 + x[..., 1]**2
        return numpy.stack([x[..., 0], x[..., 1], x[..., 2] * (0.10 + 1.0 * square - 0.56 * square**2)], -1)

    def s_shaped(x):
        return numpy.stack([3 * x[..., 0], 0.45 * x[..., 1], 0.45 * x[..., 2] + 1.2 * numpy.sin(4.2 * x[..., 0])], -1)

    return {"hollow": (hollow, 1), "parachute": (parachute, 1), "red cell along its rim": (red_cell, 0), "S": (s_shaped, 1), "S from above": (s_shaped, 2)}


def _bent(angle):
    """Returns the map of the unit sphere to a rod of radius 0.2, bent around x2 by an angle, with a rise of its axis that separates its ends."""
    def bent(x):
        turn, radius = x[..., 0] * angle / 2, 1 + 0.2 * x[..., 2]
        return numpy.stack([radius * numpy.sin(turn), 0.2 * x[..., 1] + 0.15 * turn, radius * numpy.cos(turn)], -1)
    return bent


def _sphere(n=4, p=4):
    """Returns the nodes (cells, (p + 1)^2, 3) of a unit sphere, projected from a cube with n cells per side."""
    i, j = numpy.array(lagrange.node_order(p)).T / p
    u, v = (numpy.tan(numpy.pi / 4 * (2 * (numpy.arange(n)[:, None] + one) / n - 1)) for one in (i, j))
    side = numpy.stack(numpy.broadcast_arrays(1.0, u[:, None], v[None]), -1).reshape(-1, len(i), 3)
    sides = [numpy.roll(sign * side * [1, 1, sign], k, axis=-1) for k in range(3) for sign in (1, -1)]
    return (lambda x: x / numpy.linalg.norm(x, axis=-1, keepdims=True))(numpy.concatenate(sides))


def the_outline_is_the_outer_envelope_of_the_projected_points():
    """Tolerance: 1e-3 of the size, the resolution of a picture of 1000 pixels."""
    shot = _sphere()
    for name, (shape, axis) in _shapes().items():
        for tilted in False, True:
            turn = numpy.linalg.qr(numpy.array([[1.0, 0.3, -0.2], [0.1, 1.0, 0.4], [-0.3, 0.2, 1.0]]))[0] if tilted else numpy.eye(3)
            found = tanktread.snapshots.Snapshot.of(shape(shot) @ turn)
            points = numpy.delete(found.sampled(found.points, 60).reshape(-1, 3), axis, 1)
            curve, size = silhouette.seen(found, axis), numpy.ptp(points, axis=0).max()
            off = points[~path.Path(curve.points).contains_points(points)]
            check(len(off) == 0 or curve.distances(off).max() < 1e-3 * size, f"{name}: points outside")
            near = spatial.cKDTree(points).query(curve.even(500))[0].max()  # 0.01: distance between points where the samples are coarse
            check(near < 1e-2 * size, f"{name}: {near / size:.1e} of the size from the points")
    check(silhouette.seen(tanktread.snapshots.Snapshot.of(_bent(4.0)(shot))).length > 7, "a rod whose ends do not meet")
    ball = tanktread.snapshots.Snapshot.of(numpy.concatenate([shot, shot + [1.5, 0.0, 0.0]]))
    two = silhouette.seen(ball)  # circles whose centres are 1.5 apart: the lens that they share has the area 0.4533
    close(two.area, 2 * numpy.pi - (2 * numpy.arccos(0.75) - 0.75 * numpy.sqrt(4 - 1.5**2)), 1e-4, "two balls that overlap in the picture")
    close(two.length, 4 * (numpy.pi - numpy.arccos(0.75)), 1e-3, "their perimeter, with two corners")
    for cells, why in ((_bent(7.0)(shot), "through a gap"), (numpy.concatenate([shot, shot + [2.01, 0.0, 0.0]]), "side by side")):
        try:
            silhouette.seen(tanktread.snapshots.Snapshot.of(cells))
            check(False, f"not refused: {why}")
        except ValueError as error:
            check(why in str(error), error)


def a_fit_to_an_outline_with_a_hollow_rear_recovers_the_modulus():
    """The rear is hollow by about 9 % of the width, hidden behind its rim."""
    deck("""
Tanktread:
  Units: {}
  Flow: { type: duct, mean velocity: 0.1 m/s, viscosity: 15 mPa s }
  Tube: { section: rectangle, sides: [20 um, 20 um], azimuthal elements: 8, axial elements: 8 }
  Particle: { shape: sphere, radius: 6 um }
  Membrane: { law: neo-Hookean, shear modulus: 1e4, bending number: 0.005 }
  Surface: { elements per side: 4 }
  Time: { final time: 0.2 ms }
  Output: { interval: 0.2 ms }
""")
    curve = silhouette.seen(tanktread.run(pathlib.Path("deck.yaml").resolve()).snapshots()[-1])
    noise = 0.03 * numpy.random.default_rng(4).standard_normal((100, 2))
    numpy.savetxt("outline.csv", curve.even(100) + noise, delimiter=",", header="x1,x3", comments="")
    said = _fit({"deck": "deck.yaml", "unknown": {"Membrane/shear modulus": 1.5e4},
                 "experiments": {"rear": {"data": [{"outline": "outline.csv", "scale": 1.0, "error": 0.03}]}}})
    value, error = _found()["Membrane/shear modulus"]
    check(abs(value - 1e4) < 3 * error < 600, said)


def _offline(text, model):
    """Fits without the program. model(settings) returns {series: last value}, or the message of a failed run. Returns the fit, the text of the report, and
    the settings of all runs."""
    made = []

    def outcomes(jobs):
        for number, (_, settings) in enumerate(jobs, len(made)):
            made.append(settings)
            found = model(settings)
            series = {"time": numpy.array([0.0, 1.0]), **{name: numpy.array([0.0, value]) for name, value in found.items()}} if isinstance(found, dict) else {}
            yield types.SimpleNamespace(done=bool(series), refused=False, message=found, directory=pathlib.Path(f"run_{number}"), run=types.SimpleNamespace(
                series=series, errors={}, untrusted={}, band=lambda name: None, in_units=lambda dimension: ""))

    deck("Tanktread: {}")
    pathlib.Path("experiment.yaml").write_text(yaml.safe_dump(text, sort_keys=False))
    study = types.SimpleNamespace(all=lambda jobs: list(outcomes(jobs)), dimension=lambda key: "", limit=None)
    with mock.patch.object(fit, "Study", lambda **given: study):
        pathlib.Path("made").mkdir(exist_ok=True)
        fits = fit.run("experiment.yaml", "made")
    return fits, pathlib.Path("made/fit.txt").read_text(), made


def _hyperbola(settings):
    """not a test"""
    return {"D": settings["F/rate"] / (settings["F/rate"] + settings["M/G"])}


def _curve(path, law, noise, offset=0.0):
    """Writes a table of D against the rate, with two rows per rate, in the format of a German spreadsheet."""
    generator, rates = numpy.random.default_rng(3), numpy.repeat([40.0, 1.0, 2.0, 5.0, 10.0, 20.0], 2)
    rows = (f"{rate};{law(rate) + offset + noise * generator.standard_normal():.6f};{max(noise, 0.005)}" for rate in rates)
    pathlib.Path(path).write_text("\ufeffrate;D;error\r\n" + "".join(row.replace(".", ",") + "\r\n" for row in rows), encoding="utf-8")


RATES = {"deck": "deck.yaml", "unknown": {"M/G": 30.0}, "experiments": {"e": {"data": [{"series": "D", "curve": "curve.csv", "against": "F/rate"}]}}}


def a_curve_against_a_key_has_a_run_for_each_value_of_the_key():
    _curve("curve.csv", lambda rate: rate / (rate + 8), 0.005)
    (found,), said, made = _offline(RATES | {"next": {"F/rate": [8.0, 800.0]}}, _hyperbola)
    value, error = found.values["M/G"]
    check(abs(value - 8) < 2 * error < 0.2, value, error)
    check(len({(one["F/rate"], one["M/G"]) for one in made}) == len(made) and {one["F/rate"] for one in made} == {1, 2, 5, 10, 20, 40, 8, 800}, "a run is repeated")
    rises = [float(one) for one in re.findall(r"further experiment, F/rate [\d.]+: ± ([\d.]+)", said)]
    check(len(rises) == 2 and rises[0] < error and rises[0] < rises[1], "a rate near the modulus tells more about it", said)
    # factors: the same curve as a function of other keys
    one = {"series": "D", "curve": "curve.csv", "against": {"F/rate": 0.5, "F/vector": [1, 0, -2]}}
    (other,), _, made = _offline(RATES | {"experiments": {"e": {"data": [one]}}}, lambda settings: _hyperbola(settings | {"F/rate": settings["F/vector"][2] / -2}))
    close(other.values["M/G"][0], value, 1e-3 * error, "with factors")  # equal residuals and derivatives
    check(all(one["F/vector"] == [2 * one["F/rate"], 0, -4 * one["F/rate"]] for one in made), made[0])


def a_force_extension_curve_with_units_recovers_the_modulus():
    """The table is in nN and nm, the deck in pN and um. Two beads pull a capsule with a shear modulus of 6 uN/m."""
    deck("""
Tanktread:
  Units: {}
  Flow: {type: quiescent, viscosity: 1 mPa s}
  Particle: {shape: sphere, radius: 3 um}
  Membrane:
    law: Skalak
    shear modulus: 6 uN/m
    forces: {left: {direction: [-1, 0, 0], radius: 1.5 um, force: [0, 0, 0]}, right: {direction: [1, 0, 0], radius: 1.5 um, force: [0, 0, 0]}}
  Surface: {elements per side: 3}
  Steady: {tolerance: 1.0e-6}
""")
    forces, sides = (2.0, 5.0, 9.0), {"Membrane/forces/left/force": [-1, 0, 0], "Membrane/forces/right/force": [1, 0, 0]}
    found = tanktread.Study(directory="truth").all([(["deck.yaml"], {key: [one * force for one in side] for key, side in sides.items()}) for force in forces])
    lengths = [one.series["length_x1"][-1] for one in found] + 0.01 * numpy.random.default_rng(2).standard_normal(3)
    rows = "".join(f"{force / 1000};{1000 * length:.1f};10\n" for force, length in zip(forces, lengths)).replace(".", ",")
    pathlib.Path("forces.csv").write_text("force [nN];extension [nm];error\n" + rows)
    text = {"deck": "deck.yaml", "unknown": {"Membrane/shear modulus": 9.0}, "experiments": {"pulled": {"data": [{"series": "length_x1", "curve": "forces.csv", "against": sides}]}}}
    said = _fit(text)
    value, error = _found()["Membrane/shear modulus"]
    check(abs(value - 6) < 2 * error < 0.5, value, error)
    check(yaml.safe_load(open("results/experiment/fit.yaml"))["the deck's law"]["runs"] % 3 == 0 and " pN/µm (" in said, said)  # a run for each force
    pathlib.Path("forces.csv").write_text("force [nN];extension [s];error\n" + rows)
    check("the table is in s, which does not fit the unit of length_x1, 1e-06 m" in _fit(text, code=2), "a unit of another dimension")
    pathlib.Path("forces.csv").write_text("force [nm];extension [nm];error\n" + rows)
    check("pulled: the deck is refused: " in _fit(text, code=2), "a key with a unit of another dimension")


def residuals_of_one_sign_are_reported():
    """The offset of the data is six standard errors, and the bound keeps the model below them."""
    _curve("curve.csv", lambda rate: rate / (rate + 8), 0.002, 0.03)
    _, said, _ = _offline(RATES | {"unknown": {"M/G": {"start": 9.0, "from": 8.0}}}, _hyperbola)
    check("12 of 12 positive in e: data (binomial test, probability 0.00049): the model is below the data" in said, said)  # 2 / 2**12
    # ten single values of a series beside a curve that is met
    single = {f"rate {rate}": {"set": {"F/rate": rate}, "data": [{"series": "E", "value": rate / (rate + 8.0) + 0.03, "error": 0.005}]} for rate in range(1, 11)}
    _curve("curve.csv", lambda rate: rate / (rate + 8), 0.005)
    _, said, _ = _offline(RATES | {"unknown": {"M/G": {"start": 9.0, "from": 8.0}}, "experiments": RATES["experiments"] | single},
                          lambda settings: _hyperbola(settings) | {"E": settings["F/rate"] / (settings["F/rate"] + 8)})
    check("10 of 10 positive in E (binomial test, probability 0.0059): the model is below the data" in said, said)  # 3 tests: 3 x 2 / 2**10
    _curve("curve.csv", lambda rate: rate / (rate + 8), 0.005)
    _, said, _ = _offline(RATES, _hyperbola)
    check(re.search(r"positive in e: data .*as by chance", said), said)


def a_fit_that_ends_where_runs_fail_reports_no_value():
    _curve("curve.csv", lambda rate: rate / (rate + 8), 0.005)
    experiments = RATES["experiments"] | {"fine": {"set": {"F/rate": 3.0}, "data": [{"series": "D", "value": 3 / 11, "error": 0.005}]}}

    def model(settings):
        fails = settings["M/G"] < 10 and settings["F/rate"] > 15 and "A/b" not in settings
        return "the shape is hollow as it is seen" if fails else _hyperbola(settings)

    (fitted, edge), said, made = _offline(RATES | {"experiments": experiments, "laws": {"one": {}, "two": {"A/b": 1}}, "next": {"F/rate": [8.0]}}, model)
    close(fitted.values["M/G"][0], 8, 0.2, "a law of which no run fails")
    check(edge.law == "one" and numpy.isnan(edge.values["M/G"][0]) and numpy.isinf(edge.values["M/G"][1]), edge.values)
    record = yaml.safe_load(pathlib.Path("made/fit.yaml").read_text())["one"]
    check(list(record["failed runs"]) == ["e"] and set(record["failed runs"]["e"].values()) == {"the shape is hollow as it is seen"}, record)
    check(10 <= record["unknown"]["M/G"]["edge"] < 10.3 and numpy.isnan(record["unknown"]["M/G"]["value"]), record)
    check("no value, because the fit ended at an edge beyond which runs of e fail" in said and "not compared, because they ended at an edge: one" in said, said)
    check("runs of e failed or gave no outline or no value; the first one, run_" in said and "(AIC" not in said, said)


PARTS = {
    fit.load: {"deck": ["deck.yaml"], "set": {"A/b": [1, 2.0]}, "unknown": {"M/g": {"start": 1, "from": 0.1}, "M/k": {"known": 1, "error": 0.1, "spacing": "linear"}},
               "laws": {"a": {"M/law": "x", "unknown": {"Q/r": 1}}}, "limit": 10, "next": {"F/s": ["2 1/s"]},
               "experiments": {"e": {"set": {"F/z": "1 1/s"}, "unknown": {"W/w": 1}, "data": [
                   {"series": "y", "curve": "curve.csv", "against": {"F/r": 2, "F/v": [1, -1]}, "at": 3, "columns": ["rate", 2, 3]},
                   {"outline": "circle.csv", "scale": 1, "error": 0.1, "plane": ["x1", "x3"], "at": 1, "scale error": "free", "open": True},
                   {"series": "q", "over": "b", "curve": "curve.csv", "origin": "free"}]}}},
    sweep.Sweep: {"deck": "deck.yaml", "set": {"A/b": 1}, "grid": {"C/a": {"from": 1, "to": 2, "number": 3, "spacing": "logarithmic"}, "C/b": [1, 2]},
                  "together": {"D/a": [1, 2]}, "random": {"number": 2, "seed": 3, "keys": {"R/a": [1, 2], "R/b": {"from": 1, "to": 2}}},
                  "record": {"D": "taylor", "E": {"series": "x", "take": "all"}, "F": {"series": "q", "at": 3}}, "limit": 3, "ranks": 1},
    phases.Diagram: {"deck": "deck.yaml", "motion": "shear", "set": {"A/b": 1}, "along": {"key": "A/k", "from": 1, "to": 2, "within": 1.1}, "across": {"P/q": [1, 2]},
                     "curves": {"one": {}, "two": {"A/z": [1, 2], "A/y": "u"}}, "begin": 0.3, "literature": {"p": [[1, 2, 3]]}}}
WRONG = [None, True, -3, 10**400, float("nan"), "a\0b", [], [[1]], {"a": 1}, {"from": 1, "to": 2, "number": 10**9}]


def _parts(node, at=()):
    yield at
    for key, one in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ():
        yield from _parts(one, (*at, key))


def every_part_of_a_study_file_is_checked():
    """Each part of each kind of file is replaced by values of another type: the file is read or refused in one sentence."""
    deck("Tanktread: {}")
    _curve("curve.csv", lambda rate: rate, 0.005)
    numpy.savetxt("circle.csv", _ellipse(1, 1), delimiter=",", header="x1,x3", comments="")
    for read, whole in PARTS.items():
        refused = []
        for at in _parts(whole):
            for wrong in WRONG:
                text, part = copy.deepcopy({"study": whole}), ("study", *at)
                node = text
                for key in part[:-1]:
                    node = node[key]
                node[part[-1]] = wrong
                pathlib.Path("study.yaml").write_text(yaml.dump(text["study"], Dumper=getattr(yaml, "CSafeDumper", yaml.SafeDumper)))
                try:
                    read("study.yaml", types.SimpleNamespace())
                except Mistake as mistake:
                    check(len(str(mistake)) < 900, "too long:", mistake)
                    refused.append(at)
        check(set(refused) == set(_parts(whole)), read, "accepts anything as", set(_parts(whole)) - set(refused))


def names_are_texts_and_occur_once():
    deck("Tanktread: {}")
    value = "{data: [{series: a, value: 1, error: 1}]}"
    pathlib.Path("study.yaml").write_text(f"deck: deck.yaml\nunknown: {{A/b: 1}}\nexperiments: {{1: {value}, no: {value}, 2024-01-01: {value}}}\n")
    (found,), _ = fit.load("study.yaml", types.SimpleNamespace())
    check([one.name for one in found.experiments] == ["1", "no", "2024-01-01"], "names as they are written")
    for text, words in ((f"unknown: {{A/b: 1}}\nexperiments:\n  e: {value}\n  e: {value}", "line 5: the key e is already in line 4"),
                        (f"unknown: {{A/b: 1, A/b: 2}}\nexperiments: {{e: {value}}}", "line 2: the key A/b is already in line 2"),
                        (f"set: {{3: 1}}\nunknown: {{A/b: 1}}\nexperiments: {{e: {value}}}", "set: 3 is not a key of a deck"),
                        (f"set: {{A/b: &one {{c: *one}}}}\nunknown: {{A/b: 1}}\nexperiments: {{e: {value}}}", "within each other without end"),
                        (f"unknown: {{? [1] : 1}}\nexperiments: {{e: {value}}}", "a name is a text")):
        pathlib.Path("study.yaml").write_text(f"deck: deck.yaml\n{text}\n")
        said = package("fit", "study.yaml")
        check(said.returncode == 2 and words in said.stderr and said.stderr.count("\n") == 1, words, said.stderr)


def mistakes_are_reported_in_one_sentence():
    deck(SHEAR)
    numpy.savetxt("arc.csv", _ellipse(1, 1)[:40], delimiter=",")
    numpy.savetxt("circle.csv", _ellipse(1, 1), delimiter=",")
    datum, bare = {"series": "taylor_inertia", "value": 0.3, "error": 0.01}, {"series": "taylor_inertia", "value": 0.3}
    curve = {"series": "taylor_inertia", "curve": "curve.csv", "error": 0.01}
    numpy.savetxt("curve.csv", [[-1, 0.1], [0.5, 0.2]], delimiter=",")
    pathlib.Path("units.csv").write_text("rate,length [um]\n1,2.1\n")
    for change, words in (({"unknown": {}}, "nothing is unknown"), ({"deck": "other.yaml"}, "no deck other.yaml"), ({"models": 1}, "models is not known"),
                          ({"unknown": {"Membrane/capillary number": 0.3, "Particle/viscosity ratio": 1.0}}, "2 numbers are unknown"),
                          ({"experiments": {"a": {"data": [{"outline": "arc.csv", "scale": 1, "error": 0.1}]}}}, "does not close"),
                          ({"experiments": {"a": {"data": [{"outline": "circle.csv", "error": 0.1}]}}}, "has no scale"),
                          ({"experiments": {"a": {"data": [{"outline": "circle.csv", "scale": 1, "errors": 0.1}]}}}, "errors is not known"),
                          ({"experiments": {"a": {"data": [datum | {"series": "tailor"}]}}}, "no series tailor"),
                          ({"experiments": {"a": {"data": [datum | {"at": 9.0}]}}}, "before its data"),
                          ({"experiments": {"a": {"data": [datum | {"origin": "free"}]}}}, "is of a curve"),
                          ({"experiments": {"a": {"data": [curve | {"at": 1}]}}}, "`at` is of a value"), ({"experiments": {"a": {"data": [curve]}}}, "begin before"),
                          ({"experiments": {"a": {"set": {"Membrane/capillary number": 0.2}, "data": [datum]}}}, "is in `set`, but it is unknown"),
                          ({"set": {"Membrane/capillary number": 0.2}}, "in `set` or in the law the deck's law, but it is unknown in all runs"),
                          ({"laws": {"one": {"Membrane/capillary number": 0.2}}}, "or in the law one, but it is unknown"),
                          ({"next": {"Membrane/capillary number": [0.2]}}, "next: Membrane/capillary number is unknown"),
                          ({"experiments": {"a": {"data": [curve | {"against": "Membrane/capillary number"}]}}}, "is unknown, but it has the values of a table"),
                          ({"experiments": {"a": {"set": {"Flow/shear rate": 1}, "data": [curve | {"against": "Flow/shear rate"}]}}}, "but it has the values of a table"),
                          ({"experiments": {"a": {"data": [datum | {"against": "Flow/shear rate"}]}}}, "`against` is of a curve"),
                          ({"experiments": {"a": {"data": [curve | {"against": 3}]}}}, "against must be a section"),
                          ({"experiments": {"a": {"data": [curve | {"against": "Flow/shear rat"}]}}}, "a: the deck is refused: "),
                          ({"experiments": {"a": {"data": [curve | {"series": "length_x1", "curve": "units.csv", "against": "Flow/shear rate"}]}}},
                           "the table is in um, which does not fit the unit of length_x1, length; the deck has no section Units"),
                          ({"experiments": {"a": {"data": [curve | {"columns": [1, "D"]}]}}}, "has no column D; there are: column 1, column 2"),
                          ({"experiments": {"a": {"data": [datum]}, "b": {"data": [bare]}}}, "missing for b: data, but other"),
                          ({"experiments": {"a": {"data": [bare]}}, "unknown": {"Membrane/capillary number": {"known": 0.3, "error": 0.1}}},
                           "Membrane/capillary number has an error, but the data have none"),
                          ({"experiments": {"a": {"data": [{"outline": "circle.csv", "scale": 1, "scale error": 0.1}]}}}, "the scale of a: data has an error"),
                          ({"set": 3}, "set must be a section of keys"), ({"laws": {"one": 3}}, "laws: one must be a section"), ({"next": {"A/b": 3}}, "next: A/b must be a list"),
                          ({"experiments": {"a": {"data": [datum | {"value": "much"}]}}}, "much is not a number"),
                          ({"unknown": {"Membrane/capillary numbr": 0.3}}, "capillary number meant"),
                          ({"unknown": {"Membrane/capillary number": {"start": 0.3, "too": 1}}}, "too is not known"),
                          ({"unknown": {"Membrane/capillary number": {"start": 0.3, "spacing": "linaer"}}}, "not linaer"),
                          ({"set": {"Time/minimum step": 0.9, "Time/initial step": 0.95, "Membrane/capillary number": 1e-3}, "unknown": {"Particle/radius": 1.0}},
                           "all runs fail")):
        one = {"deck": "deck.yaml", "unknown": {"Membrane/capillary number": 0.3}, "experiments": {"a": {"data": [datum]}}} | change
        said = _fit(one, code=2)
        check(words in said and said.count("\n") == 1, words, said)


main()
