"""The console of `openacr mill run --console`: commands typed while the program runs."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TextIO

import typer

from openacr.cli.mill.terminal import Lines, number_in
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.run.runner import Runner
    from openacr.mill.session import MillSession

STEP_S = 0.05


class Console:
    """Executes the commands typed at the console, one per line."""

    def __init__(self, source: TextIO | None = None, lines: Lines | None = None) -> None:
        self._lines = lines or Lines(source)
        self._shown = ""

    def attend(self, shop: "MillSession") -> None:
        """Execute typed commands and report changes; the virtual machine runs in real time."""
        while (line := self._lines.take()) is not None:
            self._do(shop.runner, line)
        self._show(shop.runner)
        if self._lines.are_over:
            self._require_unattended(shop.runner)
        if shop.is_virtual:
            shop.runner.entry_actions.changer.confirm()
            time.sleep(STEP_S)

    def _do(self, runner: "Runner", line: str) -> None:
        words = line.lower().split()
        if not words:
            return
        try:
            command(words)(runner)
        except UserError as error:
            typer.echo(f"{line}: {error}", err=True)

    def _require_unattended(self, runner: "Runner") -> None:
        """Check after the last line that the program needs no operator."""
        from openacr.mill.run.lifecycle import State

        is_asking = runner.asking is not None or runner.entry_actions.changer.wants_confirmation
        is_held = runner.state in (State.HOLD, State.PAUSED) and not runner.retrace.is_active
        if is_held or is_asking:
            reason = runner.reason or runner.state.name
            runner.abort()
            raise UserError(f"{reason}: no operator at the console to continue")

    def _show(self, runner: "Runner") -> None:
        up = "; ".join(alarm.text for alarm in runner.alarms.active)
        text = f"{runner.state.shown} {runner.reason} {up}".strip()
        if text != self._shown:
            self._shown = text
            typer.echo(text, err=True)


class Row(NamedTuple):
    """A command: its value, what it does, and the action."""

    value: str
    meaning: str
    act: Callable[["Runner", str], object]


COMMANDS = {
    "stop": Row("", "feed hold", lambda runner, _: runner.stop()),
    "resume": Row("", "continue the path where it was held", lambda runner, _: runner.resume()),
    "start": Row("", "continue from a hold or a pause", lambda runner, _: runner.start()),
    "abort": Row("", "end the program", lambda runner, _: runner.abort()),
    "acknowledge": Row("", "clear alarms", lambda runner, _: runner.acknowledge()),
    "confirm": Row(
        "", "confirm the tool change", lambda runner, _: runner.entry_actions.changer.confirm()
    ),
    "block": Row(
        "",
        "switch single block on or off",
        lambda runner, _: runner.block(not runner.options.is_single),
    ),
    "back": Row("", "in a pause: back along the path", lambda runner, _: runner.trace(-1)),
    "forward": Row("", "in a pause: forward again", lambda runner, _: runner.trace(1)),
    "halt": Row("", "in a pause: stop on the path", lambda runner, _: runner.trace(0)),
    "answer": Row(
        "VALUE", "answer an INPUT", lambda runner, value: runner.answer(number_in(value))
    ),
    "fov": Row("CLICK", "feed override", lambda runner, value: _choose(runner, "FEED", value)),
    "rov": Row("CLICK", "rapid override", lambda runner, value: _choose(runner, "RAPID", value)),
    "sov": Row(
        "CLICK", "spindle override", lambda runner, value: _choose(runner, "SPINDLE", value)
    ),
}
"""The console commands, by name."""

COMMAND_LIST = ", ".join(
    f"{f'{name} {row.value}'.strip()} ({row.meaning})" for name, row in COMMANDS.items()
)


def _choose(runner: "Runner", name: str, click: str) -> None:
    from openacr.mill.config.overrides import Override

    if not click.isdecimal():
        raise UserError("a click of the switch is a whole number from 0")
    runner.overrides.choose(Override[name], int(click))


def command(words: list[str]) -> Callable[["Runner"], object]:
    """Parse a line: a command, with its value if it takes one, such as fov 7."""
    name, *rest = words
    row = COMMANDS.get(name)
    if row is None or len(rest) != bool(row.value):
        known = ", ".join(f"{name} {row.value}".strip() for name, row in COMMANDS.items())
        raise UserError(f"unknown command; commands are {known}")
    value = rest[0] if rest else ""
    return lambda runner: row.act(runner, value)
