"""Results as pandas, xarray, meshio and VTK objects. Each needs its package only when it is called."""

import re

import numpy

from .lagrange import by_degree
from .mistakes import expect, optional

# Series of one particle; the others belong to the scene. A deck with several particles states it by /series/<particle>.
OF_PARTICLE = re.compile(r"(area|axis_\d(_x\d)?|cent(er|roid)_x\d|compressed_area|energy|inclination|"
                         r"intrinsic_viscosity|length_x\d|local_area_change|n_control_points|normal_velocity|phase|"
                         r"shape_velocity|smallest_tension|stresslet_\d\d|tank_treading_\w+|taylor_\w+|"
                         r"((angular|migration)_)?velocity(_x\d)?|volume(_error)?|refit_error|quaternion_\d|gap|"
                         r"\w*concentration|surfactant_mass|torque_x\d|drag(_x\d)?|(flow|force)_power|"
                         r"(fluid|membrane)_dissipation|power_residual)")


def split(run):
    """Returns ({series: {particle: values (rows,)}}, {series of the scene: values}) of a run."""
    own, scene = {}, {}
    for name, values in run.series.items():
        particle, _, series = name.rpartition("/")
        if particle or (not run.several and OF_PARTICLE.fullmatch(name)):
            own.setdefault(series, {})[particle or run.particles[0]] = values
        else:
            scene[name] = values
    return own, scene


def frame(run, tidy=False):
    """Returns a pandas.DataFrame of a run's series: see Run.frame."""
    pandas = optional("pandas", "run.frame()")
    if not tidy:
        found = pandas.DataFrame({name: values for name, values in run.series.items() if name != "time"},
                                 index=pandas.Index(run.series["time"], name="time"))
        found.attrs = {"units": dict(run.units), "descriptions": dict(run.descriptions)}
        return found
    own, _ = split(run)
    parts = [pandas.DataFrame({"time": run.series["time"], "particle": particle} |
                              {name: values[particle] for name, values in own.items() if particle in values})
             for particle in run.particles]
    return pandas.concat(parts, ignore_index=True)


def dataset(run):
    """Returns an xarray.Dataset of a run's series: see Run.dataset."""
    xarray = optional("xarray", "run.dataset()")
    own, scene = split(run)
    time = scene.pop("time")

    def about(name):
        return {"units": run.units[name], "long_name": run.descriptions[name]}

    variables = {}
    for name, values in own.items():
        rows = numpy.array([values.get(particle, numpy.full(len(time), numpy.nan)) for particle in run.particles])
        first = next(iter(values))
        variables[name] = ("particle", "time"), rows, about(f"{first}/{name}" if run.several else name)
    for name, values in scene.items():
        variables[f"scene_{name}" if name in own else name] = ("time",), values, about(name)
    coordinates = {"time": ("time", time, about("time")), "particle": run.particles}
    return xarray.Dataset(variables, coordinates, {"deck": run.deck_text, "name": run.name} | run.provenance)


def mesh(snapshot, kind):
    """Returns the curved cells of a snapshot: see Snapshot.mesh."""
    expect(kind in ("meshio", "vtk"), f"a mesh is of the kind meshio or vtk, not {kind}")
    cells = [nodes for _, _, nodes in by_degree(snapshot.cells)]
    if kind == "meshio":
        meshio = optional("meshio", "snapshot.mesh()")
        return meshio.Mesh(snapshot.points, [("VTK_LAGRANGE_QUADRILATERAL", nodes) for nodes in cells],
                           point_data={name: numpy.asarray(values) for name, values in snapshot.fields.items()})
    model = optional("vtkmodules.vtkCommonDataModel", "snapshot.mesh('vtk')", "vtk9")
    core = optional("vtkmodules.vtkCommonCore", "snapshot.mesh('vtk')", "vtk9")
    convert = optional("vtkmodules.util.numpy_support", "snapshot.mesh('vtk')", "vtk9")
    points, grid = core.vtkPoints(), model.vtkUnstructuredGrid()
    points.SetData(convert.numpy_to_vtk(snapshot.points, deep=True))
    grid.SetPoints(points)
    kind = getattr(model, "VTK_LAGRANGE_QUADRILATERAL", 70)
    for cell in (cell for nodes in cells for cell in nodes):
        grid.InsertNextCell(kind, len(cell), cell.tolist())
    for name, values in snapshot.fields.items():
        array = convert.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    return grid
