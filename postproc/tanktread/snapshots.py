"""Snapshots of a run: the surfaces and the fields on them at one time, as exact piecewise polynomials."""

import functools
import pathlib

import numpy

from . import lagrange
from .files import opened
from .mistakes import expect, optional

# Dimension of each field with a unit, and of the dimensionless tensions. Run.scale returns the scale of a dimension. A
# field that is missing here is neither scaled nor labelled with its scale.
DIMENSIONS = {"traction": "stress", "load": "stress", "pressure": "stress", "pressure error": "stress",
              "displacement": "length", "position error": "length", "velocity": "velocity", "into cell": "length",
              "smallest tension": "tension", "largest tension": "tension", "mean curvature": "curvature"}


def evenly(items, n):
    """Returns n evenly spaced items of a list, including the first and the last one; all items if there are fewer."""
    return [items[k] for k in sorted(set(numpy.linspace(0, len(items) - 1, min(n, len(items))).round().astype(int)))]


class Snapshot:
    """Surfaces and fields at one time, in the units of the deck. `path`, `time`: the file and the simulated time.
    `cells`: list of the node indices ((p + 1)^2,) of each Lagrange quadrilateral. `points`: positions of the nodes
    (n, 3). `fields`: {name: values at the nodes (n,) or (n, k)}; `DIMENSIONS` holds the dimension of each field. The
    file is read when `cells`, `points` or `fields` is first used."""

    def __init__(self, path, time, particles=("particle",)):
        self.path, self.time, self.particles = pathlib.Path(path), time, list(particles)
        self.cell = None  # vectors of the periodic cell divided by R_C, as rows (3, 3); set by `scaled` for a lattice
        self.origin = numpy.zeros(3)  # middle of this cell
        # Surroundings in pictures, set by figures.scene.surrounded: the posts, a Snapshot without fields; corners
        # (n, 2, 2, 3) of quadrilaterals of the walls, whose normals point into the fluid; lines (m, 3) at their edges
        self.posts, self.walls, self.rims = None, numpy.zeros((0, 2, 2, 3)), []

    @classmethod
    def of(cls, cells):
        """Returns a Snapshot without a file and without fields. `cells` (m, (p + 1)^2, 3): positions of the nodes."""
        made, cells = cls("", 0), numpy.asarray(cells)
        made._content = cells.reshape(-1, 3), list(numpy.arange(cells[..., 0].size).reshape(cells.shape[:2])), {}
        return made

    @functools.cached_property
    def _content(self):
        with opened(self.path) as file:
            grid = file["VTKHDF"]
            cells = numpy.split(grid["Connectivity"][:], grid["Offsets"][1:-1])
            return grid["Points"][:], cells, {name: data[:] for name, data in grid["PointData"].items()}

    points = property(lambda self: self._content[0])
    cells = property(lambda self: self._content[1])
    fields = property(lambda self: self._content[2])

    positions = property(lambda self: self.points + (0 if self.cell is None else self.fields.get("into cell", 0)),
                         doc="Positions of the nodes (n, 3) as they are drawn: `points`, or in a lattice those in the "
                         "cell at the origin.")

    @property
    def frame(self):
        """Points (m, 3) that a picture must contain: `points` or, in a lattice, the eight corners of the cell; and the
        corners of the walls."""
        inside = self.points if self.cell is None else self.corners
        return numpy.concatenate([inside, self.walls.reshape(-1, 3)])

    @property
    def corners(self):
        """The corners (8, 3) of the periodic cell."""
        return self.origin + (numpy.indices((2, 2, 2)).reshape(3, -1).T - 0.5) @ self.cell

    @property
    def edges(self):
        """Lines (m, 2, 3) along the edges of the periodic cell; none without a cell, and in a duct."""
        if self.cell is None or self.rims:
            return numpy.zeros((0, 2, 3))
        return numpy.array([self.corners[[i, i + k]] for k in (1, 2, 4) for i in range(8) if not i & k])

    def cells_of(self, particle):
        """Returns the indices of the cells of one particle. `particle`: its name in `run.particles`."""
        expect(particle in self.particles, f"there is no particle {particle}; there are: {', '.join(self.particles)}")
        if "particle" not in self.fields:
            return numpy.arange(len(self.cells))
        numbers = numpy.array([self.fields["particle"][cell[0]] for cell in self.cells])  # from 1 in the deck's order
        return numpy.flatnonzero(numbers == self.particles.index(particle) + 1)

    def scaled(self, run):
        """Returns a dimensionless copy: lengths are divided by R_C, and each field by its scale (Run.scale)."""
        copy = Snapshot(self.path, self.time, self.particles)
        copy.cell = run.cell(self.time)
        fields = {name: values / run.scale(DIMENSIONS.get(name))[0] for name, values in self.fields.items()}
        copy._content = self.points / run.scale("length")[0], self.cells, fields
        periodic = run.deck["Domain"]["periodic"] if "Domain" in run.deck else "x1"  # a periodic tube needs no Domain
        for axis in range(3) if copy.cell is not None else ():
            if f"x{axis + 1}" not in periodic:  # not periodic: the cell is made as long as the surfaces need
                k = numpy.abs(copy.cell[:, axis]).argmax()
                copy.cell[k] *= 2.05 * numpy.abs(copy.positions @ numpy.linalg.inv(copy.cell)[:, k]).max()
        return copy

    def evaluate(self, values, cells, s, t, ds=0, dt=0):
        """Returns a field at parameters s, t (m,), each in [0, 1], of the cells with the indices `cells` (m,). `values`
        (n,) or (n, k) is given at the nodes: `points`, or one of `fields`. The result has the shape (m,) or (m, k).
        `ds`, `dt`: orders of derivatives. It is exact, because a cell holds the polynomial of its element."""
        values, s, t = numpy.asarray(values), numpy.asarray(s, float), numpy.asarray(t, float)
        result = numpy.empty((len(cells),) + values.shape[1:])
        for p, which, nodes in lagrange.by_degree([self.cells[cell] for cell in cells]):
            result[which] = numpy.einsum("mn,mn...->m...", lagrange.table(p, s[which], t[which], ds, dt), values[nodes])
        return result

    def sampled(self, values, k=8, cells=None):
        """Returns a field at (k + 1)^2 uniformly spaced parameters of every cell, or of the cells with the indices
        `cells`. Shape (cells, k + 1, k + 1[, components]); the second index belongs to t, the third to s. The values
        are exact, see `evaluate`."""
        values = numpy.asarray(values)
        chosen = self.cells if cells is None else [self.cells[i] for i in cells]
        result = numpy.empty((len(chosen), k + 1, k + 1) + values.shape[1:], values.dtype)
        for p, which, nodes in lagrange.by_degree(chosen):
            i, j = numpy.array(lagrange.node_order(p)).T
            lattice = numpy.empty((len(which), p + 1, p + 1) + values.shape[1:], values.dtype)
            lattice[:, j, i] = values[nodes]
            table = lagrange.polynomials(p, numpy.arange(k + 1) / k).astype(values.dtype)
            along_t = numpy.einsum("tj,cji...->cti...", table, lattice, optimize=True)
            result[which] = numpy.einsum("si,cti...->cts...", table, along_t, optimize=True)
        return result

    def volume(self, k=16):
        """Returns the enclosed volume in length^3, by k^2 facets per cell."""
        grid = self.sampled(self.points, k)
        a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
        return abs(sum(numpy.einsum("...i,...i", x, numpy.cross(y, z)).sum() for x, y, z in ((a, b, c), (a, c, d)))) / 6

    def area(self, gauss=8):
        """Returns the area in length^2, by gauss^2 points per cell."""
        points, weights = numpy.polynomial.legendre.leggauss(gauss)
        total = 0.0
        for p, _, nodes in lagrange.by_degree(self.cells):
            s, t = (lagrange.grid_table(p, (points + 1) / 2, *order) @ self.points[nodes] for order in ((1, 0), (0, 1)))
            total += (numpy.linalg.norm(numpy.cross(s, t), axis=-1) @ numpy.outer(weights, weights).ravel()).sum() / 4
        return total

    def mesh(self, kind="meshio"):
        """Returns the curved cells with all fields: a meshio.Mesh, or with kind="vtk" a vtkUnstructuredGrid. Both have
        cells of the type VTK_LAGRANGE_QUADRILATERAL of the element's degree. Needs meshio or VTK."""
        expect(kind in ("meshio", "vtk"), f"a mesh is of the kind meshio or vtk, not {kind}")
        if kind == "meshio":
            meshio = optional("meshio", "snapshot.mesh()")
            blocks = [("VTK_LAGRANGE_QUADRILATERAL", nodes) for _, _, nodes in lagrange.by_degree(self.cells)]
            return meshio.Mesh(self.points, blocks, point_data=dict(self.fields))
        model, core, convert = (optional(f"vtkmodules.{name}", "snapshot.mesh('vtk')", "vtk9")
                                for name in ("vtkCommonDataModel", "vtkCommonCore", "util.numpy_support"))
        points, grid = core.vtkPoints(), model.vtkUnstructuredGrid()
        points.SetData(convert.numpy_to_vtk(self.points, deep=True))
        grid.SetPoints(points)
        for cell in sorted(self.cells, key=len):
            grid.InsertNextCell(getattr(model, "VTK_LAGRANGE_QUADRILATERAL", 70), len(cell), cell.tolist())
        for name, values in self.fields.items():
            array = convert.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
            array.SetName(name)
            grid.GetPointData().AddArray(array)
        return grid
