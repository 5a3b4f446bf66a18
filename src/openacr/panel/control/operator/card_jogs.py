"""Jogs of axes that are not AcroMill's: those of any master, by held keys and by distances."""

from openacr.client.axis_jog import AxisJog, Jogged
from openacr.client.errors import RefusedError
from openacr.errors import UserError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.machine.link import Link


class CardJogs:
    """The jogs under way, at most one of each axis."""

    def __init__(self, link: Link) -> None:
        self._link = link
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
        session, installation = self._link.required, self._link.installation
        if axis in self._jogs:
            name = self._jogs[axis].name
            raise UserError(f"axis {name} is still moving: press again when it rests")
        if session.is_set_up:
            _require_no_program(session)
        there = [each for each in installation.attached if each.axis == axis]
        jogged = Jogged(
            axis,
            installation.axis_name(axis),
            there[0].master if there else None,
            tuple(sorted({each.program for each in there if each.program is not None})),
        )
        self.begun += 1
        self._jogs[axis] = AxisJog(
            session.card, jogged, direction, speed_ups, session.machine.now_s, distance_u=distance_u
        )

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
        """Carry on with the jogs; axes that the card has refused to move on, with its words."""
        refused = []
        for axis, jog in list(self._jogs.items()):
            try:
                jog.step(self._link.required.machine.now_s)
            except RefusedError as error:
                refused.append((axis, f"axis {jog.name}: {error}"))
                jog.release()
            if jog.is_over:
                del self._jogs[axis]
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
