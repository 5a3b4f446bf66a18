"""Path tolerance: how far a path may stay off its corners; 0, as on the card, not at all.

LOOK TOL sets it. It acts between straight moves while LOOK is on. The kernel rounds the
corners, or stops in them, and keeps the acceleration (with JRK the jerk, too) of the rounded path
within the limits of the moves.
"""

from openacr.errors import CardError
from openacr.map.rows import masters, moves
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card

LARGEST_U = 1e9


def is_tolerance(value: float) -> bool:
    """A length, or 0."""
    return 0.0 <= value < LARGEST_U


def set_of_move(card: Card, master: int, record: int, tolerance_u: float) -> None:
    """Give the move just put into a record a tolerance of its own for the corner at its end."""
    if not is_tolerance(tolerance_u):
        raise CardError(INVALID_ARGUMENT)
    card.memory.F[moves.tolerance_u[record]] = tolerance_u
    if tolerance_u > 0.0:
        card.memory.F[moves.fvel_ups[record]] = 0.0  # as with LOOK, see records
        card.memory.I[masters.rounding[master]] = 1
