"""Drives that are switched on at a screen: whether they came on, or what bars them."""

from concurrent.futures import Future
from dataclasses import dataclass

from openacr.client.drives import BARS, ENABLE_S, Drive, read_drives, said
from openacr.client.errors import RefusedError
from openacr.errors import UserError
from openacr.panel.control.machine.link import Link


@dataclass(slots=True)
class _Waiting:
    axis: int
    until_s: float
    answer: "Future[None]"


class Drives:
    """The drives of the card at the screens."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._waiting: list[_Waiting] = []

    def look(self) -> list[Drive]:
        """Every axis that a program of the card has."""
        axes = sorted({each.axis for each in self._link.installation.attached})
        return read_drives(self._link.read, axes)

    def on(self, axis: int, now_s: float) -> "Future[None]":
        """Switch a drive on; the future ends once it is. UserError where something bars it."""
        self._require_none(axis)
        self._command(axis, "DRIVE ON")
        waiting = _Waiting(axis, now_s + ENABLE_S, Future())
        self._waiting.append(waiting)
        return waiting.answer

    def off(self, axis: int) -> None:
        """Switch a drive off; UserError while its axis moves."""
        self._command(axis, "DRIVE OFF")

    def reset(self, axis: int, latch: int) -> None:
        """Reset a drive: its fault clears; so does `latch`, that of the Motion Enable Input."""
        self._command(axis, "DRIVE RES")
        if "enable.latched" in self._read(axis).wrong:
            self._link.required.card.write_bit(latch, True)

    def step(self, now_s: float) -> None:
        """See whether drives have come on."""
        for each in list(self._waiting):
            drive = self._read(each.axis)
            if not drive.is_enabled and now_s < each.until_s:
                continue
            self._waiting.remove(each)
            if drive.is_enabled:
                each.answer.set_result(None)
            else:
                why = "; ".join(drive.bars) or "the card does not say why"
                each.answer.set_exception(UserError(f"{self._name(each.axis)} stays off: {why}"))

    def end(self) -> None:
        """The session has ended: nothing more is known."""
        waiting, self._waiting = self._waiting, []
        for each in waiting:
            each.answer.set_exception(UserError(self._link.lost or "the card was left"))

    def _require_none(self, axis: int) -> None:
        bars = [said(each, axis) for each in self._read(axis).wrong if each in BARS]
        if bars:
            raise UserError(f"{self._name(axis)} cannot be switched on: {'; '.join(bars)}")

    def _read(self, axis: int) -> Drive:
        return read_drives(self._link.required.machine.read_rows, [axis])[0]

    def _name(self, axis: int) -> str:
        return f"the drive of axis {self._link.installation.axis_name(axis)}"

    def _command(self, axis: int, command: str) -> None:
        try:
            self._link.required.card.command(f"AXIS{axis} {command}", program=0)
        except RefusedError as refused:
            raise UserError(
                f"{self._name(axis)}: {command} is refused: {refused.message}."
                " A moving axis is stopped first (STOP), or by ALL OFF"
            ) from refused
