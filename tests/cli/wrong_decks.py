#!/usr/bin/python3
# Tests that a mistake in the deck or on the command line gives one sentence and exit code 2, and that no files are
# left.
import math
import os
import pathlib
import re
import shutil

from harness import SOURCE, check, deck, main, refused, run

GOOD = """Tanktread:
  Flow: {type: simple shear}
  Membrane: {law: neo-Hookean, capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.01}
"""

# (settings added to the valid deck, words that the message must contain: path, rule, value; number of mistakes, if not one)
SETTINGS = [
    # unknown keys; the message suggests a key
    (["Flow/shaer rate=1"], ["Flow/shaer rate", "not a key", "Flow/shear rate"]),
    (["Flwo/type=linear"], ["Flwo", "not a key", "Flow"]),
    (["Membrane/Capillary Number=0.3"], ["Membrane/Capillary Number", "Membrane/capillary number"]),
    (["Membrane/viscosity ratio=1"], ["Membrane/viscosity ratio", "Particle/viscosity ratio"]),
    (["Time/end=3"], ["Time/end", "not a key", "final time"]),
    (["Expect/energy/value=1", "Expect/energy/tolerance=1", "Expect/energy/tol=1"], ["Expect/energy/tol", "not a key"]),
    (["Zebra/stripes=1"], ["Zebra", "not a key", "Flow"]),
    (["Time/dt=0.1"], ["Time/dt", "Time/fixed step", "Time/initial step"]),
    (["Time/end time=3"], ["Time/end time", "was Time/final time meant?"]),
    (["Membrane/viscosity=1"], ["Membrane/viscosity", "Membrane/shear viscosity meant"]),
    (["Wall/position=1"], ["Wall/position", "not a key"]),
    (["Particles/one/radius=1"], ["Membrane and Particles contradict", "Particles/defaults"]),
    (["Steady/tolerance=1e-8", "Particle/shape=spheroid", "Particle/semi-axes=[1, 1, 0.5]"], ["Steady", "simple shear", "treads"]),
    (["Continuation/to=1", "Continuation/parameter=Membrane/capillary number"], ["Continuation", "Steady"]),
    (["Solvers/rigid bodies=third kind"], ["Solvers/rigid bodies", "first kind"]),
    (["Solvers/rigid bodies=first kind"], ["Solvers/rigid bodies", "Particle deforms"]),
    (["Contact/limit=0.01"], ["Contact needs Particles or Domain"]),
    (["Periodic/turn=180"], ["Periodic/period", "missing"]),
    (["Steady/method=bisection"], ["Steady/method", "anderson", "bisection"]),
    (["Spectrum/number=4", "Particle/motion=prescribed"], ["Spectrum", "Particle/motion", "motion of the body is given"], 2),  # and Membrane
    (["Spectrum/number=4", "Volume/constraint=flux"], ["Spectrum", "Volume/constraint", "flux"]),
    (["Spectrum/near=-1", "Spectrum/method=krylov"], ["Spectrum/near", "Spectrum/method `krylov`", "Spectrum/shift"]),
    (["Spectrum/number=0"], ["Spectrum/number", "0"]),
    (["Flow/gravity=[0, -1]"], ["Flow/gravity", "three numbers"]),
    (["Particle/density=1.1"], ["Particle/density", "density difference"]),
    (["Particle/density difference=0.1"], ["Particle/density difference", "Flow/gravity"]),
    (["Particle/force=[1, 0, 0]"], ["Particle/force", "free"]),
    (["Adaptation/film resolution=0.5"], ["Adaptation/film resolution", "several"]),
    (["Domain/periodic=true"], ["Domain", "periodic"]),
    (["Zebra/stripes=1"], ["Tube"]),
    # values that are not among the choices
    (["Surface/axial elements=8"], ["Surface/axial elements", "`cylinder`"]),
    (["Surface/mesh=icosahedron"], ["Surface/mesh", "cube", "icosahedron"]),
    (["Flow/type=waterfall"], ["Flow/type", "simple shear", "waterfall"]),
    (["Particle/motion=backwards"], ["Particle/motion", "deforming", "backwards"]),
    (["Particle/viscosity ratio=-1"], ["Particle/viscosity ratio", "-1"]),
    # wrong types
    (['Flow/viscosity="1"'], ["Flow/viscosity", "a number", '"1"']),
    (["Flow/shear rate=fast"], ["Flow/shear rate", "a number", "1/time", "fast"]),
    (["Surface/elements per side=6.5"], ["Surface/elements per side", "whole number", "6.5"]),
    (["Units/length=1 um", "Particle/radius=[2 um, 3 um]"], ["Particle/radius", "a number", "2 um"]),
    (["Particle/center=1"], ["Particle/center", "three numbers", "1"]),
    (["Particle/center=[0, 1]"], ["Particle/center", "three numbers", "[0, 1]"]),
    (["Flow/viscosity=0,5"], ["Flow/viscosity", '"0,5"', "write 0.5"]),
    (["Flow/viscosity=1,000"], ["Flow/viscosity", "write 1.000 or 1000"]),
    (["Flow/viscosity=−5"], ["Flow/viscosity", "write -5"]),
    (["Surface/elements per side=6,0"], ["Surface/elements per side", "write 6.0"]),
    (["Particle/center=[0,5, 1,0, 2,05]"], ["Particle/center", "write [0.5, 1.0, 2.05]"]),
    (["Particle/center=[0,5,1,0,2,5]"], ["Particle/center", "[0.5, 1.0, 1.5]"]),
    (["Particle/center=[0,5, 1, 2]"], ["Particle/center", "[0.5, 1.0, 1.5]"]),
    (["Time/final time=10 ms"], ["Time/final time", "`Units: {}`"]),
    (["Units/length=1 um", "Membrane/capillary number=5,3e-1"], ["Membrane/capillary number", "write 5.3e-1"]),
    (["Particle/radius=1 000"], ["Particle/radius", "write 1000"]),
    (["Units/length=1 um", "Particle/center=[1 500 um, 0, 0]"], ["Particle/center", "write 1500 um"]),
    (["Units/length=1 um", "Flow/viscosity=ca. 35 mPa s"], ["Flow/viscosity", "write 35 mPa s"]),
    (["Units/length=2,5 um"], ["Units/length", "write 2.5 um"]),
    (["Units/length=1 um", "Particle/center=[0,5 um, 1 um, 2,5 um]"], ["Particle/center", "[0.5, 1.0, 1.5]"]),
    (["Particle/center=1, 2, 3"], ["Particle/center", "three numbers in brackets", "1, 2, 3"]),
    (["Flow/type=linear", "Flow/gradient=[1, 2, 3]"], ["Flow/gradient", "nine numbers", "[1, 2, 3]"]),
    (["Membrane/law=3"], ["Membrane/law", "neo-Hookean", "3"]),
    (["Time/final time/value=3"], ["Time/final time", "a number", "a section of keys"]),
    (["Quadrature/tolerance=nan"], ["Quadrature/tolerance", "a number", "nan"]),
    # values outside the allowed range
    (["Membrane/shear modulus=-1"], ["Membrane/shear modulus", "positive", "force/length", "-1"]),
    (["Membrane/capillary number=0"], ["Membrane/capillary number", "positive", "0"]),
    (["Membrane/law=Hooke"], ["Membrane/law", "Skalak", "Hooke"]),
    (["Membrane/law=expression"], ["Membrane/law `expression` needs Membrane/energy", "I1"]),
    (["Membrane/energy=I1"], ["Membrane/energy", "expression", "neo-Hookean"]),
    (["Membrane/constants/k/value=2"], ["Membrane/constants", "expression", "neo-Hookean"]),
    (["Membrane/law=expression", "Membrane/energy=I1 + * I2"], ["Membrane/energy", "at character 6", "I1 + * I2"]),
    (["Membrane/law=expression", "Membrane/energy=(I1 - 1 + 1/(I2 + 1))*k"], ["Membrane/energy", "`k`", "Membrane/constants"]),
    (["Membrane/law=expression", "Membrane/energy=I1^2/2 + I1"], ["Membrane/energy", "no tension on the unstressed surface", "2"]),
    (["Membrane/law=expression", "Membrane/energy=(I2 - I1)/2"], ["Membrane/energy", "positive moduli", "-1"]),
    (["Membrane/law=expression", "Membrane/energy=I1^1.5 + I1 - I2"], ["Membrane/energy", "not finite", "stretches are 1 and 1"]),
    (["Membrane/law=expression", "Membrane/energy=(I1 - 1 + 1/(I2 + 1))/2", "Membrane/constants/k/value=2"], ["Membrane/energy", "does not use", "`k`"]),
    (["Membrane/law=expression", "Membrane/energy=(I1 - 1 + 1/(I2 + 1))/2", "Membrane/constants/k/size=2"], ["Membrane/constants/k", "value"]),
    (["Membrane/law=expression", "Membrane/energy=I1", "Membrane/area points=1"], ["Membrane/area points", "Skalak", "expression"]),
    (["Membrane/load=strong", "Membrane/global area dilatation=10"], ["Membrane/global area dilatation", "Membrane/load", "strong"]),
    (["Membrane/area difference modulus=1"], ["Membrane/area difference modulus", "Membrane/bending modulus"]),
    (["Membrane/area difference=1.1"], ["Membrane/area difference", "Membrane/area difference modulus"]),
    (["Membrane/law=neo-hookean"], ["Membrane/law", "neo-hookean", "`neo-Hookean`"]),
    (["Particle/radius=0"], ["Particle/radius", "positive", "length", "0"]),
    (["Particle/shape=ellipsoid", "Particle/semi-axes=[1, 1, 0]"], ["Particle/semi-axes", "positive", "[1, 1, 0]"]),
    (["Time/final time=-1"], ["Time/final time", "positive", "-1"]),
    (["Time/scheme=euler"], ["Time/scheme", "tr-bdf2", "euler"]),
    (["Quadrature/tolerance=2"], ["Quadrature/tolerance", "between", "2"]),
    (["Surface/elements per side=2"], ["Surface/elements per side", "between 3 and 200", "2"]),
    (["Surface/elements per side=1000000000"], ["Surface/elements per side", "between 3 and 200", "1000000000"]),
    (["Surface/elements per side=150", "Solvers/frozen operator=assembled"], ["Surface/elements per side", "150", "GB"]),
    (["Output/wall-clock limit=-5"], ["Output/wall-clock limit", "positive", "seconds", "-5"]),
    (["Adaptation/enabled=true", "Adaptation/minimum length=0.6"], ["Adaptation/minimum length", "below", "0.482", "0.6"]),
    (["Adaptation/enabled=true", "Adaptation/largest number of points=56"], ["Adaptation/largest number of points", "above", "56"]),
    # values too large or too small for floating-point arithmetic
    (["Particle/radius=1e300"], ["Particle/radius", "between 1e-75 and 1e75", "1e+300"]),
    (["Flow/shear rate=1e-300"], ["Flow/shear rate", "between 1e-75 and 1e75", "1e-300"]),
    (["Particle/center=[0, 0, 1e300]"], ["Particle/center", "between 1e-75 and 1e75", "1.0e+300"]),
    # contradictory keys
    (["Adaptation/enabled=true", "Adaptation/reference traction variation=8"], ["reference traction variation", "`variation`", "`error`"]),
    (["Adaptation/enabled=true", "Adaptation/indicator=variation", "Adaptation/load tolerance=8"], ["Adaptation/load tolerance", "`error`"]),
    (["Particle/shape=file"], ["Particle/shape", "Surface", "contradict"]),
    (["Particle/file=a.iga"], ["Particle/file", "contradict", "sphere"]),
    (["Particle/motion=free"], ["Membrane", "Particle/motion", "free", "contradict", "rigid"]),
    (["Particle/motion=prescribed"], ["Membrane", "Particle/motion", "prescribed", "contradict", "rigid"]),
    (["Particle/velocity=[1, 0, 0]"], ["Particle/velocity", "prescribed", "deforming"]),
    (["Particle/forces=integral"], ["Particle/forces", "deforming", "prescribed motion"]),
    (["Particle/forces=integral", "Particle/motion=prescribed", "Output/power balance=true"],
     ["Particle/forces", "Output/power balance", "coupled system"], 2),  # and Membrane
    (["Output/power balance=true", "Flow/type=parabolic", "Flow/profile=plane", "Flow/maximum velocity=1", "Flow/half width=5",
      "Wall/point=[0, 0, -5]", "Domain/periodic=x1 x2", "Domain/side lengths=[4, 4, 1]"],
     ["Output/power balance", "parabolic", "between two plates"]),
    (["Particle/motion=falling"], ["Particle/motion", "deforming", "prescribed", "free", "falling"]),
    (["Membrane/shear modulus=1"], ["Membrane/capillary number", "Membrane/shear modulus", "contradict"]),
    (["Interface/surfactant/elasticity number=0.2", "Time/scheme=rkc2"], ["Interface/surfactant", "neo-Hookean", "drop"]),
    (["Interface/surfactant/elasticity number=0", "Membrane/law=surface tension"], ["Interface/surfactant/elasticity number", "positive", "0"]),
    (["Interface/surfactant/elasticity number=1.2", "Membrane/law=surface tension", "Time/scheme=rkc2"],
     ["Interface/surfactant/elasticity number 1.2", "no surface tension", "-0.2"]),
    (["Interface/surfactant/coverage=0.5", "Membrane/law=surface tension", "Time/scheme=rkc2"], ["coverage", "Langmuir", "linear"]),
    (["Interface/surfactant/equation of state=Langmuir", "Membrane/law=surface tension", "Time/scheme=rkc2"],
     ["Interface/surfactant/equation of state `Langmuir`", "coverage"]),
    (["Interface/surfactant/diffusivity=1", "Interface/surfactant/Peclet number=1", "Membrane/law=surface tension", "Time/scheme=rkc2"],
     ["Interface/surfactant/diffusivity", "Peclet number", "contradict"]),
    (["Membrane/area dilatation=2"], ["Membrane/area dilatation", "Skalak", "neo-Hookean"]),
    (["Particle/semi-axes=[1, 1, 2]"], ["Particle/semi-axes", "sphere", "contradict"]),
    (["Particle/shape=spheroid"], ["spheroid", "needs", "Particle/semi-axes"]),
    (["Particle/shape=spheroid", "Particle/semi-axes=[1, 2, 3]"], ["Particle/semi-axes", "spheroid", "two equal"]),
    (["Flow/type=quiescent"], ["Membrane/capillary number", "gradient"]),
    (["Flow/type=four-roll"], ["four-roll", "Flow/roll parameter"]),
    (["Flow/type=parabolic", "Output/power balance=true"], ["parabolic", "Flow/half width"]),
    (["Flow/type=linear", "Flow/gradient=[1, 0, 0, 0, 1, 0, 0, 0, 1]"], ["Flow/gradient", "trace", "3"]),
    (["Flow/type=linear", "Flow/gradient=[1, 0, 0, 0, 1, 0, 0, 0, -2.00000001]"], ["Flow/gradient", "trace", "-1e-08"]),
    (["Domain/periodic=x1", "Domain/side lengths=[4.0, 1.0, 1.0]", "Membrane/law=neo-Hookean", "Membrane/forces/pull/force=[1, 0, 0]", "Membrane/forces/pull/direction=[1, 0, 0]",
      "Membrane/forces/pull/radius=0.5"],
     ["Membrane/forces", "net force"]),
    (["Flow/history/type=sine", "Flow/history/frequency=1", "Flow/history/axis=x3"], ["Flow/history/axis", "`table`", "sine"]),
    (["Volume/constraint=none"], ["Volume/constraint", "none", "Membrane/load measure"]),
    (["Time/fixed step=0.1", "Time/initial step=0.1"], ["Time/fixed step", "Time/initial step", "contradict"]),
    (["Time/initial step=1e-12"], ["Time/initial step", "Time/minimum step", "1e-09", "1e-12"]),
    (["Output/interval=0.01", "Output/between steps=interpolate", "Time/minimum step=0.02"], ["Output/interval", "Time/minimum step"]),
    (["Time/maximum step=0.1", "Time/minimum step=0.2"], ["Time/maximum step", "Time/minimum step", "0.2", "0.1"]),
    (["Expect/energy/value=1"], ["Expect/energy/tolerance", "missing"]),
    (["Expect/volum/value=1", "Expect/volum/tolerance=1"], ["Expect/volum", "no series", "was volume meant?"]),
    (["Expect/V/series=volum", "Expect/V/value=1", "Expect/V/tolerance=1"], ["Expect/V/series", "no series volum", "was volume meant?"]),
    # values that rounding errors make unsolvable
    (["Particle/viscosity ratio=1e9"], ["Particle/viscosity ratio", "at most 1e+06", "Solvers/tolerance", "1e+09", "Particle/motion `free`"]),
    # parameters that Trilinos packages do not accept
    (["Solvers/iterative solver=Foo"], ["Solvers/iterative solver", "GMRES", "Foo"]),
    (["Solvers/iterative solver=Hybrid Block GMRES"], ["Solvers/iterative solver", "BICGSTAB", "Hybrid Block GMRES"]),
    (["Solvers/iterative solver=Seed GMRES"], ["Solvers/iterative solver", "Seed GMRES"]),
    (["Solvers/Belos/Num Blocks=2000000000"], ["Solvers/Belos/Num Blocks", "at most", "4 GB", "2000000000"]),
    (["Solvers/velocity/iterative solver=Foo"], ["Solvers/velocity/iterative solver", "GMRES", "Foo"]),
    (["Solvers/implicit step/preconditioner=Foo"], ["Solvers/implicit step/preconditioner", "recycled", "Foo"]),
    (["Solvers/traction/Belos/Orthogonalization=Foo"], ["Solvers/traction/Belos/Orthogonalization", "Foo"]),
    (["Solvers/velocity/Belos/Num Blocks=2000000000"], ["Solvers/velocity/Belos/Num Blocks", "at most", "4 GB", "2000000000"]),
    (["Solvers/Belos/Num Blocks=-1"], ["Solvers/Belos/Num Blocks", "-1"]),
    (["Solvers/Belos/Orthogonalization=Foo"], ["Solvers/Belos/Orthogonalization", "Foo"]),
    (["Time/nonlinear solver=newton-krylov", "Solvers/NOX/Nonlinear Solver=Foo"], ["Solvers/NOX/Nonlinear Solver", "Foo"]),
    (["Time/nonlinear solver=newton-krylov", "Solvers/NOX/Direction/Method=Foo"], ["Solvers/NOX/Direction/Method", "Foo"]),
    (["Time/nonlinear solver=newton-krylov", "Solvers/NOX/Linesearch/Method=Backtrack"], ["Solvers/NOX/Linesearch/Method", "not a parameter"]),
    (["Time/nonlinear solver=anderson", "Solvers/NOX/Anderson Parameters/Storage Depht=2"], ["Solvers/NOX/Anderson Parameters/Storage Depht"]),
    (["Solvers/direct solver=Foo"], ["Solvers/direct solver", "Foo", "KLU2"]),
    (["Solvers/Belos/Maximum Iteration=30"], ["Solvers/Belos/Maximum Iteration", "was Solvers/Belos/Maximum Iterations meant?"]),
    (["Solvers/Belos/Maximum Iterations=many"], ["Solvers/Belos/Maximum Iterations", "whole number", "many"]),
    (["Solvers/Amesos2/Foo=1"], ["Solvers/Amesos2/Foo", "not a parameter"]),
    # output parameters of Belos, which the program sets itself
    (["Solvers/Belos/Verbosity=30"], ["Solvers/Belos/Verbosity", "cannot be set"]),
    (["Solvers/Belos/Num Blocks=30", "Solvers/Belos/Output Style=0"], ["Solvers/Belos/Output Style", "cannot be set"]),
    (["Solvers/iterative solver=GCRODR", "Solvers/Belos/Output Frequency=-1"], ["Solvers/Belos/Output Frequency", "cannot be set"]),
    # numbers instead of sections and sections instead of numbers, in the sections of Trilinos packages
    (["Solvers/Belos/Num Blocks/Verbosity=1"], ["Solvers/Belos/Num Blocks must be a whole number", "a section of keys"]),
    (["Solvers/Belos/Orthogonalization/Foo/Bar=1"], ["Solvers/Belos/Orthogonalization must be text", "a section of keys"]),
    (["Solvers/Belos/Output Stream/Foo=1"], ["Solvers/Belos/Output Stream", "a deck cannot contain"]),
    (["Solvers/Amesos2/Transpose/Foo=1"], ["Solvers/Amesos2/Transpose must be true or false", "a section of keys"]),
    (["Solvers/Belos=1"], ["Solvers/Belos must be a section of keys", "1"]),
    (["Time/nonlinear solver=newton-krylov", "Solvers/NOX/Nonlinear Solver/Foo=1"], ["Solvers/NOX/Nonlinear Solver", "cannot solve"]),
    (["Time/nonlinear solver=newton-krylov", "Solvers/NOX/Direction=1"], ["Solvers/NOX/Direction, which is 1", "cannot solve"]),
    (["Time/nonlinear solver=anderson", "Solvers/NOX/Anderson Parameters/Storage Depth/Foo=1"], ["Solvers/NOX/Anderson Parameters/Storage Depth"]),
    # not of the form Section/key=value
    (["Flow/viscosity"], ["Flow/viscosity", "Section/key=value"]),
    (["viscosity=1"], ["viscosity=1", "Section/key=value"]),
    (["Flow/viscosity=[1"], ["Flow/viscosity=[1", "not valid YAML"]),
    (["Flow/viscosity=1\nFlow: 2"], ["Section/key=value"]),
    (["Flow/shaer rate = 1"], ["Flow/shaer rate is not a key"]),
]

