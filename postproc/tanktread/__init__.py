"""Runs of tanktread and their results in Python. numpy, h5py and PyYAML are required; other packages are optional.

    import tanktread

    # 1. Run a deck with keys changed. A run is made once and found again.
    run = tanktread.run("inputs/shear_neo_hookean.yaml", {"Membrane/capillary number": 0.2})
    run.series["taylor_inertia"]       # one value per step; run.units[...] and run.descriptions[...]
    run.deck["Flow"]["type"]           # the effective deck
    run.frame(), run.dataset()         # the series for pandas and xarray

    # 2. Read results and a saved step.
    last = tanktread.run("results/shear_neo_hookean").snapshots()[-1]
    last.fields["traction"]            # (n, 3), at the nodes of its cells
    last.evaluate(last.points, [0, 0], [0.5, 0.25], [0.5, 0.5])    # exact positions in cell 0 at parameters s, t
    last.mesh(), last.mesh("vtk")      # curved cells for meshio and VTK

    # 3. Make many runs side by side. A run that fails does not stop the others.
    study = tanktread.Study(directory="results/mine", jobs=2)
    outcomes = study.all([("deck.yaml", {"Membrane/capillary number": ca}) for ca in (0.1, 0.2, 0.3)])
    [one.final["taylor_inertia"] for one in outcomes if one.done]

    # 4. Draw figures. Each function takes runs and returns a matplotlib figure.
    from tanktread import figures
    figures.deformation([run]).savefig("deformation.png")

Modules: `results`, `runs`, `studies` (sweep, fit, outline, phases, critical), `figures`, `report`,
`shapes` (tanktread-surface)."""

from .lagrange import node_order
from .mistakes import Mistake
from .results import Run, field_label, time_label
from .runs import ENVIRONMENT, PROGRAM, SOURCE, Outcome, Study, deck_at, quoted, results_of, run, runs_of, text_of
from .snapshots import DIMENSIONS, Snapshot

__version__ = "0.2.0"
__all__ = ["DIMENSIONS", "ENVIRONMENT", "PROGRAM", "SOURCE", "Mistake", "Outcome", "Run", "Snapshot", "Study",
           "deck_at", "field_label", "node_order", "quoted", "results_of", "run", "runs_of", "text_of", "time_label"]
