"""A real machine asks its operator, and is looked at while he thinks."""

import os
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import TextIO

import pytest
from tests.cli.keys import arrived
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.mill.console import Console
from openacr.cli.mill.terminal import Attendant, require_yes
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store

ROOT = Path(__file__).parents[2]
ESTOP, LUBRICATION = 400_004, 400_012
SPINDLE_CW = 800_005


class Terminal:
    """A pipe that takes itself for a terminal."""

    def __init__(self, source: TextIO) -> None:
        self._source = source

    def isatty(self) -> bool:
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self._source)


class Bench:
    """A machine on a card, and the keys of its operator."""

    def __init__(
        self, keys: TextIO, terminal: TextIO, cells: dict[int, float] | None = None
    ) -> None:
        store = Store()
        for axis in range(3):
            store.write(200_007 + 1000 * axis, 0)
        for number, value in (cells or {}).items():
            store.write(number, value)
        self.controller = Controller()
        self.shop = MillSession.real(self.controller, store, lambda _text: None)
        self.shop.card.command("DRIVE ON X Y Z", program=0)
        self.keys = keys
        self.attend = Attendant(terminal)

    def start(self, text: str) -> None:
        self.shop.start(load(text, self.shop.cells), Start())

    def steps(self, count: int = 50) -> None:
        for _ in range(count):
            self.shop.step()
            self.attend(self.shop)

    def type(self, line: str) -> None:
        self.keys.write(f"{line}\n")
        arrived(self.attend._lines)
        self.steps()


@pytest.fixture
def wires() -> Iterator[tuple[TextIO, TextIO]]:
    reading, writing = os.pipe()
    with os.fdopen(writing, "w", buffering=1) as keys, os.fdopen(reading) as source:
        yield keys, Terminal(source)  # type: ignore[misc]
        keys.close()