# (text of the deck, words that the message must contain)
TEXTS = [
    ("", ["empty", "Tanktread"]),
    ("Tanktread:\n  Flow: {type: simple shear}\n", ["Time/final time", "missing"]),
    ("Tanktread:\n  Particles:\n    - radius: 1\n    - radius: 2\n", ["line 3", "Particles"]),
    ("Tanktread:\n  Flow: {type: uniform}\n  Time:\n    final time:\n", ["Time/final time", "is nothing"]),
    ("Tanktread:\n  Flow: {type: simple shear}\n  Membrane: {capillary number: 0.3, load: strong}\n"
     "  Surface: {mesh: polar, azimuthal elements: 8, meridional elements: 4, poles: plain}\n  Time: {final time: 1}\n",
     ["Membrane/load", "Surface/poles", "contradict"]),
    ("Tanktread:\n  Flow: {type: quiescent, shear rate: 2}\n  Membrane: {shear modulus: 1}\n  Time: {final time: 1}\n",
     ["Flow/shear rate", "quiescent", "no rate"]),
    ("# only a comment\n", ["empty", "Tanktread"]),
    ("Dear reader,\nthis is a letter.\n", ["not valid YAML", "Dear reader,"]),
    ("<html><body>404</body></html>\n", ["not valid YAML", "line 1"]),
    ("Tanktread:\n  Flow: {type: simple shear\n", ["not valid YAML", "line 2"]),
    ("Tanktread:\n  Flow:\n    type: uniform\n    type: linear\n", ["line 4", "Flow/type", "set twice", "line 3"]),
    ("Tanktread:\n  Flow: {type: uniform, type: linear}\n", ["line 2", "Flow/type", "set twice"]),
    ("Tanktread:\n  Units: {}\n  Flow: {viscosity: 5,3 mPa s, type: simple shear}\n", ["line 3", "Flow/viscosity", "write 5.3 mPa s"]),
    ("Tanktread:\n  Particle: {radius: 0,5}\n", ["line 2", "Particle/radius", "write 0.5"]),
    ("Tanktread:\n  Particle:\n    center:\n      - 0,5\n      - 1,0\n      - 2\n", ["Particle/center", "write 0.5"]),
    ("Tanktread: {}\n---\nTanktread: {}\n", ["line 2", "second document"]),
    ("Tanktread: &a {Flow: *a}\n", ["nested more than"]),
    ("Tanktread:\n  Flow:\n    type: uniform\n   viscosity: 1\n", ["line 4", "indentation"]),
    ("Tanktread:\n\tFlow: {}\n", ["line 2", "tabs"]),
    ("Flow:\n  type: uniform\n", ["Tanktread", "Flow"]),
    ("Tanktread:\n  Flow: {}\nMembrane: {}\n", ["Tanktread", "Membrane"]),
    ("Tanktread: 7\n", ["Tanktread"]),
    ("Tanktread:\n  Flow: 7\n", ["Flow", "section of keys", "7"]),
    ("Tanktread:\n  Membrane:\n    - law: Skalak\n    - law: Skalak\n", ["line 3", "Membrane", "sequence"]),
    ("Tanktread:\n  Flow: {type: \x07}\n", ["line 2", "not text"]),
]


