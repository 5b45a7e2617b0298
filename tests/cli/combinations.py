#!/usr/bin/python3
# ranks: 2
# Decks that cover all pairs of choices. A pair is covered if a deck with it runs and passes the checks, or if the
# program rejects it with a message whose reason is in REASONS. --check decides which pairs the program accepts, so that
# a pair that becomes accepted counts as covered.
#   combinations.py <tanktread> <source directory>             the decks that cover most pairs
#   combinations.py <tanktread> <source directory> --long      all of them
#   combinations.py <tanktread> <source directory> --list      prints the decks as choices, runs nothing
#   combinations.py <tanktread> <source directory> --one 'kind=drop, flow=duct'     runs one deck and its checks; the other choices are defaults that are compatible
import collections
import concurrent.futures
import functools
import itertools
import pathlib
import re
import shutil
import sys
import tempfile
import time

import numpy
import yaml

from harness import Failed, check, difference, run
from metamorphic import _rotation, _rotation_vector

FACTORS = {  # the first value of each factor is its default
    "kind": ["capsule", "drop", "red cell", "vesicle", "free body", "prescribed body"],
    "law": ["neo-Hookean", "Skalak", "Mooney-Rivlin", "Evans-Skalak", "expression", "surface tension", "none"],
    "ratio": ["1", "5", "0.2"],
    "surfactant": ["no", "yes"],
    "Maxwell": ["no", "yes"],
    "viscosity": ["no", "yes"],
    "weight": ["no", "yes"],
    "flow": ["simple shear", "quiescent", "uniform", "four-roll", "planar hyperbolic", "uniaxial extension", "linear", "round parabolic",
             "plane parabolic", "duct", "changing"],
    "medium": ["unbounded", "wall", "lattice of 1", "lattice of 2", "lattice of 3"],
    "duct": ["none", "tube", "channel"],
    "number": ["1", "2"],
    "scheme": ["bs3", "rkc2", "tr-bdf2", "bdf3", "crank-nicolson", "auto"],
    "step": ["fixed", "controlled"],
    "adaptation": ["no", "yes"],
    "symmetry": ["auto", "none"],
}
RIGID, FLUID = ("free body", "prescribed body"), ("drop", "vesicle")
LATTICES = ("lattice of 1", "lattice of 2", "lattice of 3")
ELASTIC = ("neo-Hookean", "Skalak", "Mooney-Rivlin", "Evans-Skalak", "expression")
ONE_IS_NOT_REPEATED = True

# Pairs of choices that the program rejects: words of the message, the choices that it names, and the reason.
ANY = {factor: tuple(values) for factor, values in FACTORS.items()}
REASONS = [
    ("a rigid particle has no membrane", {"kind": RIGID, "law": ("none",)}, {"law": (*ELASTIC, "surface tension"), "Maxwell": ("yes",), "viscosity": ("yes",)},
     "a rigid body has no membrane"),
    ("no fluid inside", {"kind": RIGID, "law": ("none",)}, {"ratio": ("5", "0.2")}, "a rigid body has no fluid inside"),
    ("the viscosity of a fluid interface has no memory", {"kind": FLUID, "law": ("surface tension",), "surfactant": ("yes",)}, {"Maxwell": ("yes",)},
     "an interface has no stress-free shape that springs could remember"),
    ("only the interface of a drop", {"kind": ("capsule", "red cell", *RIGID), "law": (*ELASTIC, "none")}, {"surfactant": ("yes",)},
     "surfactant is on an interface of two fluids"),
    ("the motion of the body is given", {"kind": ("prescribed body",)}, {"weight": ("yes",)}, "a motion that is given takes whatever force it needs"),
    ("a flow must be along the wall", {"medium": ("wall",)}, {"flow": FACTORS["flow"]}, "there is no flow through a wall"),
    ("a plane wall is represented by images", {"medium": ("wall",)}, {"duct": ("tube", "channel"), "flow": ("duct",)}, "a plane wall cuts a duct or is outside of it"),
    ("that flow is for unbounded fluid", {"duct": ("tube", "channel")}, {"flow": FACTORS["flow"]}, "the flow is not at rest at the wall of the duct"),
    ("needs a section Tube", {"flow": ("duct",)}, {"duct": ("none",), "medium": ("wall", *LATTICES)}, "the flow of a duct needs a duct"),
    ("Membrane/relaxation time needs Membrane/shear viscosity", {"Maxwell": ("yes",)}, {"viscosity": ("no",)}, "the springs are in series with dashpots"),
    ("a net force in every cell needs", {"medium": ("lattice of 1", "lattice of 2")}, {"kind": ("prescribed body",), "weight": ("yes",)},
     "without walls nothing balances a net force in every cell"),
    ("the flow must be the same in every cell", {"medium": ("lattice of 2", "lattice of 3")}, {"flow": ("round parabolic", "plane parabolic")},
     "a velocity that depends on the place does not repeat across"),
    ("a tube or channel is periodic along x1 only", {"medium": ("lattice of 2", "lattice of 3")}, {"duct": ("tube", "channel"), "flow": ("duct",)}, "a duct has walls across"),
]
NO_DECK = {*(("kind", kind, "law", "surface tension") for kind in ("capsule", "red cell")), *(("kind", kind, "law", law) for kind in FLUID for law in ELASTIC),
           # excluded by the definition of the kinds
           *(("kind", kind, "law", "none") for kind in FACTORS["kind"] if kind not in RIGID)}
