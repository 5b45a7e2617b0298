"""Literature curves to draw beside a run. They stand outside the project; see the README of their folder for sources."""

import math
import pathlib
import re
import sys
import warnings

import numpy

# First letters of a file name -> source. The capillary numbers in these names are of the Young modulus E_s = 3 G_s: ours are three
# times as large. The logarithmic neo-Hookean law differs from ours by up to 7 % in D.
SHEAR_SOURCES = {
    "pozrikidis_1995": "Pozrikidis 1995 (logarithmic law)",
    "ramanujan_pozrikidis_1998": "Ramanujan & Pozrikidis 1998 (logarithmic law)",
    "eggleton_popel_1998": "Eggleton & Popel 1998",
    "doddi_bagchi_2008": "Doddi & Bagchi 2008",
    "huet_2023_front_tracking": "Huet & Wachs 2023",
}

MORE = ("pre-inflation", "bending modulus", "bending number", "global area dilatation", "shear viscosity", "dilatational viscosity", "forces")  # than a law


class Curve:
    """`label`, times `t`, deformation `d`, `inclination` in degrees or None, and whether it is `exact` (a computed reference, all digits good)."""

    def __init__(self, label, t, d, inclination=None, exact=False):
        order = numpy.argsort(t, kind="stable")
        self.label, self.exact = label, exact
        self.t, self.d = numpy.asarray(t)[order], numpy.asarray(d)[order]
        self.inclination = None if inclination is None else numpy.asarray(inclination)[order]


def table(path, names=()):
    """A user's file: its columns of these names, or without names its rows of numbers, two or more. One sentence and the end of the program where it is none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = numpy.genfromtxt(path, delimiter=",", comments="#", names=True if names else None)
    except (OSError, ValueError, IndexError):
        found = numpy.zeros(0)
    whole = found.size > 1 and set(names) <= set(found.dtype.names or ()) if names else found.ndim == 2 and found.shape[1] > 1
    if not whole:
        sys.exit(f"{path} is no table {'with the columns ' + ', '.join(names) if names else 'of two columns of numbers'}, separated by commas")
    return found if names else found[numpy.isfinite(found).all(axis=1)]


def curves(run, folder):
    """Those of a folder (None: none) that belong to the run's scene: a neo-Hookean sphere in simple shear, by its capillary number."""
    if folder is None:
        return []
    folder = pathlib.Path(folder)
    membrane = run.deck.get("Membrane", {})
    plain = run.value("Particle/viscosity ratio", 1) == 1 and not any(membrane.get(key) for key in MORE)
    shear = run.value("Flow/type") == "simple shear" and run.value("Particle/shape", "sphere") == "sphere"
    ca = membrane.get("capillary number")
    if not (folder.is_dir() and plain and shear and membrane.get("law") == "neo-Hookean" and ca):
        return []
    return _spectral(folder, ca) + _digitised(folder, ca)


def _spectral(folder, ca):
    found = []
    for path in sorted(folder.glob("nh_shear_ca*_spectral.csv")):
        if math.isclose(float(re.search(r"_ca([\d.]+)_", path.name)[1]), ca):
            data = numpy.genfromtxt(path, delimiter=",", names=True)
            found.append(Curve("spectral reference", data["t"], data["taylor_inertia"], data["inclination_degrees"], exact=True))
    return found


def _digitised(folder, ca):
    found = []
    for start, label in SHEAR_SOURCES.items():
        for path in sorted(folder.glob(start + "_ca*")):
            number = re.fullmatch(re.escape(start) + r"_ca_?([\d.]+)\.(csv|txt)", path.name)
            if not number or not math.isclose(3 * float(number[1]), ca):
                continue
            if number[2] == "csv":
                t, d = numpy.loadtxt(path, delimiter=",", unpack=True)
                found.append(Curve(label, t, d))
            else:  # columns t, shortest, longest, D, angle in radians
                t, _, _, d, angle = numpy.loadtxt(path, unpack=True)
                found.append(Curve(label, t, d, numpy.degrees(angle)))
    return found


def interpolated(t, values, at, order=6):
    """values(t) at the times `at` within t, by polynomials through `order` points."""
    result = []
    for time in at:
        start = min(max(int(numpy.searchsorted(t, time)) - order // 2, 0), max(len(t) - order, 0))
        nodes = t[start:start + order]
        weights = [numpy.prod([(time - other) / (node - other) for other in nodes if other != node]) for node in nodes]
        result.append(float(numpy.dot(weights, values[start:start + order])))
    return numpy.array(result)


def difference(t, values, curve_t, curve_values):
    """Returns the largest |values - curve| over the times that both cover. The one with more times is interpolated to the times of the other. Rows
    with NaN, where a series is undefined, are left out. The result is 0 if no times are left."""
    series = [(numpy.asarray(times)[~numpy.isnan(found)], numpy.asarray(found)[~numpy.isnan(found)])
              for times, found in ((t, values), (curve_t, curve_values))]
    (fine_t, fine), (coarse_t, coarse) = sorted(series, key=lambda one: -len(one[0]))
    if not len(coarse_t):
        return 0.0
    common = (coarse_t >= fine_t[0]) & (coarse_t <= fine_t[-1])
    return float(numpy.max(numpy.abs(coarse[common] - interpolated(fine_t, fine, coarse_t[common])), initial=0.0))