def _tube(outline):
    return deck("Tanktread:\n  Flow: {type: duct}\n  Particle: {radius: 0.5}\n  Membrane: {law: neo-Hookean, shear modulus: 1}\n"
                f"  Tube: {{section: file, outline: {outline}, length: 6}}\n  Time: {{final time: 1}}\n", "tube.yaml")


def _imported(file):
    return deck("Tanktread:\n  Flow: {type: simple shear}\n  Membrane: {law: neo-Hookean, shear modulus: 1}\n"
                f"  Particle: {{shape: file, file: {file}}}\n  Time: {{final time: 1}}\n", "imported.yaml")


def wrong_settings_are_rejected():
    path = deck(GOOD)
    check(len(SETTINGS) + len(TEXTS) >= 30, "fewer than thirty wrong decks")
    for settings, words, *mistakes in SETTINGS:
        refused(words, path, *[word for setting in settings for word in ("--set", setting)], mistakes=(*mistakes, 1)[0])


def all_mistakes_are_reported_together():
    """One line per mistake: wrong values, unknown keys, a section with a value. When these are corrected, contradictions are reported."""
    def told(*settings):
        lines = run(deck(GOOD), *[word for setting in settings for word in ("--set", setting)], "--output", "refused", code=2).stderr.splitlines()
        check(all(line.startswith("tanktread: ") and line.endswith((".", "?")) for line in lines), lines)
        return lines

    lines = told("Flow/shaer rate=1", "Membrane/law=rubber", "Particle/radius=-1", "Zebra/stripes=1", "Flow/history=3")
    for word in ("Flow/shaer rate is not a key", "Membrane/law must be", "Particle/radius must be", "Zebra is not a key", "Flow/history must be a section of keys"):
        check(sum(word in line for line in lines) == 1, word, lines)
    check(len(lines) == 5, lines)
    lines = told("Volume/constraint=none", "Membrane/load measure=reference", "Particle/motion=free", "Particle/viscosity ratio=2")
    for word in ("Membrane and Particle/motion", "Volume and Particle/motion", "Particle/viscosity ratio and Particle/motion"):
        check(any(word in line for line in lines), word, lines)
    shared = GOOD.replace("  Membrane: {law: neo-Hookean, capillary number: 0.3}\n  Surface: {elements per side: 3}\n",
                          "  Particles: {defaults: {radius: -1, colour: 3}, one: {}, two: {center: [4, 0, 0]}, three: {like: two}}\n")
    lines = run(deck(shared), "--output", "refused", code=2).stderr.splitlines()
    check(len(lines) == 2 and "radius" in lines[0] and "colour" in lines[1], lines)
    several = GOOD.replace("  Membrane: {law: neo-Hookean, capillary number: 0.3}\n  Surface: {elements per side: 3}\n",
                           "  Particles: {one: {radius: -1, Membrane: {law: rubber}}, two: {center: [4, 0, 0], shape: cube}}\n")
    lines = run(deck(several), "--output", "refused", code=2).stderr.splitlines()
    check(len(lines) == 3 and all("Particles/" in line for line in lines), lines)
    for name in "../one", "one=1":
        refused([f"Particles/{name}", "name"], deck(shared.replace("radius: -1, colour: 3", "").replace("one:", f"'{name}':")))


