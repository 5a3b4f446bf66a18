"""What bars commands while the panel moves its machine."""

from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.panel.control.engineer.tuning import Tuning
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.card_jogs import CardJogs

MEASURED = "an axis is measured (servo tuning): wait until it rests, or STOP"
FIRST_REST = "wait until it rests, or STOP, then go back"


class Interlocks:
    """Whether the panel moves the machine: by a program, a key, servo tuning."""

    def __init__(self, link: Link, tuning: Tuning, card_jogs: CardJogs) -> None:
        self._link, self._tuning, self._card_jogs = link, tuning, card_jogs

    @property
    def is_moved(self) -> bool:
        """Whether the panel moves the machine; UserError where the card cannot be reached."""
        if self._link.session is None:
            raise UserError(self._link.lost)
        is_busy = self._link.session.runner.is_busy or self._card_jogs.are_active
        return is_busy or self._tuning.is_moving

    @property
    def rests(self) -> bool:
        """Whether the machine is at rest and ready; not while its card cannot be reached."""
        session = self._link.session
        return session is not None and not self.is_moved and session.runner.state is State.IDLE

    def require_unmeasured(self) -> None:
        """UserError while servo tuning moves an axis: its conversation with the card is timed."""
        if self._tuning.is_moving:
            raise UserError(MEASURED)

    def require_unmoved(self) -> None:
        """UserError while the panel moves the machine, with what to do first."""
        self.require_unmeasured()
        if self._link.session is not None and self.is_moved:
            state = self._link.session.runner.state.name
            raise UserError(f"the panel moves the machine (state {state}): {FIRST_REST}")