RANK = {factor: k for k, factor in enumerate(FACTORS)}
# Known defects: cases in which a resumed run is not bitwise equal. A function of the choices, the differences and the
# names of the counters returns true if the defect explains the differences.
OPEN = {
    "a resumed run differs by rounding": lambda c, off, counts: off and (c["medium"] != "unbounded" or c["adaptation"] == "yes") and
                                         (c["ratio"] != "1" or c["kind"] in RIGID or c["viscosity"] == "yes" or c["number"] == "2") and
                                         all(value < 1e-9 for name, value in off.items() if name not in counts and name != "power_residual"),
}
COUNTED = re.compile(r"evaluations|velocity_iterations|solver_iterations|iterations")
GRADIENTS = {"simple shear": [[0, 0, 1], [0, 0, 0], [0, 0, 0]], "four-roll": [[0.65, 0, 0.35], [0, 0, 0], [-0.35, 0, -0.65]],
             "planar hyperbolic": [[1, 0, 0], [0, 0, 0], [0, 0, -1]], "uniaxial extension": [[-0.5, 0, 0], [0, -0.5, 0], [0, 0, 1]],
             "linear": [[0.3, -0.2, 1.0], [0.1, -0.4, 0.2], [-0.3, 0.5, 0.1]], "changing": [[0, 0, 1], [0, 0, 0], [0, 0, 0]]}
STEP, STEPS = 0.005, 3
FIRST = 12  # number of decks in the short run
CHECKS = ("series", "resume", "ranks", "order", "symmetry", "motions")
SIDES = [6.5, 3.7, 3.9]  # side lengths of a lattice divided by the particle's radius
OWN = re.compile(r"(.*/)?(wall_seconds|solver_iterations|velocity_iterations)")  # these series depend on the machine or on the order of summation
UNDEFINED = re.compile(r"(.*/)?(inclination|axis_1_x[123])")  # NaN if two semi-axes are equal
# positions of a smallest distance: known only to the square root of the tolerance, or one of several
NEAREST = re.compile(r"first_of_gap|second_of_gap|particle_at_wall|gap_x[123]|nearest_to_wall_x[123]")
RATIOS = ("disturbance_flux", "force_imbalance")  # errors divided by a flow rate or force that may be small, as in a tube whose wall moves
INVARIANT = re.compile(r"(.*/)?(volume|area|energy|membrane_dissipation|local_area_change|axis_[123]|surfactant_mass|smallest_concentration"
                       r"|largest_concentration|gap|smallest_gap|fluid_dissipation|disturbed_pressure_drop)")


