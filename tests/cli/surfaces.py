#!/usr/bin/python3
# Tests of tanktread-surface: triangulated surfaces become particles of the same volume and area, faulty ones are refused.
import pathlib
import re

import numpy
from harness import check, close, deck, main, package, run

FEW = "--elements", "8"


def _ball(level=3):
    """not a test"""
    from scipy.spatial import ConvexHull
    corners = numpy.concatenate([numpy.eye(3), -numpy.eye(3)])
    for _ in range(level):
        hull = ConvexHull(corners).simplices
        middles = (corners[hull] + numpy.roll(corners[hull], 1, axis=1)).reshape(-1, 3)
        corners = numpy.unique(numpy.round(numpy.concatenate([corners, middles / numpy.linalg.norm(middles, axis=1)[:, None]]), 9), axis=0)
    faces = ConvexHull(corners).simplices
    a, b, c = corners[faces].transpose(1, 0, 2)
    return corners, numpy.where(((a * numpy.cross(b, c)).sum(1) < 0)[:, None], faces[:, ::-1], faces)


def _disc(level=4):
    """not a test"""
    v, faces = _ball(level)
    r2 = numpy.minimum(v[:, 0]**2 + v[:, 1]**2, 1)
    height = numpy.sign(v[:, 2]) * numpy.sqrt(1 - r2) * (0.2072 + 2.002 * r2 - 1.123 * r2**2) / 2
    return 3.91 * numpy.column_stack([v[:, 0], v[:, 1], height]), faces


def _sickle(level=4):
    """not a test"""
    v, faces = _ball(level)
    bent = 0.8 * 3 * v[:, 0]
    return numpy.column_stack([(1.3 - 0.5 * v[:, 1]) * numpy.sin(bent), 1.3 - (1.3 - 0.5 * v[:, 1]) * numpy.cos(bent), 0.5 * v[:, 2]]), faces


def _written(name, points, faces):
    """not a test"""
    import meshio
    meshio.write(name, meshio.Mesh(points, [("triangle", faces)]), **({"binary": False} if name.endswith("ply") else {}))


def _volume(points, faces):
    """not a test"""
    a, b, c = points[faces].transpose(1, 0, 2)
    return (a * numpy.cross(b, c)).sum() / 6


def _made(name, *words):
    """not a test"""
    result = package("surface", name, "-o", "x.iga", *words)
    check(result.returncode == 0, result.stdout, result.stderr)
    check(pathlib.Path("x.png").stat().st_size > 5000, "no figure")
    return result.stdout


def _refused(name, *parts):
    """not a test"""
    result = package("surface", name, "-o", "x.iga", *FEW)
    check(result.returncode == 2 and result.stderr.count("\n") == 1 and not pathlib.Path("x.iga").exists(), result.stderr)
    for part in parts:
        check(part in result.stderr, f"no '{part}' in {result.stderr}")


def _numbers(said):
    """not a test"""
    return [float(x) for line in said.splitlines() if line.startswith(("mesh", "splines")) for x in re.findall(r"(?:volume|area) ([\d.e+-]+)", line)]


def bodies_that_are_not_star_shaped_keep_volume_and_area_and_run():
    points, faces = _sickle()
    _written("sickle.obj", points, faces)
    said = _made("sickle.obj", *FEW, "--unit", "um")
    volume, area, *splines = _numbers(said)
    close(volume, _volume(points, faces), 1e-5 * volume, "volume of the mesh")
    close(splines[0], volume, 1e-3 * volume, "volume of the splines")
    close(splines[1], area, 1e-3 * area, "area of the splines")
    check("Units: {length: 1 um}" in said, said)
    result = run(deck("Tanktread:\n  Flow: {type: simple shear}\n  Particle: {shape: file, file: x.iga}\n  Membrane: {law: Skalak, "
                      "capillary number: 0.1, bending number: 0.01}\n  Time: {final time: 0.01, fixed step: 0.005}\n"), "--output", "two", "--quiet")
    check(result.returncode == 0, result.stderr)


def a_disc_in_capitals_with_doubled_vertices_and_turned_triangles_is_mended():
    points, faces = _disc()
    faces = faces.copy()
    faces[::7] = faces[::7, ::-1]
    _written("disc.vtk", points[faces].reshape(-1, 3), numpy.arange(faces.size).reshape(-1, 3))
    said = _made(pathlib.Path("disc.vtk").rename("DISC.VTK"), *FEW)
    check(f"merged: {faces.size - len(points)} doubled vertices" in said, said)
    check(f"turned: {len(faces[::7])} of {len(faces)} triangles" in said, said)
    close(_numbers(said)[0], _volume(*_disc()), 1e-4, "volume")


def the_unit_of_the_numbers_does_not_matter():
    points, faces = _disc(3)
    _written("um.ply", points, faces)
    _written("m.off", 1e-6 * points, faces)
    one, other = (_numbers(_made(name, *FEW)) for name in ("um.ply", "m.off"))
    close(1e18 * other[2], one[2], 1e-4, "volume")
    close(1e12 * other[3], one[3], 1e-4, "area")


def faulty_surfaces_are_refused_in_one_sentence():
    points, faces = _ball()
    _written("open.stl", points, faces[points[faces][:, :, 2].mean(1) < 0.4])
    _written("two.obj", numpy.concatenate([points, points + [3, 0, 0]]), numpy.concatenate([faces, faces + len(points)]))
    _written("inner.off", numpy.concatenate([points, points / 2]), numpy.concatenate([faces, faces[:, ::-1] + len(points)]))
    dented = points.copy()
    dented[points[:, 2] > 0.9, 2] -= 3
    _written("crossed.ply", dented, faces)
    _written("coarse.off", *_ball(0))
    i, j = numpy.mgrid[:40, :20]
    ring = (3 + numpy.cos(2 * numpy.pi * j / 20)) * numpy.exp(2j * numpy.pi * i / 40)
    corners = [((i + a) % 40 * 20 + (j + b) % 20).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    _written("torus.stl", numpy.stack([ring.real, ring.imag, numpy.sin(2 * numpy.pi * j / 20)], axis=-1).reshape(-1, 3),
             numpy.concatenate([numpy.stack(corners[:3], 1), numpy.stack([corners[0], *corners[2:]], 1)]))
    numpy.savetxt("points.csv", _sickle(3)[0], delimiter=",")
    _refused("open.stl", "not closed", "close the holes")
    _refused("two.obj", "2 bodies", "own file")
    _refused("inner.off", "inner surface", "delete")
    _refused("crossed.ply", "crosses itself")
    _refused("coarse.off", "8 triangles", "at least 100")
    _refused("torus.stl", "1 handle")
    _refused("points.csv", "triangulate the points")
    _refused("none.stl", "there is no file")
    pathlib.Path("text.stl").write_text("nothing\n")
    _refused("text.stl", "text.stl")
    result = package("surface", "open.stl", "--unit", "kg")
    check(result.returncode == 2 and "no unit of length" in result.stderr, result.stderr)


def the_program_names_the_command_for_a_mesh():
    _written("cell.stl", *_ball())
    result = run(deck("Tanktread:\n  Flow: {type: simple shear}\n  Particle: {shape: file, file: cell.stl}\n  Membrane: {capillary number: 0.1}\n"
                      "  Time: {final time: 0.1}\n"), "--check", code=2)
    check("tanktread-surface" in result.stderr and "cell.stl" in result.stderr, result.stderr)


main()
