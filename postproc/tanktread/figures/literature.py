"""Literature curves to draw beside a run. They stand outside the project; see the README of their folder for
sources."""

import math
import pathlib
import re

import numpy

from ..files import table

# First letters of a file name: source. The capillary numbers in these names are of the Young modulus E_s = 3 G_s: those
# of decks are three times as large. The logarithmic neo-Hookean law differs from `neo-Hookean` by up to 7 % in D.
SHEAR_SOURCES = {
    "pozrikidis_1995": "Pozrikidis 1995 (logarithmic law)",
    "ramanujan_pozrikidis_1998": "Ramanujan & Pozrikidis 1998 (logarithmic law)",
    "eggleton_popel_1998": "Eggleton & Popel 1998",
    "doddi_bagchi_2008": "Doddi & Bagchi 2008",
    "huet_2023_front_tracking": "Huet & Wachs 2023",
}

# Keys by which a membrane has more than a law.
MORE = ("pre-inflation", "bending modulus", "bending number", "global area dilatation", "shear viscosity",
        "dilatational viscosity", "forces")


class Curve:
    """`label`, times `t`, deformation `d`, `inclination` in degrees or None, and whether it is `exact` (a computed
    reference, all digits good)."""

    def __init__(self, label, t, d, inclination=None, exact=False):
        order = numpy.argsort(t, kind="stable")
        self.label, self.exact = label, exact
        self.t, self.d = numpy.asarray(t)[order], numpy.asarray(d)[order]
        self.inclination = None if inclination is None else numpy.asarray(inclination)[order]


def curves(run, folder):
    """Returns the curves in a folder (None: none) of the run's scene: a neo-Hookean sphere in simple shear, by its
    capillary number."""
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
            data = table(path, ("t", "taylor_inertia", "inclination_degrees"))
            found.append(Curve("spectral reference", data["t"], data["taylor_inertia"], data["inclination_degrees"],
                               exact=True))
    return found


def _digitised(folder, ca):
    found = []
    for start, label in SHEAR_SOURCES.items():
        for path in sorted(folder.glob(start + "_ca*")):
            number = re.fullmatch(re.escape(start) + r"_ca_?([\d.]+)\.(csv|txt)", path.name)
            if not number or not math.isclose(3 * float(number[1]), ca):
                continue
            if number[2] == "csv":
                found.append(Curve(label, *table(path)[:, :2].T))
            else:  # columns t, shortest, longest, D, angle in radians
                t, _, _, d, angle = table(path, columns=5, delimiter=None)[:, :5].T
                found.append(Curve(label, t, d, numpy.degrees(angle)))
    return found
