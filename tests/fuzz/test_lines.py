"""Whatever is typed or stored, the card answers, stays small and goes on."""

import gc
import re
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st
from tests.basic.parsing import parse_line
from tests.controller.hosts import X_AND_Y, Host
from tests.fuzz.programs import BROKEN, Programs
from tests.search import examples, search

from openacr.basic.language.nodes import Number, Parameter
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.vm.compiler import compile_program
from openacr.basic.vm.levels import CompileError
from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.errors import CardError, MapError
from openacr.map.memory import Memory
from openacr.project import Place, SourceFile, read_source
from openacr.source_check.faults import Fault
from openacr.source_check.source import Reader

SET_UP = (
    "SYS", "DIM PROG1(8000)", "DIM PROG2(8000)", "DIM P(100)", "DIM DEF(10)", "#DEFINE count P3",
    *X_AND_Y, "DIM LV(5)", "DIM SV(5)", "DIM DV(5)", "DIM $V(3,20)", "DIM LA(2)", "DIM LA0(5)",
)  # fmt: skip
LINES_A_CARD = 2000
MOST_BLOCKS = 60_000  # objects a card and its hosts may add while it is treated badly
OWN = "PROG0"


class Victim:
    """A card, the host that types, and a host that sees whether the card still answers."""

    def __init__(self) -> None:
        card = Controller()
        card.is_journalled = False
        self.host = Host(card)
        self.host.type(*SET_UP)

    def line(self, text: str) -> str:
        """Type a line; one that waits for ever is left to itself."""
        answer = self.host.send(text + "\r")
        assert "Traceback" not in answer
        if self.host.card.streams.is_busy(self.host.stream):
            self.host.card.advance(2)
        return answer + self._free()

    def _free(self) -> str:
        """Leave what only the host can end: a line that waits, LISTEN, a device."""
        if not self.host.card.streams.is_busy(self.host.stream):
            return self.host.send("\x1b")
        self.host.close()
        self.host.stream = self.host.card.open_stream(StreamKind.TERMINAL)
        return self.host.send(f"{OWN}\r")

    def run(self, lines: list[str], ticks: int) -> None:
        """Store a program, run it for some ticks and take it away again."""
        for line in ("HALT ALL", OWN, "NEW", "PROGRAM", *lines, "ENDP"):
            self.line(line)
        self.line("RUN")
        for _ in range(3):
            self.host.card.advance(ticks)
            self.line("LIST")
            self.line("BIT33 = NOT BIT33")
        self.line("HALT ALL")

    def is_well(self) -> None:
        """The card answers on a fresh stream, whatever was done to it."""
        self.host.close()
        self.host.card.system.restart()
        assert Host(self.host.card).ask("?1+1") == "2"


def at_the_prompt(seed: int, count: int) -> None:
    source = Programs(seed)
    for _ in range(0, count, LINES_A_CARD):
        victim = Victim()
        for number in range(LINES_A_CARD):
            victim.line(source.line())
            victim.host.card.advance(number % 2)
        victim.is_well()


def stored(seed: int, count: int) -> int:
    """Programs of 25 to 60 lines, stored and run; how many lines there were."""
    source = Programs(seed)
    done = 0
    while done < count:
        victim = Victim()
        for _ in range(LINES_A_CARD // 40):
            lines = source.program(source.random.randrange(20, 55))
            done += len(lines)
            victim.run(lines, 40)
        victim.is_well()
    return done


@pytest.mark.search
def test_thousands_of_lines_at_the_prompt() -> None:
    at_the_prompt(1, examples(10_000, 4))


@pytest.mark.search
def test_thousands_of_lines_in_stored_programs() -> None:
    assert stored(2, examples(10_000, 4)) >= examples(10_000, 4)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(100, 125))
def test_half_a_million_lines_at_the_prompt(seed: int) -> None:
    at_the_prompt(seed, 20_000)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(200, 225))
def test_half_a_million_lines_in_stored_programs(seed: int) -> None:
    assert stored(seed, 20_000) >= 20_000


@cache
def any_victim() -> Victim:
    """A card for all examples."""
    return Victim()


@search(60, suppress_health_check=list(HealthCheck))
@given(st.lists(st.text(st.characters(max_codepoint=255), max_size=60), max_size=12))
def test_any_characters_at_all(lines: list[str]) -> None:
    victim = any_victim()
    for line in lines:
        victim.line("".join(c for c in line if ord(c) >= 32))
    victim.line("HALT ALL")


def accepted(lines: list[str]) -> list[str]:
    """The lines a program can hold."""
    scope = Scope(Level.PROG, True, frozenset("XY"), {"count": Parameter(Number(3))})
    found = []
    for line in lines:
        with suppress(CardError):
            parse_line(line, scope)
            found.append(line)
    return found


def is_met_when_run(fault: Fault) -> bool:
    """Whether the line names a parameter, flag or axis there is not, as the fault says."""
    named = [float(number) for number in re.findall(r"\d+\.?\d*(?:[Ee][+-]?\d+)?", fault.text)]
    if fault.message == "Invalid parameter":
        number = int(fault.hint.removeprefix("there is no parameter P"))
        return number in map(int, named) and not is_parameter(number)
    if fault.message == "Invalid bit":
        return fault.hint == "flags are 0 to 17663" and max(named) > 17663
    return (
        fault.message == "Invalid argument"
        and fault.hint == "the card has axes 0 to 15"
        and "AXIS" in fault.text.upper()
        and max(named) > 15
    )


def is_parameter(number: int) -> bool:
    """Whether a card has it: P0 to P4095, else what its memory can read."""
    try:
        return number < 4096 or Memory().read(number) is not None
    except (CardError, MapError):
        return False


@search(150)
@given(st.integers(0, 1 << 32), st.integers(1, 40))
def test_the_check_of_a_file_agrees_with_run(seed: int, length: int) -> None:
    """A program whose lines are all accepted fits together for both, or for neither."""
    reader = Reader()
    text = "\n".join(["PROGRAM", *accepted(Programs(seed).program(length)), "ENDP", ""])
    reader.aliases = {"count": Parameter(Number(3))}
    reader.axes = {0: {"X": 0, "Y": 1}}
    reader.read(SourceFile(Path("prog0.8k"), text.encode(), Place.PROGRAM))
    faults = [fault for fault in reader.faults if not fault.is_warning]
    found = {fault.message for fault in faults}
    found = {message for message in found if "not found" not in message}
    (program,) = reader.texts.values()
    try:
        compile_program((line.number, line.tree) for line in program.stored())
    except CompileError as error:
        assert error.text in found
    else:
        # what a running program meets: the check foresees it, the compiler does not
        others = [fault for fault in faults if fault.message in found - {"Undefined variable"}]
        assert [fault for fault in others if not is_met_when_run(fault)] == []


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_broken_files_are_survived(path: Path) -> None:
    reader = Reader()
    reader.read(read_source(path, Place.PROGRAM, 0))
    assert reader.faults
    victim = Victim()
    victim.run(path.read_text().splitlines(), 50)
    victim.is_well()


def test_memory_is_bounded() -> None:
    victim = Victim()
    source = Programs(5)

    def treat() -> int:
        for _ in range(600):
            victim.line(source.line())
        victim.run(source.program(40), 20)
        gc.collect()
        return sys.getallocatedblocks()

    treat()
    before = treat()
    assert max(treat() for _ in range(3)) - before < MOST_BLOCKS