def solvers_and_their_parameters_are_tested_before_a_run():
    for settings, words, *_ in [entry for entry in SETTINGS if "Solvers/" in entry[0][-1]]:
        refused(words, deck(GOOD), "--check", *[word for setting in settings for word in ("--set", setting)])
    for settings in (["Solvers/iterative solver=BICGSTAB"], ["Solvers/Belos/Num Blocks=30", "Solvers/Belos/Orthogonalization=ICGS"],
                     ["Solvers/direct solver=KLU2"], ["Time/scheme=crank-nicolson", "Time/nonlinear solver=newton-krylov", "Solvers/NOX/Line Search/Method=Backtrack"],
                     ["Time/scheme=crank-nicolson", "Time/nonlinear solver=anderson", "Solvers/NOX/Anderson Parameters/Storage Depth=2"]):
        run(deck(GOOD), *[word for setting in settings for word in ("--set", setting)], "--quiet", "--output", "good", "--overwrite")


def suggested_keys_exist():
    manual, section, keys = (SOURCE / "inputs/REFERENCE.md").read_text(), "", set()
    for line in manual.splitlines():
        section = line[3:] if line.startswith("## ") else section
        if match := re.match(r"\| `([^`]+)` \|", line):
            keys.add(f"{section}/{match[1]}")
    names = [name for line in (SOURCE / "lib/deck/synonyms.cpp").read_text().splitlines() for name in re.findall(r'"\|([^"]+)\|"', line)]
    check(len(names) > 30, names)
    for name in (names[0] for names in (line.split("|") for line in names)):
        said = run(deck(GOOD), "--set", f"{'' if '/' in name else 'Output/'}{name}=1", code=2).stderr
        for key in re.findall(r"(?:was| or) ([A-Z][a-z]+/[a-z -]+?)(?= meant| or)", said):
            check(key in keys, f"no key {key} of: {said}")
        check("not available" in said or "cannot be chosen" in said or "meant?" in said, said)


