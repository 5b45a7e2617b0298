#!/usr/bin/python3
# ranks: 2
# Tests that equivalent scenes give the same surface and series: moved, rotated, mirrored, in other units, in a moving
# frame, with reordered control points, with other far sums, on two ranks. metamorphic_all.py does the same for every
# kind of particle.
import pathlib

import numpy

from harness import check, deck, main, run, series

GRADIENT = numpy.array([[0.3, -0.2, 1.0], [0.1, -0.4, 0.2], [-0.3, 0.5, 0.1]])
FRAME = numpy.array([0.7, -1.1, 0.4])  # its velocity
# exponents of length, time and viscosity in the unit of each series
SERIES = {"area": (2, 0, 0), "volume": (3, 0, 0), "energy": (3, -1, 1), "smallest_tension": (0, 0, 0)}
FIXED = "scheme: bs3, fixed step: {step!r}"
AROUND = 8  # azimuthal elements of the tube wall


def _rotation(vector):
    """Returns the rotation matrix of a rotation vector in radians."""
    angle = numpy.linalg.norm(vector)
    x, y, z = vector / angle
    k = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(angle) * k + (1 - numpy.cos(angle)) * k @ k


def _rotation_vector(q):
    """Returns the rotation vector in degrees of a rotation matrix with an angle below 180 degrees."""
    axis = numpy.array([q[2, 1] - q[1, 2], q[0, 2] - q[2, 0], q[1, 0] - q[0, 1]])
    sine = numpy.linalg.norm(axis) / 2
    return numpy.degrees(numpy.arctan2(sine, (numpy.trace(q) - 1) / 2)) * axis / (2 * sine)


def _numbers(values):
    return "[" + ", ".join(repr(float(value)) for value in numpy.ravel(values)) + "]"


class Scene:  # an ellipsoid of a kind (capsule, free, or how the mesh of a drop moves) in a flow (linear, quiescent, uniform, duct)
    """not a test"""

    def __init__(self, kind, ratio=1.0, flow="linear"):
        self.kind, self.ratio, self.flow = kind, ratio, flow
        self.length = self.time = self.viscosity = 1.0
        self.steps_of = 0.05  # unit of time
        self.centre = numpy.array([0.0, 0.1, -0.15]) if flow == "duct" else numpy.zeros(3)
        self.axes = _rotation(numpy.radians([20.0, 35.0, -15.0]))  # columns: directions of the particle's semi-axes
        self.gradient = GRADIENT
        self.file, self.elements, self.far_sum, self.quadrature, self.steps = None, 3, "dense", 1e-4, FIXED

    def but(self, **changes):
        other = Scene.__new__(Scene)
        other.__dict__ = {**self.__dict__, **changes}
        return other

    def turned(self, q, axes):
        return self.but(centre=q @ self.centre, axes=axes, gradient=q @ self.gradient @ q.T)

    def _membrane(self):
        tension = self.viscosity * self.length / self.time
        if self.kind == "free":
            return []
        if self.kind == "capsule":
            bending = f"pre-inflation: 0.05, bending modulus: {0.1 * tension * self.length**2!r}"
            return [f"Membrane: {{law: Skalak, shear modulus: {3 * tension!r}, {bending}}}"]
        return [f"Membrane: {{law: surface tension, surface tension: {5 * tension!r}}}", f"Interface: {{motion: {self.kind}}}"]

    def text(self):
        a, time = self.length, self.time
        flow = {"linear": f"gradient: {_numbers(self.gradient / time)}", "uniform": f"velocity: {_numbers(FRAME * a / time)}",
                "duct": f"mean velocity: {a / time!r}", "quiescent": ""}[self.flow]
        shape = f"shape: ellipsoid, semi-axes: {_numbers(a * numpy.array([1.15, 1.0, 0.85]))}, orientation: {_numbers(_rotation_vector(self.axes))}"
        if self.file:
            shape = f"shape: file, file: {self.file}"
        made_of = "motion: free" if self.kind == "free" else f"viscosity ratio: {self.ratio!r}, drift: free"
        lines = [f"Flow: {{type: {self.flow}, viscosity: {self.viscosity!r}, {flow}}}",
                 f"Particle: {{{shape}, center: {_numbers(self.centre * a)}, {made_of}}}",
                 *self._membrane(),
                 *([] if self.file else [f"Surface: {{elements per side: {self.elements}}}"]),
                 *([f"Tube: {{radius: {1.7 * a!r}, azimuthal elements: {AROUND}, axial elements: 6}}"] if self.flow == "duct" else []),
                 f"Time: {{final time: {2 * self.steps_of * time!r}, {self.steps.format(step=self.steps_of * time)}}}",
                 f"Output: {{interval: {2 * self.steps_of * time!r}, surface text: true}}",
                 f"Quadrature: {{far sum: {self.far_sum}, tolerance: {self.quadrature!r}}}",
                 "Solvers: {tolerance: 1.0e-12}"]
        return "Tanktread:\n" + "".join(f"  {line}\n" for line in lines).replace(", }", "}")

    def result(self, name, ranks=1):
        """Returns the points of the last surface relative to their mean, divided by the length unit of the scene, and
        the last row of the series, divided by their units."""
        import h5py

        run(deck(self.text(), f"{name}.yaml"), "--output", name, "--overwrite", "--quiet", ranks=ranks)
        with h5py.File(sorted(pathlib.Path(name).glob("snapshot_*.hdf"))[-1], "r") as file:
            points = file["VTKHDF/Points"][:] / self.length
        kinds = {} if self.kind == "free" else SERIES
        units = numpy.array([self.length, self.time, self.viscosity])
        return points - points.mean(0), {key: series(name, key)[-1] / numpy.prod(units**powers) for key, powers in kinds.items()}


