"""Character I/O: INPUT, and the keys of a device."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from msgspec import Struct

from openacr.basic.channels.devices import Key
from openacr.basic.commands import strings
from openacr.basic.commands.character_io import (
    DEVICES,
    GROUP,
    at_separator,
    read_device,
)
from openacr.basic.language.grammar import Form, Lvalue, Repeat
from openacr.basic.language.nodes import Expr, is_text
from openacr.basic.language.registry import PROG, PROGRAM, command, function
from openacr.basic.vm.run import LINE_END, Run, Show, Wait, WaitKind
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.map.rows import devices as device_rows
from openacr.messages import INVALID_DEVICE

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser


class InputItem(Struct, frozen=True):
    """INPUT as written: `;` directly after the word, device, prompt, variables."""

    keeps_line: bool
    device: int
    prompt: Expr | None
    targets: tuple[Expr, ...]


class InputList(Form):
    """`{;} {#d{,|;}} {"prompt"{;|,}} var {, var}...`."""

    def starts(self, p: Parser) -> bool:
        """Whether anything is left in the block."""
        return not p.cursor.at_block_end

    def parse(self, p: Parser) -> InputItem:
        """Read everything."""
        keeps_line = p.cursor.accept(";")
        device = read_device(p) if p.cursor.is_operator("#") else 0
        prompt = None
        if p.cursor.token.kind is TokenKind.STRING:
            prompt = p.expressions.expression()
            if at_separator(p):
                p.cursor.advance()
        targets = Repeat(Lvalue("variable"), separator=",").parse(p)
        return InputItem(keeps_line, device, prompt, cast(tuple[Expr, ...], targets))


@command(
    "INPUT",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(InputList("variables"),),
    ref="PG Character I/O",
)
def input_(run: Run, item: InputItem) -> Wait | None:
    """Send a prompt, wait for a line from the device and store its fields."""
    devices = run.system.devices
    key = (run.needed_program(), item.device)
    devices.check_open(key)
    row = devices.row(key, device_rows.prompted)
    if not run.card.memory.I[row]:
        devices.write(key, run.text(item.prompt) if item.prompt is not None else "? ")
        run.card.memory.I[row] = 1
        run.system.listeners.set_line_end(key[0], not item.keeps_line)
    line = devices.read_line(key)
    if line is not None and not _store_fields(run, item.targets, line):
        devices.write(key, "Redo" + LINE_END)
        line = None
    if line is None:
        return _until_received(run, key, device_rows.lines)
    run.card.memory.I[row] = 0
    run.system.listeners.set_line_end(key[0], True)
    return None


def _store_fields(run: Run, targets: tuple[Expr, ...], line: str) -> bool:
    """Store the fields between commas; a string that comes last takes the rest."""
    takes_rest = is_text(targets[-1])
    fields = line.split(",", len(targets) - 1) if takes_rest else line.split(",")
    if len(fields) < len(targets):
        return False
    for target, text in zip(targets, fields, strict=False):
        run.assign(target, text if is_text(target) else strings.val(text))
    return True


def _until_received(run: Run, key: Key, row: tuple[int, ...]) -> Wait:
    place = run.system.devices.row(key, row)
    return Wait(WaitKind.ROW_ABOVE, place, 0, retry=True, show=Show.INHIBITED)


# keys


def _key(run: Run, device: float) -> Key:
    if not 0 <= device <= DEVICES:
        raise CardError(INVALID_DEVICE)
    key = (run.needed_program(), int(device))
    run.system.devices.check_open(key)
    return key


def inkey(run: Run, device: float = 0) -> str:
    """One waiting character of a device, or an empty string; never waits."""
    return str(run.system.devices.read_key(_key(run, device)))


def getch_text(run: Run, device: float = 0) -> str | Wait:
    """Wait for one character of a device."""
    key = _key(run, device)
    return run.system.devices.read_key(key) or _until_received(run, key, device_rows.characters)


def getch(run: Run, device: float = 0) -> float | Wait:
    """Wait for one character of a device and give its code."""
    character = getch_text(run, device)
    return character if isinstance(character, Wait) else float(ord(character))


def kbhit(run: Run, device: float = 0) -> float:
    """Tell whether a character waits on a device: -1 or 0."""
    row = run.system.devices.row(_key(run, device), device_rows.characters)
    return -1.0 if run.card.memory.I[row] else 0.0


for _name, _apply in (
    ("INKEY$", inkey),
    ("GETCH$", getch_text),
    ("GETCH", getch),
    ("KBHIT", kbhit),
):
    function(_name, "n", fewest=0, apply=_apply, summary=str(_apply.__doc__), wants_run=True)