def wrong_deck_texts_are_rejected():
    for text, words in TEXTS:
        refused(words, deck(text))


def wrong_files_are_rejected():
    refused(["missing.yaml", "does not exist"], "missing.yaml")
    refused(["Time/final time=3", "does not exist", "--set of its own"], "Time/final time=3")
    os.mkdir("folder.yaml")
    refused(["folder.yaml", "directory"], "folder.yaml")
    pathlib.Path("latin.yaml").write_bytes(GOOD.encode() + "  Expect: {area: {value: 1, tolerance: 99, source: Müller}}\n".encode("latin-1"))
    refused(["latin.yaml, line 6", "UTF-8"], "latin.yaml")
    pathlib.Path("binary.yaml").write_bytes(bytes(range(256)))
    refused(["binary.yaml", "not text"], "binary.yaml")
    refused(["/dev/zero", "not a regular file"], "/dev/zero")
    os.mkfifo("pipe")
    refused(["pipe", "not a regular file"], "pipe")
    refused(["Tube/outline", "not a regular file"], _tube("pipe"))
    refused(["Surface file pipe", "not a regular file"], _imported("pipe"))
    refused(["too long"], "x" * 300)
    for name in "x" * 300, "x/" * 3000:
        refused(["Tube/outline", "too long"], _tube(name))
        refused(["Surface file", "too long"], _imported(name))
        for key, said in ("Particle/initial shape/file", "Surface file"), ("Particle/initial shape/run",) * 2, ("Flow/history/file",) * 2:
            section, inner, last = key.split("/")
            refused([said, "too long"], deck(GOOD), deck(f"Tanktread: {{{section}: {{{inner}: {{{last}: {name}}}}}}}\n", "naming.yaml"))
    said = run(deck(GOOD), "--output", "x" * 300, code=2).stderr
    check(len(said.splitlines()) == 1 and "too long" in said and "filesystem" not in said, said)
    refused(["deep.xml", "nested more than"], deck('<ParameterList name="Tanktread">' * 20000 + "</ParameterList>" * 20000, "deep.xml"))
    refused(["deep.yaml", "nested more than"], deck("Tanktread: " + "{a: " * 100000, "deep.yaml"))
    refused(["broken.xml", "not XML"], deck("<ParameterList", "broken.xml"))
    refused(["overlay.yaml", "not valid YAML"], deck(GOOD), deck("What else\n", "overlay.yaml"))
    if os.geteuid() != 0:
        deck(GOOD, "locked.yaml").chmod(0)
        refused(["locked.yaml", "cannot be read"], "locked.yaml")


