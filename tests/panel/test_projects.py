"""Projects at the screens: every example opens; a project has settings of its own."""

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.panel.bench import HandStation

from openacr.client import Card, Level
from openacr.client.card_axes import attached
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.lang.attachments import Attached
from openacr.map.rows import axes
from openacr.panel.commands.all import carry_out
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.station import Station
from openacr.panel.machine import embedded
from openacr.panel.machine.project import of_project
from openacr.sysvar.tabs import AXIS
from openacr.tuning.settings import GAINS

EXAMPLES = Path(__file__).parents[2] / "examples"
SETTINGS = 'layout = 1\nunit = "mm"\n[AXES]\nP200006 = 800.0\n'

Open = Callable[[Path], Installation]


@pytest.fixture
def open_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Open]:
    """Opens projects; the store of the user is a new one."""
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "user.db"))
    opened: list[Installation] = []

    def of(folder: Path) -> Installation:
        opened.append(of_project(folder, store=None, programs=None, otherwise=tmp_path / "parts"))
        return opened[-1]

    yield of
    for each in opened:
        each.close()


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A folder with the machine of an example."""
    folder = tmp_path / "project"
    folder.mkdir()
    shutil.copy(EXAMPLES / "square" / "machine.toml", folder)
    return folder


@pytest.mark.parametrize("name", sorted(each.name for each in EXAMPLES.iterdir()))
def test_the_panel_opens_every_example(name: str, tmp_path: Path, open_project: Open) -> None:
    folder = shutil.copytree(EXAMPLES / name, tmp_path / name)
    station = Station(open_project(folder), carry_out)
    station.open(0.0)
    assert station.link.lost == ""
    station.close()


@pytest.mark.parametrize("name", ["gantry", "invk_arm"])
def test_the_axes_of_an_example_with_settings_keep_what_its_set_up_says(
    name: str, tmp_path: Path, open_project: Open
) -> None:
    installation = open_project(shutil.copytree(EXAMPLES / name, tmp_path / name))
    card = installation.controller
    assert card is not None
    rows = [row[axis] for axis in range(2) for row in (axes.ppu, *GAINS.values())]
    before = [card.p[row] for row in rows]
    station = Station(installation, carry_out)
    station.open(0.0)
    assert [card.p[row] for row in rows] == before
    station.close()


@pytest.mark.parametrize(("count", "words"), [(1, "1 variable"), (99, "99 variables")])
def test_a_card_with_too_few_variables_is_not_set_up_and_keeps_its_time(
    count: int, words: str, project: Path, open_project: Open
) -> None:
    (project / "setup.8k").write_text(f"DIM P({count})\n")
    station = Station(open_project(project), carry_out)
    station.open(100.0)
    assert station.installation.lacks == (
        f"the front end needs P0 to P99, the card has {words}: write DIM P(100) in its set-up"
        " (DIM P(100): Re-dimensioned block (NEW ALL and CLEAR at the SYS level free the memory))"
    )
    history = station.installation.history
    assert history is not None
    before_tk = history.lived_tk
    for step in range(1, 101):
        station.step(100.0 + 0.005 * step)
    assert history.lived_tk - before_tk == round(0.5 / history.period_s)


@pytest.mark.parametrize("count", [100, 150])
def test_a_card_with_as_many_variables_as_needed_or_more_is_left_as_it_is(
    count: int, project: Path, open_project: Open
) -> None:
    (project / "setup.8k").write_text(f"DIM P({count})\n")
    station = Station(open_project(project), carry_out)
    station.open(0.0)
    assert (station.link.lost, station.installation.lacks) == ("", "")
    assert station.link.machine.card.ask(f"P{count - 1}") == 0.0
    station.close()


def test_the_store_of_a_project_begins_with_its_settings_and_keeps_what_is_stored_later(
    project: Path, open_project: Open
) -> None:
    (project / "settings.toml").write_text(SETTINGS)
    first = open_project(project)
    assert first.store.path == project / "sysvar.db"
    assert (first.store.is_metric, first.store.read(AXIS.pulses_per_unit[0])) == (True, 800.0)
    first.store.write(AXIS.pulses_per_unit[0], 400.0)
    first.close()
    again = open_project(project).store
    assert again.read(AXIS.pulses_per_unit[0]) == 400.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{SETTINGS}P200006 = 1.0\n".encode(), "Cannot overwrite a value (at line 5, column 14)"),
        (b"# \xff\n", "not UTF-8 text"),
    ],
)
def test_wrong_settings_are_refused_and_leave_no_store(
    text: bytes, words: str, project: Path, open_project: Open
) -> None:
    (project / "settings.toml").write_bytes(text)
    with pytest.raises(UserError, match=re.escape(f"{project / 'settings.toml'}: {words}")):
        open_project(project)
    assert not (project / "sysvar.db").exists()


def test_a_project_without_settings_or_store_has_the_store_of_the_user(
    project: Path, tmp_path: Path, open_project: Open
) -> None:
    assert open_project(project).store.path == tmp_path / "user.db"
    assert not (project / "sysvar.db").exists()


def test_a_named_store_counts_before_that_of_the_project(
    project: Path, tmp_path: Path, open_project: Open
) -> None:
    (project / "settings.toml").write_text(SETTINGS)
    named = tmp_path / "named.db"
    installation = of_project(project, store=named, programs=None, otherwise=tmp_path / "parts")
    assert installation.store.path == named
    assert not (project / "sysvar.db").exists()
    installation.close()


def test_a_project_that_is_opened_first_leaves_the_virtual_mill_its_sample_parts(
    tmp_path: Path,
) -> None:
    data, shared = tmp_path / "data", tmp_path / "data" / "programs"
    project = tmp_path / "shop"
    project.mkdir()
    (project / "settings.toml").write_text("")
    (project / "prog0.8k").write_text("REM nothing\n")
    of_project(project, store=None, programs=None, otherwise=shared).close()
    assert list(shared.iterdir()) == []
    embedded(data).close()
    assert (shared / "plate.nc").is_file()
    for part in shared.iterdir():
        part.unlink()
    embedded(data).close()
    assert list(shared.iterdir()) == [], "what an operator has deleted stays deleted"


def test_an_axis_without_its_drive_is_not_jogged_and_with_it_fast_jog_trips_nothing(
    tmp_path: Path, open_project: Open
) -> None:
    folder = shutil.copytree(EXAMPLES / "gantry", tmp_path / "gantry")
    hand = HandStation(tmp_path, installation=open_project(folder))
    text = "the drive of axis X is off: DRIVE ON X switches it on"
    assert hand.press(1, fast=True)["error"]["text"] == text
    increment = hand.refused("jog.increment", axis="X", direction=1, preset=1, tick=hand.tick)
    assert increment["text"] == text
    assert hand.speeds() == (0.0, 0.0)
    hand.station.link.machine.card.command("AXIS0 DRIVE ON")
    hand.run(0.2)
    assert hand.press(2, fast=True)["ok"]
    hand.keep(2, 1.0)
    assert hand.places()[0] > 1.0
    assert hand.station.link.machine.runner.alarms.active == []
    hand.station.close()


def test_an_acknowledged_alarm_that_stays_says_what_ends_its_cause(
    tmp_path: Path, open_project: Open
) -> None:
    folder = shutil.copytree(EXAMPLES / "gantry", tmp_path / "gantry")
    hand = HandStation(tmp_path, installation=open_project(folder))
    card = hand.station.link.machine.card
    hand.station.link.machine.runner.jog(lambda jogging: jogging.increment(0, 1, 1, fast=True))
    hand.until(lambda: hand.state == "ALARM", limit_s=10.0)
    hand.run(1.0)
    (left,) = hand.do("alarm.acknowledge")["left"]
    assert left == (
        "Excess following error axis X: its drive has to be on (DRIVE ON X);"
        " REN X takes its position over"
    )
    card.command("AXIS0 DRIVE ON")
    hand.run(0.5)
    assert hand.do("alarm.acknowledge")["left"] == []
    hand.station.close()


def test_an_axis_of_the_card_alone_is_tuned_by_its_number_and_not_stored(
    tmp_path: Path, open_project: Open
) -> None:
    folder = shutil.copytree(EXAMPLES / "gantry", tmp_path / "gantry")
    hand = HandStation(tmp_path, installation=open_project(folder))
    card = hand.station.link.machine.card
    present = hand.do("tune.gains", axis="axis2")["P Gain"]
    assert present == pytest.approx(card.read("axis2.proportional gain"))
    given = {"axis": "AXIS2", "gain": "P Gain", "value": 0.002, "store": False}
    assert hand.do("gain.set", **given)["value"] == 0.002
    assert card.read("axis2.proportional gain") == pytest.approx(0.002)
    assert card.read("axis0.proportional gain") != pytest.approx(0.002)
    refused = hand.refused("gain.set", **{**given, "store": True})["text"]
    assert refused == "the machine has no AXIS2: its values are set without keeping them"
    assert hand.do("gain.set", **{**given, "axis": "AXIS1", "store": True})["is_stored"]
    known = "AXIS0, AXIS1, AXIS2, X, Y, Z"
    assert hand.refused("tune.gains", axis="AXIS8")["text"] == f"no axis AXIS8: there are {known}"
    card.command("AXIS2 DRIVE ON")
    hand.run(0.2)
    assert max(hand.do("tune.step", axis="AXIS2")["measured"]["setpoint_cnt"]) == 100.0
    hand.station.close()


def test_the_axes_of_a_card_are_those_that_its_programs_attach_to_their_masters() -> None:
    gantry = [Attached(0, 0, 0, "X"), Attached(0, 1, 1, "Y"), Attached(1, 0, 2, "Z")]
    with Card.open(Controller.from_project(EXAMPLES / "gantry")) as card:
        assert card.perform(attached) == gantry
        card.go(Level())
        card.command("ATTACH MASTER4", program=3)
        card.command('ATTACH SLAVE2 AXIS5 "A"', program=3)
        assert card.perform(attached) == [*gantry, Attached(4, 2, 5, "A")]
