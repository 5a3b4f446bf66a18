"""The console of `openacr mill run --console`: commands typed while the program runs."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

import typer

from openacr.cli.mill_terminal import Lines, number_in
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.runner import Runner
    from openacr.mill.workshop import Workshop

STEP_S = 0.05


class Console:
    """Takes the lines somebody types, one command each."""

    def __init__(self, source: TextIO | None = None, lines: Lines | None = None) -> None:
        self._lines = lines or Lines(source)
        self._shown = ""

    def attend(self, shop: "Workshop") -> None:
        """Do what was typed, say what changed; the virtual machine runs in real time."""
        while (line := self._lines.take()) is not None:
            self._do(shop.runner, line)
        self._show(shop.runner)
        if self._lines.are_over:
            self._require_nobody(shop.runner)
        if shop.is_virtual:
            shop.runner.doing.changer.confirm()
            time.sleep(STEP_S)

    def _do(self, runner: "Runner", line: str) -> None:
        words = line.lower().split()
        if not words:
            return
        try:
            command(words)(runner)
        except UserError as error:
            typer.echo(f"{line}: {error}", err=True)

    def _require_nobody(self, runner: "Runner") -> None:
        """Behind the last line, the program has to run by itself."""
        from openacr.mill.states import State

        is_asking = runner.asking is not None or runner.doing.changer.wants_confirmation
        is_held = runner.state in (State.HOLD, State.PAUSED) and not runner.retrace.is_active
        if is_held or is_asking:
            reason = runner.reason or runner.state.name
            runner.abort()
            raise UserError(f"{reason}: nobody is at the console to go on")

    def _show(self, runner: "Runner") -> None:
        up = "; ".join(alarm.text for alarm in runner.alarms.active)
        text = f"{runner.state.name} {runner.reason} {up}".strip()
        if text != self._shown:
            self._shown = text
            typer.echo(text, err=True)


_COMMANDS: dict[str, Callable[["Runner"], object]] = {
    "stop": lambda runner: runner.stop(),
    "resume": lambda runner: runner.resume(),
    "start": lambda runner: runner.start(),
    "abort": lambda runner: runner.abort(),
    "acknowledge": lambda runner: runner.acknowledge(),
    "confirm": lambda runner: runner.doing.changer.confirm(),
    "block": lambda runner: runner.block(not runner.options.is_single),
    "back": lambda runner: runner.trace(-1),
    "forward": lambda runner: runner.trace(1),
    "halt": lambda runner: runner.trace(0),
}


def command(words: list[str]) -> Callable[["Runner"], object]:
    """What a line means: a command, or a click of an override: fov 7."""
    from openacr.mill.overrides import Override

    switches = {"fov": Override.FEED, "rov": Override.RAPID, "sov": Override.SPINDLE}
    name, *rest = words
    if name in switches and len(rest) == 1 and rest[0].isdigit():
        return lambda runner: runner.overrides.choose(switches[name], int(rest[0]))
    if name == "answer" and len(rest) == 1:
        return lambda runner: runner.answer(number_in(rest[0]))
    if name not in _COMMANDS or rest:
        known = " ".join((*_COMMANDS, "answer VALUE", "fov N", "rov N", "sov N"))
        raise UserError(f"no such command; there are {known}")
    return _COMMANDS[name]
