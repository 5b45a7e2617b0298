"""Results as pandas, xarray, meshio and VTK objects, which are methods of Run and Snapshot. Each needs its package only
when it is called."""

import itertools
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
            own.setdefault(series, {})[particle or "particle"] = values
        else:
            scene[name] = values
    return own, scene


def frame(run, tidy=False):
    """Returns the series as a pandas.DataFrame with the index `time`, a column for each name in `series`, and the
    units and descriptions in its `attrs`. With tidy=True it has one row per time and particle and the columns
    `time`, `particle` and the series of particles; of one particle and of several alike. Needs pandas."""
    pandas = optional("pandas", "run.frame()")
    if not tidy:
        found = pandas.DataFrame(dict(run.series)).set_index("time")
        found.attrs = {"units": dict(run.units), "descriptions": dict(run.descriptions)}
        return found
    own, _ = split(run)
    parts = [pandas.DataFrame({"time": run.series["time"], "particle": particle} |
                              {name: values[particle] for name, values in own.items() if particle in values})
             for particle in run.particles]
    return pandas.concat(parts, ignore_index=True)


def dataset(run):
    """Returns the series as an xarray.Dataset. Series of particles have the dimensions (particle, time), of one
    particle and of several alike; series of the scene have (time,). A series of the scene with the name of a
    particle's is called `scene_<name>`. Variables have the attributes `units` and `long_name`. Needs xarray."""
    xarray = optional("xarray", "run.dataset()")
    own, scene = split(run)
    time, variables = scene.pop("time"), {}
    about = {name: {"units": run.units[name], "long_name": run.descriptions[name]} for name in run.series}
    for name, values in own.items():
        rows = numpy.array([values.get(particle, numpy.full(len(time), numpy.nan)) for particle in run.particles])
        variables[name] = ("particle", "time"), rows, about[f"{next(iter(values))}/{name}" if run.several else name]
    for name, values in scene.items():
        variables[f"scene_{name}" if name in own else name] = ("time",), values, about[name]
    coordinates = {"time": ("time", time, about["time"]), "particle": run.particles}
    return xarray.Dataset(variables, coordinates, {"deck": run.deck_text, "name": run.name} | run.provenance)


def mesh(snapshot, kind="meshio"):
    """Returns the curved cells with all fields: a meshio.Mesh, or with kind="vtk" a vtkUnstructuredGrid. Both have
    cells of the type VTK_LAGRANGE_QUADRILATERAL of the element's degree. Needs meshio or VTK."""
    expect(kind in ("meshio", "vtk"), f"a mesh is of the kind meshio or vtk, not {kind}")
    cells = [nodes for _, _, nodes in by_degree(snapshot.cells)]
    if kind == "meshio":
        meshio = optional("meshio", "snapshot.mesh()")
        blocks = [("VTK_LAGRANGE_QUADRILATERAL", nodes) for nodes in cells]
        return meshio.Mesh(snapshot.points, blocks, point_data=dict(snapshot.fields))
    model, core, convert = (optional(f"vtkmodules.{name}", "snapshot.mesh('vtk')", "vtk9")
                            for name in ("vtkCommonDataModel", "vtkCommonCore", "util.numpy_support"))
    points, grid = core.vtkPoints(), model.vtkUnstructuredGrid()
    points.SetData(convert.numpy_to_vtk(snapshot.points, deep=True))
    grid.SetPoints(points)
    for cell in itertools.chain.from_iterable(cells):
        grid.InsertNextCell(getattr(model, "VTK_LAGRANGE_QUADRILATERAL", 70), len(cell), cell.tolist())
    for name, values in snapshot.fields.items():
        array = convert.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    return grid