def complete(fixed):
    """Returns the choices in `fixed`, completed by default choices that are compatible with them."""
    c = dict(fixed)
    if "kind" not in c:
        wants = "drop" if "surfactant" in c and c["surfactant"] == "yes" else "capsule"
        c["kind"] = {"surface tension": "drop", "none": "free body", None: wants}.get(c.get("law"), "capsule")
    if "law" not in c:
        c["law"] = "none" if c["kind"] in RIGID else "surface tension" if c["kind"] in FLUID else "neo-Hookean"
    if c.get("Maxwell") == "yes":
        c.setdefault("viscosity", "yes")
    if c.get("duct", "none") != "none":
        c.setdefault("flow", "duct")
    if c.get("flow") == "duct":
        c.setdefault("duct", "tube")
    if c.get("medium") in LATTICES and ONE_IS_NOT_REPEATED:
        c.setdefault("number", "2")
    return {factor: c.get(factor, values[0]) for factor, values in FACTORS.items()}


class Scene:
    """The deck of a set of choices. The scene is shifted by `shift` and rotated by `turn`."""

    def __init__(self, c, shift=(0, 0, 0), turn=numpy.eye(3), order=("one", "two"), more=(), symmetric=None):
        self.c, self.shift, self.turn, self.order, self.more = c, numpy.array(shift, float), turn, order, more
        self.symmetric = c["symmetry"] == "auto" if symmetric is None else symmetric
        self.a = 0.4 if c["duct"] != "none" else 1.0

    def place(self, x):
        return [float(value) for value in self.turn @ numpy.array(x) * self.a + self.shift]

    def vector(self, x):
        return [float(value) for value in self.turn @ numpy.array(x, float)]

    def flow(self):
        c, name = self.c, self.c["flow"]
        flow = {"type": name}
        turned = not numpy.array_equal(self.turn, numpy.eye(3)) and name in GRADIENTS and c["duct"] == "none"
        if name == "changing":
            flow = {"type": "duct" if c["duct"] != "none" else "simple shear",
                    "history": {"type": "sine", "mean": 1.0, "amplitude": 0.5, "frequency": 10.0}}
        if turned or name == "linear":
            flow["type"], gradient = "linear", self.turn @ numpy.array(GRADIENTS[name], float) @ self.turn.T
            gradient -= numpy.eye(3) * numpy.trace(gradient) / 3
            flow["gradient"] = [float(value) for value in gradient.ravel()]
        elif name == "uniform":
            flow["velocity"] = self.vector([0.7, -1.1, 0.0 if c["medium"] == "wall" else 0.4])
        elif name == "four-roll":
            flow["roll parameter"] = 0.3
        elif name.endswith("parabolic"):
            flow.update({"type": "parabolic", "profile": name.split()[0], "maximum velocity": 3.0, "half width": 3.0})
        if c["weight"] == "yes":
            flow["gravity"] = self.vector([0.4, -0.3, -1.0])
        return flow

    def particle(self, size, centre, symmetric):
        c, kind, a = self.c, self.c["kind"], self.a * size
        axes = _rotation(numpy.radians([20.0, 35.0, -15.0])) if not symmetric else numpy.eye(3)
        particle = {"shape": "ellipsoid", "semi-axes": [float(a * x) for x in ([1.15, 1.05, 0.7] if kind == "vesicle" else [1.1, 1.0, 0.9])]}
        if kind == "red cell":
            particle = {"shape": "red cell", "radius": 1.2 * a}
        particle["center"] = self.place(centre)
        axes = self.turn @ axes
        if not numpy.array_equal(axes, numpy.eye(3)):
            particle["orientation"] = [float(x) for x in _rotation_vector(axes)]
        if kind in ("capsule", "red cell"):
            particle["initial shape"] = {"stretch": [1.05, 0.98, 1.0]}
        if kind in RIGID:
            particle["motion"] = kind.split()[0]
        if kind == "prescribed body":
            particle.update({"velocity": self.vector([0.5, 0.0, 0.2]), "angular velocity": self.vector([0.2, 0.1, 1.0])})
        if c["ratio"] != "1":
            particle["viscosity ratio"] = float(c["ratio"])
        if c["weight"] == "yes":
            particle["density difference"] = 0.8
        return particle

    def membrane(self):
        c, law = self.c, self.c["law"]
        membrane = {} if law == "none" else {"law": law, "surface tension" if law == "surface tension" else "shear modulus": 5.0}
        if law in ("Skalak", "Evans-Skalak"):
            membrane["area dilatation"] = 2.0
        if law == "Mooney-Rivlin":
            membrane["neo-Hookean share"] = 0.7
        if law == "expression":
            membrane.update({"energy": "(I1 - log(I2 + 1) + c*log(I2 + 1)^2)/2", "constants": {"c": {"value": 0.5}}})
        if c["kind"] == "vesicle":
            membrane.update({"bending number": 0.1, "bending reference": "flat", "global area dilatation": 5.0})
        if c["kind"] == "red cell":
            membrane["bending number"] = 0.02
        if c["viscosity"] == "yes":
            membrane["shear viscosity"] = 0.5 * self.a
        if c["Maxwell"] == "yes":
            membrane["relaxation time"] = 0.1
        return {"Membrane": membrane} if membrane else {}

    def lists(self):
        c = self.c
        lists = {**self.membrane(), "Surface": {"elements per side": 3}}
        if c["surfactant"] == "yes":
            lists["Interface"] = {"surfactant": {"elasticity number": 0.3, "diffusivity": 0.1 * self.a**2}}
        if c["adaptation"] == "yes":
            # the mesh has 218 points after a step or two
            lists["Adaptation"] = {"enabled": True, "surface tolerance": 5e-6 * self.a, "levels": 1}
            lists["Surface"]["extraordinary points"] = "catmull-clark"
        return lists

    def deck(self):
        c = self.c
        symmetric = self.symmetric
        off = numpy.zeros(3) if symmetric else numpy.array([0.1, -0.2, 0.15]) * (0.5 if c["duct"] != "none" else 1)
        deck = {"Flow": self.flow()}
        if c["number"] == "1":
            deck.update({"Particle": self.particle(1.0, off, symmetric), **self.lists()})
        else:
            apart = numpy.array([1.45, 0.0, 0.0 if symmetric else 0.1])
            two = {"one": self.particle(1.0, off - apart, symmetric), "two": self.particle(1.0 if symmetric else 0.9, off + apart, symmetric)}
            deck["Particles"] = {name: {**two[name], **self.lists()} for name in self.order}
        if c["duct"] == "tube":
            deck["Tube"] = {"azimuthal elements": 8, "axial elements": 8}
        if c["duct"] == "channel":
            deck["Channel"] = {"azimuthal elements": 8, "axial elements": 16, "depth": 0.2, "half length": 1.5}
        if c["medium"] == "wall":
            deck["Wall"] = {"point": self.place([0, 0, -1.7]), "normal": self.vector([0, 0, 1])}
        if c["medium"] in LATTICES:
            directions = ["x1", "x2", "x3"][:int(c["medium"][-1])]
            vectors = [self.a * side * numpy.array(axis) for side, axis in zip(SIDES, numpy.eye(3))]
            deck["Domain"] = {"periodic": " ".join(directions), "lattice vectors": [x for vector in vectors for x in self.vector(vector)]}
            if c["duct"] != "none":
                deck["Domain"] = {"periodic": " ".join(directions), "side lengths": [4.0]}
        deck["Time"] = {"scheme": c["scheme"], "final time": STEPS * STEP}
        deck["Time"].update({"fixed step": STEP} if c["step"] == "fixed" else {"initial step": STEP, "maximum step": STEP, "tolerance": 1e-3})
        if c["kind"] == "vesicle" and c["scheme"] == "bs3" and c["step"] == "fixed":
            deck["Time"]["fixed step"] /= 2  # bending makes the explicit scheme unstable with the whole step on a refined mesh
        if c["scheme"] == "crank-nicolson":
            deck["Time"]["nonlinear solver"] = "anderson"  # without it, (4.1) diverges for long steps
        if c["symmetry"] == "none":
            deck["Symmetry"] = {"use": "none"}
        deck["Solvers"] = {"tolerance": 1e-12}
        deck["Output"] = {"interval": STEP, "between steps": "land"}
        if self.balances():
            deck["Output"]["power balance"] = True
        for section, key, value in self.more:
            deck.setdefault(section, {})[key] = value
        return deck

    def balances(self):
        return self.c["kind"] not in RIGID and not self.c["flow"].endswith("parabolic")

    def steady(self):
        return self.c["kind"] == "prescribed body" and self.c["number"] == "1" and self.c["medium"] not in LATTICES

    def text(self):
        return yaml.safe_dump({"Tanktread": self.deck()}, sort_keys=False, default_flow_style=None, width=1000)


