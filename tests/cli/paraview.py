#!/usr/bin/python3
# Tests that snapshots satisfy the specification VTKHDF 1.0 of unstructured grids, with Lagrange quadrilaterals in VTK's
# order of points.
import json
import pathlib

import h5py
import numpy

from harness import check, deck, main, run

FIXED = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 4 }
  Time: { final time: 0.1 }
  Output: { interval: 0.05 }
"""
REFINED = """
Tanktread:
  Flow: { type: planar hyperbolic }
  Membrane: { law: Skalak, capillary number: 0.6 }
  Surface: { elements per side: 4, extraordinary points: catmull-clark }
  Adaptation: { enabled: true, surface tolerance: 3.0e-4, levels: 2 }
  Time: { final time: 0.9 }
  Output: { interval: 0.3 }
"""
LAGRANGE_QUADRILATERAL = 70


def _grids(results):
    """Returns the group VTKHDF of each snapshot, in order of time."""
    series = json.loads((pathlib.Path(results) / "run.hdf.series").read_text())
    check(series["file-series-version"] == "1.0", series)
    times = [entry["time"] for entry in series["files"]]
    check(times == sorted(set(times)) and times[0] == 0, times)
    for entry in series["files"]:
        with h5py.File(pathlib.Path(results) / entry["name"], "r") as file:
            yield file["VTKHDF"]


def _point_number(i, j, p):
    """Returns the index of the node (i, j) of a Lagrange quadrilateral of degree p: corners first, then sides, then
    interior nodes."""
    on_i, on_j = i in (0, p), j in (0, p)
    if on_i and on_j:
        return (2 if j else 1) if i else (3 if j else 0)
    if on_j:
        return 4 + (i - 1) + (2 * (p - 1) if j else 0)
    if on_i:
        return 4 + (j - 1) + ((p - 1) if i else 3 * (p - 1))
    return 4 + 4 * (p - 1) + (i - 1) + (p - 1) * (j - 1)


def _cells(grid):
    """Returns the node numbers of each cell as an array [j, i]."""
    connectivity, offsets = grid["Connectivity"][()], grid["Offsets"][()]
    for a, b in zip(offsets[:-1], offsets[1:]):
        p = round((b - a) ** 0.5) - 1
        check((p + 1) ** 2 == b - a and p in (3, 4), f"a cell of {b - a} points")
        yield numpy.array([[connectivity[a + _point_number(i, j, p)] for i in range(p + 1)] for j in range(p + 1)])


def _check_layout(grid):
    """not a test"""
    kind = grid.attrs.get_id("Type").get_type()
    check(not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII and grid.attrs["Type"] == b"UnstructuredGrid", kind)
    check(grid.attrs["Version"].dtype == numpy.int64 and list(grid.attrs["Version"]) == [1, 0], grid.attrs["Version"])
    points, cells, ids = (grid[f"NumberOf{what}"] for what in ("Points", "Cells", "ConnectivityIds"))
    for numbers in points, cells, ids:
        check(numbers.dtype == numpy.int64 and numbers.shape == (1,), numbers)
    check(grid["Points"].shape == (points[0], 3) and grid["Points"].dtype == numpy.float64, grid["Points"])
    check(grid["Connectivity"].shape == (ids[0],) and grid["Connectivity"].dtype == numpy.int64, grid["Connectivity"])
    check(grid["Offsets"].shape == (cells[0] + 1,) and grid["Offsets"].dtype == numpy.int64, grid["Offsets"])
    check(grid["Types"].shape == (cells[0],) and grid["Types"].dtype == numpy.uint8, grid["Types"])
    check((grid["Types"][()] == LAGRANGE_QUADRILATERAL).all(), "other cells than Lagrange quadrilaterals")
    connectivity, offsets = grid["Connectivity"][()], grid["Offsets"][()]
    check(offsets[0] == 0 and offsets[-1] == ids[0] and (numpy.diff(offsets) > 0).all(), offsets)
    check(set(connectivity) == set(range(points[0])), "points that no cell has, or that are not there")
    for group, number in ("PointData", points[0]), ("CellData", cells[0]):
        for name, values in grid[group].items():
            check(values.shape[0] == number and values.dtype == numpy.float64, group, name, values)
            check(numpy.isfinite(values[()]).all(), group, name)
    check({"Normals", "load", "velocity", "traction"} <= set(grid["PointData"]), list(grid["PointData"]))


def _coons(x):
    """Returns the interior points of a Coons patch with the sides of the cell."""
    p = x.shape[0] - 1
    s = (numpy.arange(p + 1) / p)[None, :, None]
    t = s.transpose(1, 0, 2)
    sides = (1 - t) * x[:1] + t * x[-1:] + (1 - s) * x[:, :1] + s * x[:, -1:]
    corners = (1 - t) * ((1 - s) * x[0, 0] + s * x[0, -1]) + t * ((1 - s) * x[-1, 0] + s * x[-1, -1])
    return sides - corners


def _check_order(grid):
    """not a test"""
    points, normals = grid["Points"][()], grid["PointData/Normals"][()]
    check(abs(numpy.linalg.norm(normals, axis=1) - 1).max() < 1e-12, "normals have another length than 1")
    for cell in _cells(grid):
        x = points[cell]
        size = numpy.linalg.norm(x[-1, -1] - x[0, 0])
        check(abs(_coons(x) - x).max() < 0.1 * size / cell.shape[0], "inner points are not where their numbers say")
        for j in range(cell.shape[0] - 1):
            for i in range(cell.shape[0] - 1):
                upward = numpy.cross(x[j, i + 1] - x[j, i], x[j + 1, i] - x[j, i])
                check(upward @ normals[cell[j, i]] > 0, "a cell that is seen clockwise from outside")


def snapshots_satisfy_the_specification_of_the_format():
    for name, text in ("fixed", FIXED), ("refined", REFINED):
        run(deck(text), "--output", name, "--quiet")
        numbers = set()
        for grid in _grids(name):
            _check_layout(grid)
            _check_order(grid)
            numbers.add(grid["NumberOfCells"][0])
        check((len(numbers) > 1) == (name == "refined"), numbers)


def adjacent_cells_share_the_points_of_their_common_side():
    run(deck(FIXED), "--output", "run", "--quiet")
    for grid in _grids("run"):
        sides = [tuple(side) for c in _cells(grid) for side in (c[0], c[:, -1], c[-1, ::-1], c[::-1, 0])]
        check(len(set(sides)) == len(sides), "a side that two cells run along the same way")
        # all other sides are between cells of degree 3 and cells of degree 4
        alike = [side for side in sides if side[::-1] in set(sides)]
        check(len(alike) >= 0.7 * len(sides), f"only {len(alike)} of {len(sides)} sides have another cell beyond")


main()
