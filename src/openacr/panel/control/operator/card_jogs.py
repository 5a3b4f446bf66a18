"""Jogs of axes that are not AcroMill's: those of any master, by held keys and by distances."""

from collections.abc import Callable

from openacr.client.axis_jog import AxisJog, Jogged
from openacr.client.errors import RefusedError
from openacr.errors import UserError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.left_jogs import LeftJogs


class CardJogs:
    """The jogs under way, at most one of each axis."""

    def __init__(self, link: Link, say: Callable[[str], None]) -> None:
        self._link, self._say = link, say
        store, is_virtual = link.installation.store.path, link.installation.is_virtual
        folder = None if store is None or is_virtual else store.parent
        self._left = LeftJogs(folder, str(link.installation.target))
        self._jogs: dict[int, AxisJog] = {}
        self.begun = 0  # jogs so far

    @property
    def are_active(self) -> bool:
        """Whether an axis was moved and is not known to be at rest."""
        return bool(self._jogs)

    def begin(
        self, axis: int, direction: int, speed_ups: float, *, distance_u: float | None = None
    ) -> None:
        """Jog an axis until `release`, or by a distance; UserError where it may not be moved."""
        session = self._link.required
        if axis in self._jogs:
            name = self._jogs[axis].name
            raise UserError(f"axis {name} is still moving: press again when it rests")
        if session.is_set_up:
            _require_no_program(session)
        self._require_nothing_left(axis)
        self.begun += 1
        self._jogs[axis] = AxisJog(
            session.card, self._jogged(axis), direction, speed_ups, session.machine.now_s,
            distance_u=distance_u,
            note=lambda own_ups: self._left.note(axis, own_ups, speed_ups),
        )  # fmt: skip

    def _jogged(self, axis: int) -> Jogged:
        installation = self._link.installation
        there = [each for each in installation.attached if each.axis == axis]
        programs = {each.program for each in there if each.program is not None}
        return Jogged(
            axis,
            installation.axis_name(axis),
            there[0].master if there else None,
            tuple(sorted(programs)),
        )

    def _require_nothing_left(self, axis: int) -> None:
        """Refuse an axis whose jog speed is still that of a jog that was cut off."""
        if self._left.has(axis):
            self._set_back(axis)
        if self._left.has(axis):
            raise UserError(
                f"axis {self._jogged(axis).name}: a jog that was cut off is set back first, once"
                " the axis rests and no program of its master runs or is paused"
            )

    def _set_back(self, axis: int) -> None:
        done = self._left.set_back(self._link.required.card, self._jogged(axis))
        if done:
            self._say(done)

    def release(self, axis: int) -> bool:
        """Ramp an axis to rest; False for one that is not jogged here."""
        jog = self._jogs.get(axis)
        if jog is None:
            return False
        jog.release()
        return True

    def release_all(self) -> None:
        """Ramp every axis to rest, whichever fails; the first error is raised at the end."""
        failures: list[Exception] = []
        for jog in self._jogs.values():
            try:
                jog.release()
            except Exception as error:  # the other axes are stopped as well
                failures.append(error)
        if failures:
            raise failures[0]

    def step(self) -> list[tuple[int, str]]:
        """Carry on with the jogs; axes that the card has refused to move on, with its words.

        What an earlier jog has left on the card is set back, where the axis rests by now.
        """
        refused = []
        for axis, jog in list(self._jogs.items()):
            try:
                jog.step(self._link.required.machine.now_s)
            except RefusedError as error:
                refused.append((axis, f"axis {jog.name}: {error}"))
                jog.release()
            if jog.is_over:
                del self._jogs[axis]
                self._left.forget(axis)
        session = self._link.session
        for axis in [] if session is None else self._left.axes(session.machine.now_s):
            if axis not in self._jogs:
                self._set_back(axis)
        return refused

    def end(self) -> None:
        """The session ends: what the card can still be given ends the jogs, else their leash."""
        jogs, self._jogs = self._jogs, {}
        for jog in jogs.values():
            try:
                jog.leave()
            except (RefusedError, *LINK_ERRORS):
                continue


def _require_no_program(session: MillSession) -> None:
    """Refuse while AcroMill runs a part program or homes."""
    runner = session.runner
    if runner.is_busy and not runner.jogging.is_active:
        raise UserError(f"the machine works (state {runner.state.name}): wait until it rests")