@functools.cache
def _sentences(text):
    with tempfile.TemporaryDirectory(prefix="tanktread-") as directory:
        path = pathlib.Path(directory) / "deck.yaml"
        path.write_text(text)
        result = run(path, "--check", "--quiet", code=None)
    check(result.returncode in (0, 2), f"exit code {result.returncode} of --check: {result.stderr}\n{text}")
    return tuple(result.stderr.splitlines()) if result.returncode else ()


def sentences(c):
    """Returns the messages with which the program rejects the choices; empty if it accepts them."""
    return _sentences(Scene(c).text())


def pairs_of(c):
    return {((f, c[f]), (g, c[g])) for f, g in itertools.combinations(FACTORS, 2)}


def reason(pair, said):
    """Returns the entry of REASONS for a pair of choices whose words occur in one of the messages `said`; None if there
    is none."""
    (f, a), (g, b) = pair
    for entry in REASONS:
        words, one, other, _ = entry
        for x, y in ((one, other), (other, one)):
            if a in x.get(f, ()) and b in y.get(g, ()) and any(re.search(words, sentence) for sentence in said):
                return entry
    return None


class Cover:
    """Decks that cover all pairs that the program accepts, and a deck of each pair that it rejects.

    Greedy algorithm: each deck starts from an uncovered pair and adds the choices that cover most other pairs, without
    pairs that are known to be rejected. If the program rejects the deck, the pairs that the messages name are tested
    separately.
    """

    def __init__(self):
        self.left = {((f, a), (g, b)): None for f, g in itertools.combinations(FACTORS, 2) for a in FACTORS[f] for b in FACTORS[g]
                     if (f, a, g, b) not in NO_DECK}
        self.barred = {((f, a), (g, b)) for f, a, g, b in NO_DECK}  # pairs that are known to be rejected
        self.together = []  # sets of three choices that are rejected although each pair of them is accepted
        self.decks, self.rejected, self.without_reason = [], {}, {}
        self.asked = 0
        while self.left:
            self.next_deck()

    def next_deck(self):
        count = collections.Counter(choice for pair in self.left for choice in pair)
        start = max(self.left, key=lambda pair: count[pair[0]] + count[pair[1]])
        c = self.grown(dict(start), count)
        if c is None:  # no completion without a rejected pair exists
            return self.reject(start)
        self.asked += 1
        said = sentences(c)
        if not said:
            self.decks.append(c)
            self.left = {pair: None for pair in self.left if pair not in pairs_of(c)}
            return None
        blamed = sorted(pair for pair in pairs_of(c) if reason(pair, said))
        if not any([pair in self.left and self.reject(pair) for pair in blamed]) and not self.third(blamed, c):
            self.without_reason[said] = c
            self.reject(start)
        return None

    def third(self, blamed, c):
        """Searches for a choice in c that makes the program reject a pair which it accepts without this choice.
        Returns True if there is one."""
        for pair in blamed:
            for choice in c.items():
                self.asked += 1
                if choice not in pair and reason(pair, sentences(complete(dict([*pair, choice])))):
                    self.together.append({*pair, choice})
                    return True
        return False

    def reject(self, pair):
        """Tests a pair with default choices otherwise. Returns True if it is rejected."""
        c = complete(dict(pair))
        self.asked += 1
        said = sentences(c)
        if not said:
            self.decks.append(c)
            self.left = {other: None for other in self.left if other not in pairs_of(c)}
            return False
        self.rejected[pair] = (c, said, reason(pair, said))
        self.barred.add(pair)
        self.left.pop(pair, None)
        return True

    def grown(self, c, count):
        """Completes c by a value for each missing factor such that no pair is barred. Depth-first search; values that
        cover most uncovered pairs come first. Returns None if there is no such completion."""
        rest = sorted((f for f in FACTORS if f not in c), key=lambda f: (-sum(count[f, a] for a in FACTORS[f]), f))
        if not rest:
            return c
        # factors with only one possible value come first
        f = min(rest, key=lambda f: (sum(self.fits(c, f, a) for a in FACTORS[f]) > 1, rest.index(f)))
        for a in sorted((a for a in FACTORS[f] if self.fits(c, f, a)), key=lambda a: -sum(self.pair(g, c[g], f, a) in self.left for g in c)):
            if whole := self.grown({**c, f: a}, count):
                return whole
        return None

    def fits(self, c, f, a):
        return all(self.pair(g, c[g], f, a) not in self.barred for g in c) and not any({(f, a)} <= three <= {*c.items(), (f, a)} for three in self.together)

    @staticmethod
    def pair(f, a, g, b):
        return ((f, a), (g, b)) if RANK[f] < RANK[g] else ((g, b), (f, a))


