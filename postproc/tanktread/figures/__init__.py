"""Figures. Each function takes runs (or directories, or decks, which are run if they have no results) and optional
axes, and returns a matplotlib figure. `tanktread-figure --list` prints all of them; FIGURES maps names to functions.

`axes`: as many matplotlib axes as the figure has panels, or a Figure or SubFigure to draw in; None: a new figure.
Numbers that a figure reports as text are logged to the logger "tanktread" (level INFO); the command prints them."""

from ..mistakes import optional

for _name in "matplotlib", "scipy":
    optional(_name, "a figure")

from .accuracy import work  # noqa: E402
from .animations import animation  # noqa: E402
from .branches import branch, folds, growth_rates  # noqa: E402
from .channels import channel, stuck  # noqa: E402
from .drops import surfactant, vesicle  # noqa: E402
from .encounters import encounter, plane_wall  # noqa: E402
from .errors import convergence, step  # noqa: E402
from .red_cells import recovery, treading, tweezers  # noqa: E402
from .register import FIGURES, caption, command, figure, parser_of  # noqa: E402
from .series import deformation, refinement  # noqa: E402
from .surfaces import meshes, shape  # noqa: E402
from .suspensions import drift, rheology, suspension, viscosity  # noqa: E402
from .tubes import duct, tube, tube_motion  # noqa: E402

__all__ = ["FIGURES", "caption", "command", "figure", "parser_of", *FIGURES]
