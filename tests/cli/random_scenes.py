#!/usr/bin/python3
# Random legal scenes: whatever a deck may ask for ends well, or stops with a checkpoint and a sentence of our own, and obeys the physics.
#   random_scenes.py <tanktread> <source directory>                                   a dozen, as a test
#   random_scenes.py <tanktread> <source directory> --count 1000 --jobs 2 [--first 0]     more of them; prints the decks that fail
import concurrent.futures
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
import numpy
import yaml

from harness import PROGRAM, SOURCE, check, main

WALL_CLOCK = 3  # seconds of a run, at the end of a step
PATIENCE = 60  # seconds, after which it hangs
MAY_BE_UNDEFINED = ("inclination", "axis_1_x1", "axis_1_x2", "axis_1_x3")
FOREIGN = ("terminate called", "Traceback", "Throw number", "what():", "Teuchos", "Belos::", "NOX::", "Tpetra", "Amesos2", "HDF5-DIAG", "MPI_ABORT",
           "std::", "Assertion", "runtime error:", "Sanitizer", "Segmentation")


def _kind(dice):
    return dice.choices(["capsule", "drop", "free", "prescribed"], [6, 3, 2, 1])[0]


def _flow(dice, kind, tube, unit):
    if tube:
        if kind == "prescribed" and dice.random() < 0.5:
            return {"type": "quiescent"}
        return {"type": "duct", "mean velocity": round(10 ** dice.uniform(-1, 2), 4)}
    flow = {"type": dice.choice(["quiescent", "uniform", "simple shear", "four-roll", "planar hyperbolic", "uniaxial extension", "linear"])}
    if flow["type"] == "uniform":
        flow["velocity"] = [unit * round(dice.uniform(-2, 2), 3) for _ in range(3)]
    elif flow["type"] == "linear":
        gradient = [round(dice.uniform(-1, 1), 3) for _ in range(9)]
        gradient[8] = round(-gradient[0] - gradient[4], 3)
        flow["gradient"] = gradient
    elif flow["type"] != "quiescent":
        flow["shear rate"] = round(10 ** dice.uniform(-1, 2.7), 4)
    if flow["type"] == "four-roll":
        flow["roll parameter"] = round(dice.uniform(-1, 1), 2)
    if dice.random() < 0.4:
        flow["viscosity"] = float(f"{10 ** dice.uniform(-3, 2):.3g}")
    return flow


def _speed(flow, radius):
    """Velocity over the particle, as Ca has it; 0 without a gradient."""
    if flow["type"] == "linear":
        return radius * float(numpy.linalg.norm(numpy.array(flow["gradient"]).reshape(3, 3), 2))
    return flow.get("mean velocity", flow.get("shear rate", 0) * radius)


def _particle(dice, kind, tube, unit):
    particle = {"shape": dice.choice(["sphere", "sphere", "spheroid", "ellipsoid", "red cell"])}
    if particle["shape"] in ("sphere", "red cell"):
        particle["radius"] = dice.uniform(0.2, 0.7) if tube else unit * dice.uniform(0.5, 2)
        size = particle["radius"] * (0.65 if particle["shape"] == "red cell" else 1)
    else:
        scale = 0.35 if tube else unit
        a, b, c = (round(dice.uniform(0.6, 1.6), 2) for _ in range(3))
        particle["semi-axes"] = [scale * x for x in ([a, a, c] if particle["shape"] == "spheroid" else [a, b, c])]
        size = float(numpy.cbrt(numpy.prod(particle["semi-axes"])))
    if dice.random() < 0.5:
        particle["orientation"] = [round(dice.uniform(-180, 180), 1) for _ in range(3)]
    if dice.random() < 0.4:
        particle["center"] = [0.0, round(dice.uniform(-0.1, 0.1), 3), 0.05] if tube else [unit * dice.choice([0, 0.3, -2, 10]) for _ in range(3)]
    if kind in ("free", "prescribed"):
        particle["motion"] = kind
    elif dice.random() < 0.5:
        particle["viscosity ratio"] = float(f"{10 ** dice.uniform(-2, 2):.3g}")
    if kind in ("capsule", "drop") and not tube and dice.random() < 0.2:
        particle["drift"] = dice.choice(["free", "held"])
    if kind == "prescribed":
        particle["velocity"] = [dice.choice([0, 1.0]), 0.0, 0.0 if tube else 0.5]
        if dice.random() < 0.5:
            particle["angular velocity"] = [0.2, 0.0, 1.0]
    return particle, size