def _series(results):
    """Returns {name: values} for all series of a run. The series of a particle are named `particle/name`."""
    import h5py

    found = {}
    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        file["series"].visititems(lambda name, item: found.update({name: item[:]}) if hasattr(item, "shape") else None)
    return found


def _points(results):
    """Returns for each particle the points of its last surface relative to their mean."""
    import h5py

    with h5py.File(sorted(pathlib.Path(results).glob("snapshot_*.hdf"))[-1], "r") as file:
        points = file["VTKHDF/Points"][:]
        particle = file["VTKHDF/PointData/particle"][:] if "particle" in file["VTKHDF/PointData"] else numpy.zeros(len(points))
    return [points[particle == p] - points[particle == p].mean(0) for p in numpy.unique(particle)]


class Trial:
    """Runs and checks of one deck, in a separate directory."""

    def __init__(self, c, directory):
        self.scene, self.c, self.directory, self.wrong = Scene(c), c, pathlib.Path(directory), []

    def run(self, name, scene, ranks=1):
        path = self.directory / f"{name}.yaml"
        path.write_text(scene.text())
        run(path, "--output", self.directory / name, "--overwrite", "--quiet", ranks=ranks)
        return self.directory / name

    def compare(self, one, other, tolerance, chosen=None, excluded=OWN, rows=None):
        a, b = ({name: values[:rows] for name, values in _series(results).items()} for results in (one, other))
        check(a.keys() == b.keys(), f"other series: {sorted(a.keys() ^ b.keys())}")
        off = {}
        for name in a:
            if excluded.fullmatch(name) or OWN.fullmatch(name) or UNDEFINED.fullmatch(name) or (chosen and not chosen.fullmatch(name)):
                continue
            off[name] = difference(a[name], b[name], name)
        beyond = {name: f"{value:.1e}" for name, value in off.items() if value > tolerance * (100 if name in RATIOS else 1)}
        check(not beyond, f"off by more than {tolerance:g}: {beyond}")

    def check_series(self):
        """Checks volume, surfactant mass, forces and power balance, and that all values are finite."""
        c, found = self.c, _series(self.base)
        for name, values in found.items():
            last = name.split("/")[-1]
            check(not numpy.isinf(values).any() and (UNDEFINED.fullmatch(name) or last == "power_residual" or not numpy.isnan(values).any()), f"{name} is not finite: {values}")
            if last == "volume_error":
                check(abs(values).max() <= 1e-12, f"{name} {abs(values).max():.1e}")
            if last == "surfactant_mass":
                check(abs(values - 1).max() <= 1e-12, f"{name} {abs(values - 1).max():.1e}")
            if last == "power_residual":
                check(numpy.nan_to_num(abs(values)).max() <= 3e-2, f"{name} {values}")
            if last == "force_imbalance":  # tolerance for a wall with 8 azimuthal elements
                check(abs(values).max() <= 5e-3, f"{name} {abs(values).max():.1e}")
        if c["medium"] == "lattice of 3" and c["kind"] != "prescribed body":
            weights = 0.8 * numpy.array([0.4, -0.3, -1.0]) if c["weight"] == "yes" else numpy.zeros(3)
            gradient = numpy.array([found[f"pressure_gradient_x{k}"][-1] for k in (1, 2, 3)])
            check(abs(abs(gradient) - abs(weights * found["volume_fraction"][-1])).max() <= 1e-6, f"pressure gradient {gradient} for weights {weights}")

    def check_resume(self):
        """Checks that a resumed run is bitwise equal to the uninterrupted run."""
        parts = self.directory / "parts"
        shutil.copytree(self.base, parts)
        snapshots = sorted(parts.glob("snapshot_*.hdf"))
        check(len(snapshots) > 2, f"{len(snapshots)} snapshots")
        snapshots[-1].unlink()
        run("--resume", parts, "--quiet")
        a, b = _series(self.base), _series(parts)
        check(all(a[name].shape == b[name].shape for name in a), "other numbers of rows")
        off = {name: difference(a[name], b[name], name) for name in a if not name.endswith("wall_seconds") and a[name].tobytes() != b[name].tobytes()}
        counts = [name for name in off if COUNTED.fullmatch(name)]
        self.open = [what for what, holds in OPEN.items() if holds(self.c, off, counts)]
        check(not off or self.open, f"resumed run differs: {off}")

    def implicit(self):
        return self.c["scheme"] in ("tr-bdf2", "bdf3", "auto")

    def rounding(self):
        """Returns the tolerance for a change of the order of summation. Implicit schemes amplify rounding errors, and
        more so just after a refinement, because they extrapolate with the frozen operator, which is stored in single
        precision."""
        return 1e-7 if self.c["adaptation"] == "yes" else 1e-8 if self.implicit() else 1e-10

    def check_ranks(self):
        self.compare(self.base, self.run("ranks", self.scene, ranks=2), self.rounding())

    def check_order(self):
        """Checks that the order of the particles does not matter. Symmetry is off, because quadrature rules at equal
        distances may differ."""
        one, other = (self.run(name, Scene(self.c, order=order, symmetric=False)) for name, order in (("ordered", ("one", "two")), ("permuted", ("two", "one"))))
        self.compare(one, other, self.rounding(), excluded=NEAREST)

    def check_motions(self):
        """Checks that a shift and a rotation of the scene do not change the result. A rotation changes the rounding of
        the frozen operator, which is stored in single precision and with which implicit schemes extrapolate."""
        tolerance = 1e-5 if self.implicit() else 1e-8
        c, more = self.c, [("Quadrature", "tolerance", 1e-9), ("Time", "newton tolerance", 1e-9), ("Time", "newton iterations", 50),
                           ("Time", "iteration tolerance", 1e-12), ("Time", "final time", STEP)]
        shifts = {"tube": [7.0, 0, 0], "channel": None}.get(c["duct"], [2.0, -3.0, 5.0])
        if c["medium"] == "wall" or c["flow"] == "plane parabolic":
            shifts = [2.0, -3.0, 0.0]
        if c["flow"] == "round parabolic":
            shifts = [2.0, 0.0, 0.0]
        turn = {"tube": _rotation(numpy.array([numpy.pi / 4, 0, 0])), "channel": None}.get(c["duct"], _rotation(numpy.array([0.5, -0.9, 0.3])))
        if c["flow"].endswith("parabolic") or (c["duct"] == "tube" and c["flow"] == "simple shear"):
            turn = None
        if shifts is None and turn is None:
            return
        exact = self.run("exact", Scene(c, more=more))
        for name, scene in ("shifted", shifts is not None and Scene(c, shift=shifts, more=more)), ("turned", turn is not None and Scene(c, turn=turn, more=more)):
            if not scene:
                continue
            other = self.run(name, scene)
            self.compare(exact, other, 1e-8, chosen=INVARIANT, rows=1)
            self.compare(exact, other, tolerance, chosen=INVARIANT)
            if not self.scene.steady():
                for one, moved in zip(_points(exact), _points(other)):
                    check(one.shape == moved.shape, f"{name}: {len(one)} and {len(moved)} points")
                    off = abs(one @ scene.turn.T - moved).max()
                    check(off <= tolerance, f"{name}: points are off by {off:.1e}")

    def check_symmetry(self):
        """Checks that a run with symmetry agrees with a run without symmetry. Numbers of evaluations may differ. Only the
        first row is compared if rkc2 takes fewer stages because of the symmetry. Integrals over the wall of a channel
        agree to Quadrature/tolerance, because the quadrature rules differ."""
        tolerance = 1e-5 if self.c["duct"] == "channel" else 1e-6 if self.implicit() else 1e-8
        whole = self.run("whole", Scene(self.c, more=[("Symmetry", "use", "none")]))
        fewer = False
        if self.c["scheme"] == "rkc2" and not self.scene.steady():  # a single body with prescribed motion takes no steps
            fewer = (_series(self.base)["evaluations"] != _series(whole)["evaluations"]).any()
        self.compare(self.base, whole, tolerance, excluded=re.compile(NEAREST.pattern + "|.*(iterations|assemblies|evaluations)"), rows=1 if fewer else None)

    def checks(self, ranks):
        yield self.check_series
        if not self.scene.steady():
            yield self.check_resume
        if ranks:
            yield self.check_ranks
        if self.c["number"] == "2":
            yield self.check_order
        if self.c["symmetry"] == "auto":
            yield self.check_symmetry
        if self.c["adaptation"] == "no" or self.c["number"] == "1":  # with 436 points this takes minutes
            if "--long" in sys.argv or self.c["medium"] not in LATTICES:
                yield self.check_motions

    def faults(self, ranks, chosen):
        """Runs the deck and its checks. Returns the failures, the known defects (OPEN) that occurred, and the seconds
        of each check."""
        wrong, seconds, self.open = [], {}, []
        try:
            self.base = self.run("base", self.scene)
        except Failed as failure:
            return [f"run: {failure}"], [], seconds
        for one in self.checks(ranks):
            name, begin = one.__name__.removeprefix("check_"), time.monotonic()
            if name in chosen:
                try:
                    one()
                except Failed as failure:
                    wrong.append(f"{name}: {failure}")
                seconds[name] = round(time.monotonic() - begin, 1)
        return wrong, self.open, seconds


