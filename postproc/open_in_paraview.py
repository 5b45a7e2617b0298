"""Opens a run in ParaView: its curved elements with exact normals, coloured by a field, at all times.

    pvpython postproc/open_in_paraview.py results/shear_neo_hookean --state run.pvsm          # then: paraview run.pvsm
    xvfb-run -a pvpython postproc/open_in_paraview.py results/shear_neo_hookean -o last.png   # without a display (xvfb)

ParaView 5.11 (Debian 12: package python3-paraview) or newer is needed. The files of a run do not contain the wall of a
tube; postproc/tanktread-figure tube draws it. This file must not be called paraview.py: it would hide the module.
"""

import argparse
import os
import pathlib
import sys

try:
    from paraview import simple
except ImportError:
    sys.exit("this script is started by pvpython or pvbatch (Debian package python3-paraview), not by python3")

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("results", help="directory of a run's results")
parser.add_argument("--field", default="traction", help="field that colours the surface (default: %(default)s)")
parser.add_argument("--time", type=float, help="simulated time to show (default: the last)")
parser.add_argument("--state", metavar="FILE", help="save a state file for the ParaView program")
parser.add_argument("-o", "--output", metavar="FILE", help="save a picture")
parser.add_argument("--offscreen", action="store_true",
                    help="set this if your ParaView can draw without a display (Debian's cannot)")
arguments = parser.parse_args()
if not (arguments.offscreen or os.environ.get("DISPLAY")):
    sys.exit(f"there is no display, without which Debian's ParaView crashes: xvfb-run -a pvpython "
             f"{' '.join(sys.argv)} (package xvfb)")

series = pathlib.Path(arguments.results).resolve() / "run.hdf.series"
if not series.exists():
    sys.exit(f"{series} does not exist: give the directory of a run's results")
source = simple.OpenDataFile(str(series))
simple.RenameSource("tanktread", source)
view = simple.GetActiveViewOrCreate("RenderView")
view.ViewSize, view.Background, view.UseColorPaletteForBackground = [1200, 900], [1, 1, 1], 0
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
times = scene.TimeKeeper.TimestepValues or [0.0]  # TimestepValues is a number, not a list, if there is one step
times = list(times) if hasattr(times, "__len__") else [times]
time = times[-1] if arguments.time is None else min(times, key=lambda one: abs(one - arguments.time))
scene.AnimationTime = view.ViewTime = time
display = simple.Show(source, view)
display.SetRepresentationType("Surface")
display.NonlinearSubdivisionLevel = 3  # with ParaView's default, curved elements look nearly flat
display.SelectNormalArray = "Normals"
source.UpdatePipeline(view.ViewTime)
field, fields = arguments.field, source.PointData.keys()
if field not in fields:
    sys.exit(f"there is no field {field}; there are: {', '.join(sorted(fields))}")
scalar = source.PointData[field].GetNumberOfComponents() == 1
simple.ColorBy(display, ("POINTS", field) if scalar else ("POINTS", field, "Magnitude"))
display.RescaleTransferFunctionToDataRange(True)
display.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(simple.GetColorTransferFunction(field), view)
bar.TitleColor = bar.LabelColor = [0.13, 0.15, 0.18]
# x1 to the right, x3 up, the eye on the side of negative x2 and somewhat above
view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0, 0, 0], [0.45, -0.8, 0.4], [0, 0, 1]
simple.ResetCamera(view)
view.CameraParallelProjection = 1
view.CameraParallelScale *= 0.75
if arguments.state:
    simple.SaveState(arguments.state)
if arguments.output:
    simple.SaveScreenshot(arguments.output, view)
