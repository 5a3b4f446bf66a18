"""A card that AcroMill has not set up is opened as it is, and stays so until that is agreed on."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.mill.live import SERVE, Process
from tests.panel.bench import HandStation
from tests.panel.remote import Remote
from tests.waiting import until

from openacr.client import Card
from openacr.controller import Controller
from openacr.map.rows import axes
from openacr.panel.control.machine.installation import Installation
from openacr.panel.machine import embedded, opened

GANTRY = Path(__file__).parents[2] / "examples" / "gantry"
LACKS = "AcroMill's axis Z is not attached on this card: Z is AXIS2 of MASTER1"


def setup_of(card: Card, folder: Path) -> dict[str, str]:
    """Everything that a terminal can read."""
    card.backup(folder)
    return {each.name: each.read_text() for each in sorted(folder.iterdir())}


@pytest.fixture
def foreign(tmp_path: Path) -> Iterator[HandStation]:
    """The gantry, with a store that does not know it."""
    controller = Controller.from_project(GANTRY)
    (tmp_path / "programs").mkdir()
    installation = Installation.inside(
        controller, opened(tmp_path / "sysvar.db"), tmp_path / "programs"
    )
    installation.is_agreed = False
    hand = HandStation(tmp_path, installation=installation)
    yield hand
    hand.close()


def controller_of(hand: HandStation) -> Controller:
    assert hand.installation.controller is not None
    return hand.installation.controller


def test_a_card_is_opened_without_touching_its_set_up(foreign: HandStation, tmp_path: Path) -> None:
    with Card.open(controller_of(foreign)) as card:
        before = setup_of(card, tmp_path / "before")
        foreign.run(2.0)
        for name, args in (
            ("card.query", {"line": "ATTACH", "program": 1}),
            ("scope.arm", {"channels": ["P12288"], "samples": 100}),
            ("memory.read", {}),
            ("watch.begin", {"topic": "watch", "hz": 10, "parameters": [12288]}),
            ("tune.gains", {"axis": "Z"}),
        ):
            foreign.do(name, **args)
            foreign.run(0.2)
        foreign.station.close()
        after = setup_of(card, tmp_path / "after")
    assert after == before


def test_acromill_says_what_it_misses_and_refuses_what_needs_it(foreign: HandStation) -> None:
    assert foreign.events("machine")[-1]["lacks"] == LACKS
    state, alarms = foreign.events("state")[-1], foreign.events("alarms")[-1]
    assert (state["link"], state["state"]) == ("ok", "IDLE")
    assert (alarms["active"], alarms["bars_start"]) == ([], True)
    for name, args in (
        ("home.start", {"axes": "X"}),
        ("mdi.execute", {"line": "G1 X1 F100"}),
        ("handwheel", {"axes": "X"}),
        ("zero.set", {"axes": "X"}),
    ):
        assert foreign.refused(name, **args)["text"] == LACKS
    assert foreign.press(1)["error"]["text"] == LACKS


def begin_program(hand: HandStation) -> None:
    hand.do("card.run", program=0)


def begin_jog(hand: HandStation) -> None:
    hand.do("term.open")
    for line in ("PROG1", "DRIVE ON Z", "JOG ACC Z50", "JOG DEC Z50", "JOG VEL Z1", "JOG FWD Z"):
        hand.do("term.line", text=line)
        hand.run(0.1)


def moves(hand: HandStation) -> bool:
    before = [controller_of(hand).p[row] for row in axes.primary_setpoint]
    hand.run(0.2)
    return before != [controller_of(hand).p[row] for row in axes.primary_setpoint]


@pytest.mark.parametrize("stop", ["stop.hold", "stop.all", "stop.estop"])
@pytest.mark.parametrize("begin", [begin_program, begin_jog])
def test_a_card_that_acromill_has_not_set_up_is_stopped(
    foreign: HandStation, begin: Callable[[HandStation], None], stop: str
) -> None:
    begin(foreign)
    foreign.until(lambda: moves(foreign))
    foreign.do(stop)
    foreign.run(1.3)
    assert not moves(foreign)
    assert foreign.events("stopped")[-1]["moving"] == []


def test_the_lamp_shows_what_a_card_does_that_acromill_has_not_set_up(
    foreign: HandStation,
) -> None:
    foreign.do("card.run", program=0)
    foreign.until(lambda: bool(foreign.events("lamp")[-1]["moving"]))
    lamp = foreign.events("lamp")[-1]
    assert lamp["running"] == ["PROG0"]
    assert set(lamp["moving"]) <= {"X", "Y", "Z"}
    assert lamp["drives"][:2] == ["X", "Y"]


def test_what_stop_has_held_is_resumed_without_a_set_up(foreign: HandStation) -> None:
    foreign.do("card.run", program=0)
    foreign.until(lambda: moves(foreign))
    foreign.do("stop.hold")
    foreign.run(2.0)
    assert not moves(foreign)
    foreign.do("run.resume")
    foreign.until(lambda: moves(foreign))


def test_a_card_is_set_up_once_that_is_agreed_on(foreign: HandStation) -> None:
    assert foreign.refused("card.setup")["text"].endswith("Axis already attached")
    assert foreign.installation.lacks.endswith("Axis already attached")
    with Card.open(controller_of(foreign)) as card:
        card.command("DETACH", program=1)
    foreign.do("card.setup")
    foreign.run(0.1)
    assert foreign.installation.lacks == foreign.events("machine")[-1]["lacks"] == ""
    assert foreign.refused("card.setup")["text"] == "AcroMill has set this card up already"


def test_what_moves_is_never_set_up(foreign: HandStation) -> None:
    foreign.do("card.run", program=0)
    foreign.until(lambda: bool(foreign.events("lamp")[-1]["moving"]))
    assert foreign.refused("card.setup")["text"].startswith("the machine is moving")
    assert moves(foreign)


def test_a_card_of_the_panel_that_moves_is_set_up_once_it_rests_and_no_stop_holds_it(
    tmp_path: Path,
) -> None:
    installation = embedded(tmp_path)
    assert installation.controller is not None
    with Card.open(installation.controller) as other:
        other.command("ATTACH MASTER0", program=0)
        other.command('ATTACH SLAVE0 AXIS0 "X"', program=0)
        for line in ("PPU X1000", "DRIVE ON X", "JOG ACC X20", "JOG DEC X20", "JOG VEL X1"):
            other.command(line, program=0)
        for line in ("PROGRAM", "_wait", "DWL 1", "GOTO wait", "ENDP"):
            other.command(line, program=3)
        other.run(3)
        other.command("JOG FWD X", program=0)
        hand = HandStation(tmp_path, installation=installation)
        try:
            assert installation.lacks.startswith("the machine is moving")
            hand.do("stop.hold")
            hand.run(6.0)
            assert installation.lacks
            assert not moves(hand)
            hand.do("run.resume")  # the program goes on, the axis rests
            hand.until(lambda: not installation.lacks)
            assert hand.station.link.machine.is_set_up
        finally:
            hand.close()


def test_a_served_card_with_other_axes_keeps_its_set_up_and_its_motion(tmp_path: Path) -> None:
    process = Process(SERVE[0], str(GANTRY), *SERVE[1:], "--no-journal", store=tmp_path / "card.db")
    try:
        until(lambda: "ascii=" in process.text, about="the card is served")
        address = process.text.partition("ascii=")[2].split()[0]
        with Card.open(address) as card:
            before = setup_of(card, tmp_path / "before")
            card.command("RUN PROG0")
            until(lambda: card.master(0).is_in_motion)
            remote = Remote(address, tmp_path, is_agreed=False)
            try:
                until(lambda: remote.link() == "ok")
                assert remote.installation.lacks == LACKS
                assert card.read_bit("prog0.program running")
                assert remote.send("card.query", line="MEM")["ok"]
            finally:
                remote.close()
            card.halt()
            until(lambda: not card.master(0).is_in_motion)
            assert setup_of(card, tmp_path / "after") == before
    finally:
        process.close()