def _membrane(dice, kind, flow, size, speed):
    modulus = "surface tension" if kind == "drop" else "shear modulus"
    capillary = round(10 ** dice.uniform(-1.7, 0), 4)
    viscosity = flow.get("viscosity", 1)
    membrane = {"law": "surface tension" if kind == "drop" else dice.choice(["neo-Hookean", "Skalak"])}
    stiffness = viscosity * (speed or size) / capillary
    if speed and dice.random() < 0.7:
        membrane["capillary number"] = capillary
    else:
        membrane[modulus] = float(f"{stiffness:.4g}")
    if kind == "drop":
        return membrane, stiffness
    if membrane["law"] == "Skalak":
        membrane["area dilatation"] = dice.choice([0.1, 1, 10])
    if dice.random() < 0.3:
        membrane["pre-inflation"] = round(dice.uniform(0, 0.2), 3)
    if dice.random() < 0.3:
        membrane["bending modulus"] = float(f"{stiffness * size ** 2 * 10 ** dice.uniform(-3, -1):.4g}")
        membrane["bending reference"] = dice.choice(["unstressed", "flat"])
    elif dice.random() < 0.1:
        membrane["load"] = "strong"
    return membrane, stiffness


def _surface(dice):
    if dice.random() < 0.7:
        return {"elements per side": dice.choice([3, 3, 4]), "extraordinary points": dice.choice(["g1", "g1", "catmull-clark"])}
    surface = {"mesh": "polar", "azimuthal elements": dice.choice([6, 8, 10]), "meridional elements": dice.choice([4, 5, 6]),
               "poles": dice.choice(["bezier transform", "plain", "c1"]), "pole axis": dice.choice(["x1", "x2", "x3"])}
    if surface["poles"] == "bezier transform" and dice.random() < 0.5:
        surface["pole subdivisions"] = dice.choice([0, 1, 2])
    return surface


def _load_that_the_poles_have(membrane, surface):
    """A plain pole has no load in the strong form, which is refused."""
    if surface.get("poles") == "plain":
        membrane.pop("load", None)


def _quadrature(dice, tube, surface):
    quadrature = {"tolerance": dice.choice([1e-3, 1e-4, 1e-5])}
    if dice.random() < 0.2:
        quadrature = {"rule": "fixed", "points": dice.choice([4, 6, 8])}
        if not tube and surface.get("poles") != "plain" and dice.random() < 0.3:
            quadrature["rule"] = "desingularised"
    if dice.random() < 0.4:
        quadrature["far sum"] = dice.choice(["dense", "tree"])
    return quadrature


def _time(dice, period):
    scheme = dice.choices(["tr-bdf2", "auto", "bdf3", "bs3", "rkc2", "crank-nicolson"], [5, 2, 2, 2, 2, 2])[0]
    time = {"scheme": scheme, "final time": float(f"{period * dice.uniform(0.3, 2):.4g}"), "tolerance": dice.choice([1e-2, 1e-3, 1e-4])}
    if dice.random() < 0.15:
        time["fixed step"] = float(f"{time['final time'] * dice.uniform(0.01, 0.1):.3g}")
    elif dice.random() < 0.2:
        time["maximum step"] = time["final time"] / 10
    if scheme == "crank-nicolson":
        time["nonlinear solver"] = dice.choice(["plain", "anderson", "newton-krylov"])
        time["step control"] = "error" if time["nonlinear solver"] != "plain" else dice.choice(["iterations", "error"])
    if scheme in ("tr-bdf2", "bdf3") and dice.random() < 0.3:
        time.update({"secants": dice.choice([0, 1, 5]), "predictor order": dice.choice([0, 2, 3])})
    return time