def said_of(c):
    """Returns the choices that differ from the default choices, as text."""
    neutral = complete({})
    return ", ".join(f"{factor}={value}" for factor, value in c.items() if value != neutral[factor]) or "neutral"


def _option(name, default):
    return sys.argv[sys.argv.index(name) + 1] if name in sys.argv else default


def _tried(c, ranks):
    with tempfile.TemporaryDirectory(prefix="tanktread-") as directory:
        return Trial(c, directory).faults(ranks, _option("--checks", ",".join(CHECKS)).split(","))


def _report(decks):
    """Runs the decks, two at a time. Returns the number of decks with failures."""
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for c, (wrong, still_open, seconds) in zip(decks, pool.map(_tried, decks, itertools.cycle([True, False, False]))):
            failed += bool(wrong)
            print("FAILED" if wrong else "passed", said_of(c), seconds if "--long" in sys.argv else "", *("\n    open: " + one for one in still_open), *("\n    " + one for one in wrong), flush=True)
            if wrong:
                print(Scene(c).text(), flush=True)
    return failed


def _main():
    if one := _option("--one", ""):
        c = complete(dict(word.strip().split("=") for word in one.split(",")))
        if said := sentences(c):
            sys.exit("\n".join(said))
        sys.exit(bool(_report([c])))
    cover = Cover()
    met = [why for _, _, why in cover.rejected.values() if why]
    for _, said, why in cover.rejected.values():
        if why is None:
            print("a rejection without a reason:", *said, sep="\n    ")
    for said, c in cover.without_reason.items():
        print("a rejection without a reason,", said_of(c), *said, sep="\n    ")
    table = run("--rejections").stdout
    unlisted = {why for _, said, _ in cover.rejected.values() for sentence in said
                for why in re.findall(r" contradict each other: ([^.]*?)(?:, but at \[.*)?\.$", sentence) if why.split(", in ")[0] not in table}
    for why in unlisted:
        print("not in the table of --rejections:", why)
    for entry in REASONS:
        if entry not in met:
            print("no deck is rejected any more for:", entry[3], f"({entry[0]})")
    decks = cover.decks if "--long" in sys.argv or "--list" in sys.argv else cover.decks[:FIRST]
    covered = len(set().union(*map(pairs_of, decks)))
    print(f"{len(decks)} of {len(cover.decks)} decks, {covered} pairs; {len(cover.rejected)} pairs are rejected")
    if "--list" in sys.argv:
        return print("\n".join(map(said_of, decks)))
    failed = _report(decks) + len(unlisted) + len(cover.without_reason) + sum(why is None for _, _, why in cover.rejected.values())
    sys.exit(failed > 0)


_main()