def wrong_command_lines_are_rejected():
    refused(["No deck", "--help"])
    refused(["--colour"], deck(GOOD), "--colour")
    check("--set" in run(deck(GOOD), "--set", code=2).stderr, "a setting without a value")
    refused(["--output", "--check", "directory"], deck(GOOD), "--output", "--check")
    refused(["--resume", "--check", "directory"], "--resume", "--check")
    refused(["--output", "--resume", "contradict"], "--resume", "nowhere")
    for arguments in (["--resume", "nowhere"], ["--resume", "nowhere", "--set", "Time/final time=2"]):
        result = run(*arguments, code=2)
        check(len(result.stderr.splitlines()) == 1 and "nowhere" in result.stderr and "checkpoint" in result.stderr, result.stderr)
        check(not pathlib.Path("nowhere").exists(), "a directory was made")


def several_ranks_print_one_message():
    result = run(deck(GOOD), "--set", "Flow/shaer rate=1", ranks=2, code=None)
    lines = [line for line in result.stderr.splitlines() if line.startswith("tanktread:")]
    check(result.returncode == 2, f"exit code {result.returncode}")
    check(len(lines) == 1, result.stderr)


def keys_without_effect_are_named():
    said = run(deck(GOOD), "--set", "Flow/gravity=[0, 0, -1]", "--check").stderr
    check("Flow/gravity has no effect without Particle/density difference" in said, said)
    said = run(deck(GOOD), "--set", "Solvers/tube=block", "--set", "Solvers/wall=iterative", "--check").stderr
    check("Solvers/tube has no effect without Tube or Channel: remove the key." in said, said)
    check("Solvers/wall has no effect without Channel: remove the key." in said, said)
    check("no effect" not in run(SOURCE / "inputs/capsule_in_tube.yaml", "--set", "Solvers/tube=block", "--check").stderr, "in a tube")
    said = run(SOURCE / "inputs/settling_spheres.yaml", "--set", "Solvers/volume=multipliers", "--check").stderr
    check("Solvers/volume has no effect on rigid bodies: remove the key." in said, said)
    said = run(deck(GOOD), "--set", "Solvers/volume=multipliers", "--set", "Volume/constraint=none",
               "--set", "Membrane/load measure=current", "--check").stderr
    check("Solvers/volume has no effect with Volume/constraint `none`: remove the key." in said, said)
    said = run(SOURCE / "inputs/posts.yaml", "--set", "Surface/elements per side=7", "--check").stderr
    check("Surface/elements per side has no effect on a particle of the shape" in said, said)