def _adaptation(dice):
    adaptation = {"enabled": True, "levels": dice.choice([1, 2]), "coarsen": dice.random() < 0.5, "largest number of points": 400}
    if dice.random() < 0.3:
        adaptation.update({"indicator": "variation", "limit aspect ratio": 1.5})
    return adaptation


def _solvers(dice, kind, tube):
    solvers = {"iterative solver": "GMRES", "tolerance": dice.choice([1e-6, 1e-8, 1e-10])}
    if kind in ("capsule", "drop"):
        if not tube and dice.random() < 0.3:
            solvers.update({"iterative solver": "BICGSTAB", "tolerance": 1e-6})  # it stagnates where GMRES does not
        solvers["double layer"] = dice.choice(["auto", "assembled", "matrix-free"])
        solvers["frozen operator"] = dice.choice(["nodal", "assembled"])
        if tube:
            solvers["tube"] = dice.choice(["schur", "schur", "block triangular", "block diagonal"])
    return solvers


def _output(dice, time, adapted):
    output = {"wall-clock limit": WALL_CLOCK}
    if dice.random() < 0.5:
        output["interval"] = time["final time"] / dice.choice([1, 3, 7])
    if not adapted and dice.random() < 0.3:
        output["between steps"] = dice.choice(["land", "interpolate"])
    output["surface text"] = dice.random() < 0.3
    return output


def _scene(seed):
    """A deck that is legal."""
    dice = random.Random(seed)
    kind, tube = _kind(dice), dice.random() < 0.25
    rigid = kind in ("free", "prescribed")
    unit = 1.0 if tube else dice.choice([1.0, 1.0, 1e-6, 40.0])
    flow = _flow(dice, kind, tube, unit)
    particle, size = _particle(dice, kind, tube, unit)
    speed = _speed(flow, size)
    deck = {"Flow": flow, "Particle": particle, "Surface": _surface(dice)}
    if tube:
        deck["Tube"] = {"section": dice.choice(["circle", "ellipse", "rectangle"]), "azimuthal elements": dice.choice([8, 12]), "axial elements": 8}
        deck["Tube"].update({"circle": {"radius": 1.3}, "ellipse": {"semi-axes": [1.5, 1.2]}, "rectangle": {"sides": [2.8, 2.5]}}[deck["Tube"]["section"]])
    period = size / speed if speed else 1.0
    if not rigid:
        deck["Membrane"], stiffness = _membrane(dice, kind, flow, size, speed)
        _load_that_the_poles_have(deck["Membrane"], deck["Surface"])
        if not speed:
            period = 5 * flow.get("viscosity", 1) * size / stiffness
        deck["Volume"] = {"constraint": dice.choice(["exact", "exact", "exact", "flux"])}
        if kind == "drop" or dice.random() < 0.2:
            deck["Membrane"]["load measure"] = "current"
        if kind == "drop" and dice.random() < 0.5:
            deck["Interface"] = {"motion": dice.choice(["material", "normal", "relaxed"]), "relaxation": dice.choice([0.5, 1.0, 3.0])}
    deck["Quadrature"] = _quadrature(dice, tube, deck["Surface"])
    deck["Time"] = _time(dice, period)
    if not rigid and dice.random() < 0.2 and "load" not in deck["Membrane"] and "fixed step" not in deck["Time"]:
        deck["Adaptation"] = _adaptation(dice)
    if dice.random() < 0.3:
        deck["Symmetry"] = {"use": dice.choice(["auto", "none"])}
    deck["Solvers"] = _solvers(dice, kind, tube)
    deck["Output"] = _output(dice, deck["Time"], "Adaptation" in deck)
    return {"Tanktread": deck}


def _text(seed):
    return yaml.safe_dump(_scene(seed), sort_keys=False, default_flow_style=None, width=1000)