def _difference(one, other, image=numpy.eye(3)):
    """Returns the largest difference of two results: the distance between the surfaces as sets of points, after the
    first one is rotated by `image`, and the relative differences of the series. The difference of a dimensionless
    series is absolute, because the series may vanish."""
    check(len(one[0]) == len(other[0]), f"{len(one[0])} and {len(other[0])} points")
    between = (one[0] @ image.T)[:, None, :] - other[0][None, :, :]
    apart = numpy.sqrt((between**2).sum(2).min(1).max())
    sizes = {key: abs(other[1][key]) if any(SERIES[key]) else 1 for key in one[1]}
    return max([apart] + [abs(value - other[1][key]) / sizes[key] for key, value in one[1].items()])


def _reordered(file):
    """Returns a copy of an .iga file with its control points in reverse order."""
    lines = pathlib.Path(file).read_text().splitlines()
    n = int(lines[1].split()[1])
    nodes = [i for i, line in enumerate(lines) if line.startswith("node ")]
    copy = list(lines)
    for k, i in enumerate(nodes):
        copy[i] = lines[nodes[n - 1 - k]]
    for i, line in enumerate(lines):
        if line.startswith("belem"):
            copy[i + 1] = " ".join(str(n - 1 - int(word)) for word in lines[i + 1].split())
    result = pathlib.Path("reordered.iga")
    result.write_text("\n".join(copy) + "\n")
    return result


def pairs(scene):
    """not a test"""
    base = scene.result("base")
    yield "ranks", _difference(base, scene.result("two_ranks", ranks=2))
    yield "units", _difference(base, scene.but(length=1.3e-3, time=0.021, viscosity=70.0).result("units"))
    mirror = numpy.diag([1.0, -1.0, 1.0])  # the reflection maps the meshes onto themselves
    yield "mirrored", _difference(base, scene.turned(mirror, mirror @ scene.axes @ mirror).result("mirrored"), mirror)
    q = _rotation(numpy.array([2 * numpy.pi / AROUND, 0, 0]) if scene.flow == "duct" else numpy.array([0.5, -0.9, 0.3]))
    yield "turned", _difference(base, scene.turned(q, q @ scene.axes).result("turned"), q)
    away = numpy.array([7.0, 0, 0] if scene.flow == "duct" else [2.0, -3.0, 5.0])
    yield "moved", _difference(base, scene.but(centre=scene.centre + away).result("moved"))
    if scene.flow == "quiescent":
        yield "frame", _difference(base, scene.but(flow="uniform").result("frame"))
    kept = scene.but(file=pathlib.Path("base/surface.iga").resolve())
    yield "order", _difference(kept.result("kept"), kept.but(file=_reordered(kept.file).resolve()).result("reordered"))


def compare(scenes, tolerance, pairs=pairs):
    """not a test"""
    largest, count = {}, 0
    for scene in scenes:
        for kind, apart in pairs(scene):
            check(apart <= tolerance, f"{scene.kind}, viscosity ratio {scene.ratio}, {scene.flow}, {kind}: {apart:.2e}")
            largest[kind] = max(largest.get(kind, 0), apart)
            count += 1
    print(f"{count} pairs; largest difference of a kind: " + ", ".join(f"{kind} {value:.0e}" for kind, value in largest.items()))


def by_clusters(scene):
    """not a test"""
    # the error of far sums by clusters is controlled by Quadrature/tolerance
    yield "far sum", _difference(scene.result("dense"), scene.but(far_sum="tree").result("tree"))


if __name__ == "__main__":
    def in_a_linear_flow():
        compare([Scene("capsule", 3.0), Scene("relaxed"), Scene("normal"), Scene("free")], 1e-10)

    def without_a_flow():
        compare([Scene("relaxed", 3.0, "quiescent")], 1e-10)

    def in_a_tube():
        compare([Scene("relaxed", 3.0, "duct")], 1e-10)

    def far_sums():
        compare([Scene("relaxed").but(elements=10)], 1e-4, by_clusters)

    main()