def test_a_stop_is_asked_once_and_only_a_yes_goes_on(
    wires: tuple[TextIO, TextIO], capsys: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(*wires)
    bench.start("G1 F600 X.1\nM0\nG1 X.2\nM2\n")
    bench.steps()
    assert capsys.readouterr().err == "M0: continue? [Y/n] "
    bench.type("what")
    assert "what: say y or n" in capsys.readouterr().err
    assert bench.shop.runner.state is State.HOLD
    bench.type("y")
    assert (bench.shop.runner.state, bench.controller.p[12288]) == (State.IDLE, 2000)


def test_the_emergency_stop_does_not_wait_for_an_answer(wires: tuple[TextIO, TextIO]) -> None:
    bench = Bench(*wires, {ESTOP: 5, SPINDLE_CW: 40})
    bench.start("M3 S500\nM0\nG1 F600 X1\nM2\n")
    bench.steps()
    assert bench.controller.bit[40]
    bench.controller.set_input(5, True)
    bench.steps(3)
    assert (bench.shop.runner.state, bench.controller.bit[40]) == (State.ALARM, False)
    bench.type("y")
    assert bench.controller.p[12288] == 0


def test_a_tool_without_a_signal_is_confirmed_at_the_terminal(
    wires: tuple[TextIO, TextIO], capsys: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(*wires)
    bench.start("T3\nM6\nG1 F600 X.1\nM2\n")
    bench.steps()
    assert "load tool 3: done? [Y/n]" in capsys.readouterr().err
    assert bench.shop.runner.state is State.WAIT
    bench.type("")
    assert (bench.shop.runner.state, bench.shop.cells.read(235)) == (State.IDLE, 3)


def test_an_input_takes_a_number_and_nothing_else(
    wires: tuple[TextIO, TextIO], capsys: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(*wires)
    bench.start('INPUT "depth",P200\nM2\n')
    bench.steps()
    bench.type("deep")
    assert "deep: enter a number" in capsys.readouterr().err
    bench.type("1.5")
    assert bench.shop.cells.read(200) == 1.5


def test_an_alarm_that_holds_is_acknowledged_and_the_program_resumed(
    wires: tuple[TextIO, TextIO], capsys: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(*wires, {LUBRICATION: 8})
    bench.start("G1 F600 X5\nM2\n")
    bench.steps(10)
    bench.controller.set_input(8, True)
    bench.steps()
    assert "Lubrication error: acknowledge and resume? [Y/n]" in capsys.readouterr().err
    bench.type("y")
    assert bench.shop.runner.state is State.PAUSED  # the cause is still there
    bench.controller.set_input(8, False)
    bench.steps()
    bench.type("y")
    bench.steps(50)
    assert (bench.shop.runner.state, bench.controller.p[12288]) == (State.IDLE, 50000)


def test_without_an_operator_a_stop_ends_the_program(wires: tuple[TextIO, TextIO]) -> None:
    bench = Bench(*wires)
    with open(os.devnull) as no_terminal:
        bench.attend = Attendant(no_terminal)
        bench.start("M0\nG1 F600 X1\nM2\n")
        with pytest.raises(UserError, match="M0: no operator at a terminal"):
            bench.steps()


# --- commands ---------------------------------------------------------------------------


@pytest.fixture
def card(monkeypatch: pytest.MonkeyPatch) -> Controller:
    """A card of --host, whatever is named there."""
    controller, real = Controller(), MillSession.real
    monkeypatch.setattr(MillSession, "real", lambda _host, *rest: real(controller, *rest))
    return controller


def mill(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *words, "--host", "card"])
    return result.exit_code, result.output


@pytest.mark.req("MILL-ALM-CLEAR")
def test_a_killed_card_is_acknowledged_before_anything_runs(card: Controller) -> None:
    card.bit[8467] = True
    code, text = mill("jog", "X1")
    assert (code, "alarm 14" in text, "`openacr mill acknowledge`" in text) == (2, True, True)
    assert mill("acknowledge") == (0, "cleared: alarm 14: Card killed moves\n")
    assert mill("acknowledge") == (0, "no alarms\n")
    assert mill("mdi", "G4 F.1")[0] == 0


def test_acknowledge_names_an_alarm_that_stays_once_and_those_it_has_cleared(
    card: Controller, own_store: Path
) -> None:
    with Store(own_store) as store:
        store.write(ESTOP, 4)
    card.set_input(4, True)
    assert mill("acknowledge") == (1, "alarm 10: Emergency stop\n")
    card.set_input(4, False)
    assert mill("acknowledge") == (0, "cleared: alarm 10: Emergency stop\n")


@pytest.mark.parametrize(
    "words",
    [["jog", "X1"], ["home"], ["mdi", "G4 F.1"], ["run", "PART.NC"], ["run", "PART.NC", "--json"]],
)
def test_an_alarm_that_refuses_a_start_ends_with_the_exit_code_of_the_documentation(
    words: list[str], card: Controller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    (row,) = [row for row in page.splitlines() if "an alarm that refuses a start" in row]
    monkeypatch.chdir(tmp_path)
    Path("PART.NC").write_text("G4 F.1\nM2\n")
    card.bit[8467] = True
    code, text = mill(*words)
    assert (f"| {code} |" in row, "alarm 14" in text) == (True, True)


def test_a_homing_that_fails_says_that_no_axis_is_homed(
    card: Controller, monkeypatch: pytest.MonkeyPatch
) -> None:
    homing = MillSession.home

    def killed(shop: MillSession, names: str, attend: Callable[[MillSession], None]) -> list[str]:
        def kill(_shop: MillSession) -> None:
            card.bit[8467] = True

        return homing(shop, names, kill)

    monkeypatch.setattr(MillSession, "home", killed)
    code, text = mill("home", "--axes", "X")
    assert (code, "homed: none\n" in text, "alarm 14" in text) == (1, True, True)


def test_a_homing_without_axes_to_home_says_so(card: Controller, own_store: Path) -> None:
    with Store(own_store) as store:
        store.write(300_009, 0)
    assert mill("home", "--axes", "X") == (0, "homed: no axis has a priority\n")


def test_mdi_reads_the_dialect_of_the_store(card: Controller, own_store: Path) -> None:
    with Store(own_store) as store:
        store.write(700_005, 1)
    code, text = mill("mdi", "#<depth>=[1+1]", "G4 P0.1")
    assert (code, "error" in text) == (0, False)


# --- start at a line --------------------------------------------------------------------

CUT = "G0 Z1\nG0 X1\nM3 S500\nM8\nG1 Z-1 F600\nG1 X3\nG1 X5\nM2\n"
FLOOD = 800_010


@pytest.fixture
def part(tmp_path: Path, own_store: Path, card: Controller) -> str:
    """A program that cuts at Z-1, and a machine whose tool is at depth, 3 inches away."""
    with Store(own_store) as store:
        for axis in range(3):
            store.write(200_007 + 1000 * axis, 0)
        store.write(SPINDLE_CW, 40)
        store.write(FLOOD, 41)
    file = tmp_path / "CUT.NC"
    file.write_text(CUT)
    shop = MillSession.real("card", Store())
    shop.card.command("DRIVE ON X Y Z", program=0)
    shop.card.command("RES X4 Z-1", program=0)
    shop.close()
    return str(file)


def states(card: Controller, monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, ...]]:
    """X and Z in inches, spindle and flood, at every look of a run."""
    seen: list[tuple[float, ...]] = []
    real = MillSession.step

    def step(shop: MillSession) -> None:
        real(shop)
        x, z = card.p[12288] / 1e4, card.p[12288 + 512] / 1e4
        seen.append((x, z, float(card.bit[40]), float(card.bit[41])))

    monkeypatch.setattr(MillSession, "step", step)
    return seen


def test_a_start_in_the_cut_retracts_and_comes_down_with_the_spindle_on(
    card: Controller, part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = states(card, monkeypatch)
    code, text = mill("run", part, "--line", "7", "--yes", "--quiet")
    assert (code, seen[-1][:2]) == (0, (5.0, -1.0))
    assert "spindle: now off, at the line clockwise" in text
    assert "position: now 4 0 -1 0 0 0 0 0, at the line 3 0 -1 0 0 0 0 0" in text
    over = [(x, z) for x, z, *_ in seen if 3.0 < x < 4.0]
    assert over[0][1] == 1.0  # on the way back all of it above the part
    down = [(spin, flood) for x, z, spin, flood in seen if x == 3.0 and -1.0 < z < 1.0]
    assert down
    assert set(down) == {(1.0, 1.0)}


def test_a_start_at_a_line_is_not_agreed_to_without_an_operator(
    card: Controller, part: str
) -> None:
    code, text = mill("run", part, "--line", "7")
    assert (code, card.p[12288], card.p[12800]) == (2, 40000, -10000)
    assert "spindle: now off, at the line clockwise" in text
    assert "no operator at a terminal to confirm; use --yes" in text


def test_a_level_that_only_the_operator_knows_is_asked_for(card: Controller, part: str) -> None:
    Path(part).write_text("G1 Z-1 F600\nX3\nX5\nM2\n")
    code, text = mill("run", part, "--line", "3", "--yes")
    assert (code, "its machine position has to be given (Safe Z, --safe-z)" in text) == (2, True)
    assert mill("run", part, "--line", "3", "--yes", "--safe-z", "0.5", "--quiet")[0] == 0
    assert (card.p[12288], card.p[12800]) == (50000, -10000)


@pytest.mark.parametrize(("typed", "is_agreed"), [("y", True), ("YES", True), ("", False)])
def test_only_a_yes_starts(
    wires: tuple[TextIO, TextIO],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    typed: str,
    is_agreed: bool,
) -> None:
    bench = Bench(*wires)
    to_type = iter([f"{typed}\n"])

    def step() -> None:
        bench.keys.write(next(to_type, ""))
        time.sleep(0.01)

    monkeypatch.setattr(bench.shop, "step", step)
    if is_agreed:
        require_yes(bench.shop, bench.attend, "start?", "no_terminal")
    else:
        with pytest.raises(UserError, match="not started"):
            require_yes(bench.shop, bench.attend, "start?", "no_terminal")
    assert capsys.readouterr().err == "start? [y/N] "


# --- STOP and ABORT -----------------------------------------------------------------------


@pytest.mark.req("MILL-RUN-STOP")
def test_stop_ramps_to_rest_and_the_status_line_shows_the_pause(
    wires: tuple[TextIO, TextIO], capsys: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(*wires)
    console = Console(wires[1])
    bench.attend = console.attend  # type: ignore[assignment]
    bench.start("G90 F600\nG1 X8\nM2\n")
    bench.steps(10)
    assert capsys.readouterr().err == "RUN\n"
    cruise_ups = bench.controller.axis(0).velocity_ups
    bench.keys.write("stop\n")
    arrived(console._lines)
    console.attend(bench.shop)
    speeds = [bench.controller.axis(0).velocity_ups]
    while speeds[-1] > 0.0:
        bench.controller.advance(1)
        speeds.append(bench.controller.axis(0).velocity_ups)
    assert cruise_ups == pytest.approx(200 / 60)
    steps = [before - after for before, after in pairwise(speeds) if before > after]
    deceleration_ups2 = bench.shop.runner.settings.speeds.feed_acc_ups2
    assert max(steps) == pytest.approx(deceleration_ups2 * bench.controller.period_s, rel=0.01)
    bench.steps(5)
    assert capsys.readouterr().err == "----PAUSE----\n"
    bench.keys.write("resume\n")
    arrived(console._lines)
    bench.steps(300)
    assert capsys.readouterr().err == "RUN\nIDLE\n"
    assert bench.controller.p[12288] == 80_000


@pytest.mark.req("MILL-BATCH-ABORT")
@pytest.mark.parametrize(
    ("typed", "code", "ran"),
    [(["y", "y"], 0, ["ONE", "TWO", "TWO", "THREE"]), (["n"], 1, ["ONE", "TWO"]),
     (["y", "n"], 1, ["ONE", "TWO", "TWO"])],
)  # fmt: skip
def test_an_abort_cancels_the_rest_of_a_batch(
    card: Controller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    typed: list[str], code: int, ran: list[str],
) -> None:  # fmt: skip
    for name, text in (("ONE", "G4 F.1"), ("TWO", "M0"), ("THREE", "G4 F.1")):
        (tmp_path / f"{name}.NC").write_text(f"(MSG, {name})\n{text}\nM2\n")
    (tmp_path / "SHIFT.BAT").write_text("ONE.NC\nTWO.NC L2\nTHREE.NC\n")
    monkeypatch.setattr(Attendant, "answer", lambda *_words: typed.pop(0))
    ended, text = mill("batch", str(tmp_path / "SHIFT.BAT"))
    assert (ended, typed) == (code, [])
    assert [line for line in text.splitlines() if line in ("ONE", "TWO", "THREE")] == ran
    assert ("aborted by the operator" in text) is bool(code)