def _series(directory):
    with h5py.File(pathlib.Path(directory) / "run.h5", "r") as file:
        return {name: values[:] for name, values in file["series"].items()}


def _broken_physics(deck, series):
    """What is wrong with the series of a run, or nothing."""
    wrong = [f"{name} is not finite" for name, values in series.items()
             if numpy.isinf(values).any() or (name not in MAY_BE_UNDEFINED and numpy.isnan(values).any())]
    if deck.get("Volume", {}).get("constraint") == "exact" and abs(series["volume_error"]).max() > 1e-10:
        wrong.append(f"the volume is off by {abs(series['volume_error']).max():.1e}")
    for name in "taylor_inertia", "taylor_surface":
        if name in series and not (numpy.all(series[name] > -1e-12) and numpy.all(series[name] < 1)):
            wrong.append(f"{name} is not between 0 and 1")
    if "energy" in series and deck["Flow"]["type"] in ("quiescent", "uniform") and "load" not in deck["Membrane"]:
        energy, modulus = series["energy"], deck["Membrane"].get("shear modulus", 0)
        rise = float(numpy.max(numpy.maximum.accumulate(energy[::-1])[::-1] - energy, initial=0))
        # Errors of steps and rules in place, over R_C, and what energy they store: like their square in a membrane at rest.
        off = 10 * (deck["Time"]["tolerance"] + deck["Quadrature"].get("tolerance", 1e-3))
        allowed = off * energy.max() + off ** 2 * modulus * series["area"][0]
        if rise > allowed:
            wrong.append(f"the energy rises by {rise:.2e} of {energy.max():.2e} in a fluid at rest, allowed {allowed:.2e}")
    return "; ".join(wrong)


def _verdict(seed, directory):
    """None, or a sentence about what is wrong with the run of this seed."""
    tree = _scene(seed)
    path = pathlib.Path(directory) / f"scene_{seed}.yaml"
    path.write_text(_text(seed))
    out = path.with_suffix("")
    words = [str(PROGRAM), str(path), "--output", str(out), "--overwrite", "--quiet"]
    try:
        result = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return f"hangs: no end after {PATIENCE} s"
    said = (result.stdout + result.stderr).strip()
    foreign = [word for word in FOREIGN if word in said]
    if result.returncode not in (0, 3, 4):
        return f"exit code {result.returncode}: {said[-600:]}"
    if foreign:
        return f"text of a library ({foreign[0]}), exit code {result.returncode}: {said[-600:]}"
    steady = tree["Tanktread"]["Particle"].get("motion") == "prescribed"
    if result.returncode == 3 and not steady and not list(out.glob("snapshot_*.hdf")):
        return f"exit code 3 without a checkpoint: {said[-600:]}"
    if not (out / "run.h5").exists():
        return None if result.returncode == 3 else "no run.h5"
    return _broken_physics(tree["Tanktread"], _series(out)) or None


def a_dozen_random_scenes_end_well():
    for seed in range(12):
        wrong = _verdict(seed, ".")
        check(wrong is None, f"seed {seed}: {wrong}\n{_text(seed)}")


def _option(name, default):
    return int(sys.argv[sys.argv.index(name) + 1]) if name in sys.argv else default


def _many():
    first, count = _option("--first", 0), _option("--count", 0)
    failed = 0
    with tempfile.TemporaryDirectory(prefix="tanktread-") as directory, concurrent.futures.ThreadPoolExecutor(_option("--jobs", 1)) as pool:
        seeds = range(first, first + count)
        for seed, wrong in zip(seeds, pool.map(lambda seed: _verdict(seed, directory), seeds)):
            subprocess.run(["rm", "-rf", str(pathlib.Path(directory) / f"scene_{seed}")], check=True)
            if wrong:
                failed += 1
                print(f"seed {seed}: {wrong}\n{_text(seed)}", flush=True)
    print(f"{count - failed} of {count} scenes end well")
    sys.exit(1 if failed else 0)


_many() if "--count" in sys.argv else main()
