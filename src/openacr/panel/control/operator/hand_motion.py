"""Axes moved by hand from screens: held keys, increments, and everything that stops them."""

import math
from collections.abc import Callable
from typing import Any

from openacr.errors import UserError
from openacr.map.words import af4
from openacr.mill.session import MillSession
from openacr.panel.control.machine.link import Link
from openacr.panel.control.machine.snapshot import Ticks
from openacr.panel.control.operator.card_jogs import CardJogs
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.control.operator.presses import End, Key, Presses

LONGEST_AGE_S = 0.2  # of what a browser has drawn, when it begins or keeps motion


class HandMotion:
    """Axes moved by hand at the screens."""

    def __init__(
        self,
        link: Link,
        ticks: Ticks,
        card_jogs: CardJogs,
        tell: Callable[[dict[str, Any]], None],
    ) -> None:
        self._link, self._ticks, self._report = link, ticks, tell
        self._card_jogs = card_jogs
        self.presses = Presses(self._drop, self._tell)

    # --- held keys --------------------------------------------------------------------

    def press(
        self,
        key: Key,
        axis: int,
        direction: int,
        *,
        fast: bool,
        speed_ups: float | None,
        tick_ms: float,
        received_s: float,
        now_s: float,
    ) -> None:
        """Begin a press: the axis moves until it ends. `speed_ups`: of one not AcroMill's."""
        if not self.presses.is_new(key):
            raise PanelError("refused", f"press {key.number} is over: press the key again")
        self.presses.use_up(key)
        self.require_fresh(tick_ms, received_s)
        if now_s - received_s > LONGEST_AGE_S:
            raise PanelError("stale", "the press waited too long: press the key again")
        if axis in self.presses.axes:
            self.presses.end_all(End.STOP, "two keys of one axis")
            name = self._link.installation.axis_name(axis)
            raise UserError(f"axis {name} is jogged by another key: both stop")
        if speed_ups is not None:
            self._card_jogs.begin(axis, direction, speed_ups)
            self.presses.begin(key, axis, received_s)
            return
        session = self._link.machine
        if session.runner.jogging.is_active and not self.presses.are_held:
            session.runner.stop()  # an increment is under way, or a jog ramps down
            raise UserError("an axis is still moving: press again when it rests")
        self._require_drive(session, axis)
        session.runner.controls.press(_holder(key.client), axis, direction, fast=fast)
        self.presses.begin(key, axis, received_s)

    def keep(self, key: Key, tick_ms: float, received_s: float) -> None:
        """Keep a press alive, if its browser has drawn what the machine does now."""
        age_s = self._ticks.age_s(tick_ms, received_s)
        if age_s is None or age_s > LONGEST_AGE_S:
            return
        if self.presses.keep(key, received_s) and self._link.session is not None:
            self._link.session.runner.controls.renew(_holder(key.client))

    def release(self, key: Key) -> None:
        """End a press by its release."""
        self.presses.use_up(key)
        self.presses.end(key, End.RELEASED)

    def expire(self, now_s: float) -> None:
        """End the presses whose browsers are silent."""
        self.presses.expire(now_s)

    def step(self) -> None:
        """Carry on with the axes that are not AcroMill's."""
        for axis, text in self._card_jogs.step():
            self.presses.end_axis(axis, End.REFUSED, text)

    def require_fresh(self, tick_ms: float, received_s: float) -> None:
        """Refuse motion by a browser that shows something old."""
        age_s = self._ticks.age_s(tick_ms, received_s)
        if age_s is None or age_s > LONGEST_AGE_S:
            shown = "unknown" if age_s is None else f"{1000.0 * age_s:.0f} ms old"
            raise PanelError("stale", f"the positions on this screen are {shown}: nothing moves")

    def _require_drive(self, session: MillSession, axis: int) -> None:
        """Refuse an axis whose drive the card has switched off: its setpoint alone would move."""
        (word,) = session.machine.read_rows([af4.word[axis]])
        if int(word) & af4.DRIVE_I_O_ENABLE and not int(word) & af4.DRIVE_ENABLED:
            name = session.runner.settings.axis(axis).name
            raise UserError(f"the drive of axis {name} is off: DRIVE ON {name} switches it on")

    def _drop(self, client: int, axis: int) -> None:
        session = self._link.session
        if session is not None and not self._card_jogs.release(axis):
            session.runner.controls.release(_holder(client), axis)

    def _tell(self, key: Key, why: End, text: str) -> None:
        event = {"event": "jog", "press": key.number, "ended": why.value, "text": text}
        self._report({**event, "to": key.client})

    # --- increments -------------------------------------------------------------------

    def increment(
        self,
        axis: int,
        direction: int,
        *,
        preset: int,
        distance_u: float,
        fast: bool,
        speed_ups: float | None,
    ) -> None:
        """Move an axis by an increment of the store (`preset`), or by a distance."""
        if self.presses.are_held:
            self.presses.end_all(End.STOP, "an increment was commanded")
            raise UserError("a key is held: the axes stop, no increment is made")
        if speed_ups is not None:
            self._card_jogs.begin(axis, direction, speed_ups, distance_u=distance_u)
            return
        runner = self._link.machine.runner
        self._require_drive(self._link.machine, axis)
        if preset:
            runner.jog(lambda jogging: jogging.increment(axis, direction, preset, fast=fast))
        else:
            path_u = math.copysign(distance_u, direction)
            runner.jog(lambda jogging: jogging.move(axis, path_u, fast=fast))

    def stop(self) -> None:
        """Bring everything that is moved by hand to rest."""
        self.end_held()
        session = self._link.session
        if session is not None and session.runner.jogging.is_active:
            session.runner.jogging.stop_all()

    def end_held(self) -> None:
        """End every held key, and what moves an axis that is not AcroMill's."""
        try:
            self.presses.end_all(End.STOP)
        finally:
            self._card_jogs.release_all()


def _holder(client: int) -> str:
    return f"panel {client}"