def the_unchanged_deck_is_valid():
    result = run(deck(GOOD), "--check")
    check("capillary number: 0.3" in result.stdout and "final time: 0.01" in result.stdout, result.stdout)


def decks_of_other_editors_and_settings_with_spaces_are_valid():
    for text in ("\ufeff" + GOOD, GOOD.replace("\n", "\r\n")):
        pathlib.Path("other.yaml").write_text(text, encoding="utf-8", newline="")
        result = run("other.yaml", "--set", " Time/final time = 0.02", "--check")
        check("final time: 0.02" in result.stdout, result.stdout)
    outline = "x2, x3\n" + "".join(f"{math.cos(k * math.pi / 6)}, {math.sin(k * math.pi / 6)}\n" for k in range(12))
    pathlib.Path("outline.csv").write_text("\ufeff" + outline, encoding="utf-8")
    run(_tube("outline.csv"), "--check")


def shipped_decks_and_their_effective_decks_are_valid():
    for outline in (SOURCE / "inputs").glob("*.csv"):
        shutil.copy(outline, ".")  # searched for next to the deck
    for path in sorted((SOURCE / "inputs").glob("*.yaml")):
        printed = run(path, "--check", "--quiet").stdout
        effective = printed.split("\n\n", 1)[0] + "\n"
        again = run(deck(effective), "--check", "--quiet").stdout
        check(printed == again, f"{path.name}: the effective deck says something else")


main()
