"""Figures. Each function takes runs (or directories, or decks, which are run if they have no results) and optional
axes, and returns a matplotlib figure. `tanktread-figure --list` prints all of them; FIGURES maps names to functions.

`axes`: as many matplotlib axes as the figure has panels, or a Figure or SubFigure to draw in; None: a new figure.
Numbers that a figure reports as text are logged to the logger "tanktread" (level INFO); the command prints them."""

from .accuracy import convergence, step, work
from .drops import surfactant, vesicle
from .pushed import stuck
from .red_cells import recovery, treading, tweezers
from .register import FIGURES, caption, command, figure, parser_of
from .series import branch, deformation, folds, growth_rates, refinement
from .surfaces import animation, meshes, shape
from .suspensions import drift, encounter, plane_wall, rheology, suspension, viscosity
from .tubes import channel, duct, tube, tube_motion

__all__ = ["FIGURES", "caption", "command", "figure", "parser_of", *FIGURES]
