"""The pane World on the card: inputs thrown by hand, faults, devices, the drawing and its files."""

import json
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.panel.bench import Client, HandStation, Served
from tests.panel.test_socket import talk

from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.panel.control.engineer.world import OUT_OF_REACH, WorldPane
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.plant.describe.load import parse_world
from openacr.sysvar import Store

DEVICES = """
[[axis]]
number = 0
name = "X"
units = "mm"
encoder_lines = 1000
units_per_rev = 10.0
travel = [-5.0, 305.0]
negative_limit = { at = 0.0, input = 1, contact = "closed" }
home = { between = [-1.0, 12.0], input = 2 }
drive = { mode = "exact" }

[[device]]
kind = "gripper"
outputs = { close = 34 }
inputs = { opened = 12, gripped = 13 }
sign = { at = [1, 2, 3], parent = "X" }
"""


class Reports:
    """What a client gets of the world."""

    def __init__(self, hand: HandStation) -> None:
        self.states: list[dict[str, Any]] = []
        hand.station.world.watchers.report = lambda _client, state: self.states.append(state)

    @property
    def last(self) -> dict[str, Any]:
        return self.states[-1]


@pytest.fixture
def card(hand: HandStation) -> Controller:
    controller = hand.installation.controller
    assert controller is not None
    return controller


def test_a_forced_input_is_seen_by_the_card_in_the_tick_in_which_it_is_given(
    hand: HandStation, card: Controller
) -> None:
    card.is_journalled = True
    tick = card.lived_tk
    assert not card.bit[0]
    hand.do("world.input", input=0, state="on")
    assert (card.lived_tk, card.bit[0]) == (tick, True)
    entry = card.journal[-1]
    assert (entry.tick, entry.what, entry.number, entry.value) == (tick, "input", 0, 1.0)
    hand.run(0.5)
    assert card.bit[0]
    hand.do("world.input", input=0, state="off")
    assert not card.bit[0]
    hand.do("world.input", input=0, state="released")
    assert (card.journal[-1].what, card.journal[-1].number) == ("release", 0)


def test_faults_begin_and_end_and_are_reported_with_their_values(hand: HandStation) -> None:
    reports = Reports(hand)
    hand.do("watch.begin", topic="world", hz=25)
    hand.run(0.1)
    assert reports.last["faults"] == []
    hand.do("world.fault", axis=1, kind="friction", value=0.25)
    hand.do("world.fault", axis=2, kind="motor-cable")
    hand.run(0.1)
    assert reports.last["faults"] == [
        {"axis": 1, "kind": "friction", "value": 0.25},
        {"axis": 2, "kind": "motor-cable", "value": 0.0},
    ]
    hand.do("world.mend", axis=1, kind="friction")
    hand.run(0.1)
    assert reports.last["faults"] == [{"axis": 2, "kind": "motor-cable", "value": 0.0}]
    hand.do("world.mend", axis=2)
    hand.run(0.1)
    assert reports.last["faults"] == []


def test_a_client_gets_what_has_changed_and_nothing_when_it_watches_no_more(
    hand: HandStation, card: Controller
) -> None:
    reports = Reports(hand)
    hand.do("watch.begin", topic="world", hz=25)
    hand.run(0.2)
    assert len(reports.states) == 1  # at rest
    assert reports.last["positions"] == pytest.approx(
        [card.world_view.now().positions[k] for k in range(3)]
    )
    hand.do("world.input", input=9, state="on")
    hand.run(0.2)
    assert len(reports.states) == 2
    assert (9 in reports.last["on"], reports.last["forced"]) == (True, [])
    hand.do("watch.end", topic="world")
    hand.do("world.input", input=9, state="off")
    hand.run(0.2)
    assert len(reports.states) == 2
    hand.do("watch.begin", topic="world", hz=25)
    hand.run(0.1)
    assert len(reports.states) == 3
    hand.station.leave(1)
    hand.station.join(hand.me)
    hand.do("world.input", input=9, state="on")
    hand.run(0.1)
    assert len(reports.states) == 3


@pytest.mark.parametrize(
    ("name", "args", "text"),
    [
        ("world.input", {"input": 40, "state": "on"}, "input 40: inputs are 0-31"),
        ("world.fault", {"axis": 5, "kind": "jam"}, "axis 5: the machine has no such axis"),
        ("world.fault", {"axis": 0, "kind": "supply", "value": 0}, "above 0 to 320 V"),
        ("world.fault", {"axis": 0, "kind": "rust"}, "Invalid enum value 'rust'"),
        ("world.mend", {"axis": 5}, "axis 5: the machine has no such axis"),
        (
            "world.command",
            {"device": "arm", "name": "part"},
            "device 'arm': the machine has no devices",
        ),
    ],
)
def test_what_the_world_does_not_have_is_refused(
    hand: HandStation, name: str, args: dict[str, Any], text: str
) -> None:
    assert text in hand.refused(name, **args)["text"]


@pytest.mark.parametrize("name", ["world.input", "world.fault", "world.mend", "world.command"])
def test_only_the_service_that_has_control_changes_the_world(hand: HandStation, name: str) -> None:
    setup = Person(2, Role.SETUP, "127.0.0.1")
    hand.station.join(setup)
    assert hand.refused(name, who=setup)["needs"] == "service"
    service = Person(3, Role.SERVICE, "127.0.0.1")
    hand.station.join(service)
    hand.do("control.take")
    args: dict[str, dict[str, Any]] = {
        "world.input": {"input": 1, "state": "on"},
        "world.fault": {"axis": 0, "kind": "jam"},
        "world.mend": {"axis": 0},
        "world.command": {"device": "arm", "name": "x"},
    }
    assert hand.refused(name, who=service, **args[name])["code"] == "control"
    assert hand.refused(name, old_s=2.0, **args[name])["code"] == "stale"


def test_every_change_is_in_the_log_with_who_made_it(
    hand: HandStation, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.INFO, "openacr.panel.control.engineer.world"):
        hand.do("world.input", input=3, state="on")
        hand.do("world.fault", axis=0, kind="friction", value=0.5)
        hand.do("world.mend", axis=0)
    assert caplog.messages == [
        "service 1: input 3 is on by hand", "service 1: the fault friction (0.5) of axis 0 begins",
        "service 1: the fault (all) of axis 0 ends",
    ]  # fmt: skip


def test_a_journal_of_what_was_done_by_hand_replays_to_the_same_state(
    hand: HandStation, card: Controller, tmp_path: Path
) -> None:
    path = tmp_path / "hand.oacrj"
    card.recorder = Recorder(card, path)
    hand.do("world.input", input=0, state="on")
    hand.run(0.05)
    hand.do("world.fault", axis=1, kind="friction", value=0.25)
    hand.do("world.fault", axis=2, kind="obstacle", value=-20.0)
    hand.run(0.05)
    hand.do("world.input", input=0, state="released")
    hand.do("world.mend", axis=1)
    hand.run(0.05)
    card.recorder.close()
    card.recorder = None
    again = Replay(read_journal(path))
    again.run()
    assert again.difference is None
    assert again.card.digest() == card.digest()


# --- what there is --------------------------------------------------------------------


@pytest.fixture
def pane(tmp_path: Path) -> Iterator[WorldPane]:
    controller = Controller(world=parse_world(DEVICES), device_folder=tmp_path)
    store = Store()
    yield WorldPane(Installation.inside(controller, store, tmp_path))
    store.close()
    controller.close()


def test_the_drawing_has_switches_in_millimetres_cut_at_the_ends_of_the_rail(
    pane: WorldPane,
) -> None:
    about = pane.about([])
    (link,) = about["links"]
    assert (link["name"], link["direction"], link["low"], link["high"]) == (
        "X", (1.0, 0.0, 0.0), -5.0, 305.0,
    )  # fmt: skip
    assert link["switches"] == [
        {"input": 1, "key": "negative_limit", "contact": "closed", "low": -5.0, "high": 0.0},
        {"input": 2, "key": "home", "contact": "open", "low": -1.0, "high": 12.0},
    ]
    json.dumps(about)
    assert about["inputs"][:2] == [
        {"input": 1, "what": "negative_limit of axis X", "is_driven": True},
        {"input": 2, "what": "home of axis X", "is_driven": True},
    ]
    assert about["why_not"] == ""
    assert about["devices"] == [
        {
            "name": "gripper", "kind": "gripper", "by_hand": {"part": "bool"},
            "sign": {"at": (1.0, 2.0, 3.0), "parent": "X"},
        }
    ]  # fmt: skip


def test_places_of_switches_in_inches_are_drawn_in_millimetres(tmp_path: Path) -> None:
    text = DEVICES.replace('units = "mm"', 'units = "in"')
    pane = WorldPane(Installation.inside(Controller(world=parse_world(text)), Store(), tmp_path))
    (link,) = pane.about([])["links"]
    assert [(each["low"], each["high"]) for each in link["switches"]] == [
        (pytest.approx(-127.0), 0.0), (pytest.approx(-25.4), pytest.approx(304.8)),
    ]  # fmt: skip


def test_a_device_gets_its_command_by_hand_and_shows_what_follows(pane: WorldPane) -> None:
    pane.card.send("SET 34\r")
    pane.command("me", "gripper", "part", 1.0)
    pane.card.advance(seconds=0.2)
    state = pane.state()
    (gripper,) = state["devices"]
    assert gripper["commands"] == {"close": True, "part": True}
    assert gripper["signals"] == {"opened": False, "closed": False, "gripped": True}
    assert 13 in state["on"]
    assert 12 not in state["on"]


def test_of_a_card_elsewhere_only_the_axes_are_drawn_and_nothing_can_be_changed(
    tmp_path: Path,
) -> None:
    store = Store()
    pane = WorldPane(Installation.at("127.0.0.1:1", store, tmp_path))
    limited = {"name": "X", "index": 0, "unit": "mm", "low": -10.0, "high": 90.0}
    turning = {"name": "C", "index": 3, "unit": "deg", "low": None, "high": None}
    about = pane.about([limited, turning])
    assert [(e["axis"], e["is_rotary"], e["low"], e["high"]) for e in about["links"]] == [
        (0, False, -10.0, 90.0), (3, True, -180.0, 180.0),
    ]  # fmt: skip
    assert (about["inputs"], about["faults"], about["devices"]) == ([], [], [])
    assert about["why_not"] == OUT_OF_REACH
    pane.watchers.watch(1, 25.0)
    pane.look(0.0)  # nothing to report: the positions of the status are drawn
    for act in (
        lambda: pane.set_input("me", 0, "on"), lambda: pane.fault("me", 0, "jam", 0.0),
        lambda: pane.mend("me", 0, None), lambda: pane.command("me", "arm", "x", 1.0),
        lambda: pane.file(0),
    ):  # fmt: skip
        with pytest.raises(Exception, match="the world of this card is out of reach"):
            act()
    store.close()


def test_only_the_file_that_machine_toml_names_is_given(tmp_path: Path) -> None:
    text = DEVICES + '[axis.body]\nfile = "slide.stl"\n'.replace("[axis.body]", "")
    world = parse_world(DEVICES.replace("drive =", 'body = { file = "slide.stl" }\ndrive ='))
    assert text
    pane = WorldPane(Installation.inside(Controller(world=world, device_folder=tmp_path),
                                         Store(), tmp_path))  # fmt: skip
    assert pane.file(0) == tmp_path / "slide.stl"
    with pytest.raises(Exception, match=r"axis 1: machine\.toml names no file with its body"):
        pane.file(1)


def test_the_state_of_the_world_comes_as_frames(panel: Served) -> None:
    async def scene(client: Client) -> None:
        await client.do("sub", topic="world", hz=25)
        await client.wait(lambda: client.frames or None)
        first = json.loads(client.frames[-1][24:])
        assert sorted(first) == ["devices", "faults", "forced", "on", "positions"]
        assert first["forced"] == []
        await client.do("world.input", input=0, state="on")
        await client.wait(lambda: json.loads(client.frames[-1][24:])["forced"] == [0])
        await client.do("unsub", topic="world")

    talk(panel, scene)


def test_the_world_is_served_over_http(panel: Served) -> None:
    about = httpx.get(f"{panel.url}/api/world").json()
    assert [link["name"] for link in about["links"]] == ["X", "Y", "Z"]
    assert [link["parent"] for link in about["links"]] == [None, 0, 1]
    answer = httpx.get(f"{panel.url}/api/world/body", params={"axis": 0})
    assert answer.status_code == 422
    assert "names no file" in answer.json()["error"]["text"]


def test_inputs_that_are_forced_are_known_to_every_browser_and_all_are_released_at_once(
    tmp_path: Path,
) -> None:
    world = parse_world(DEVICES)
    pane = WorldPane(Installation.inside(Controller(world=world), Store(), tmp_path))
    assert pane.forced()["forced"] == []
    assert pane.forced()["inputs"] == [each.flag for each in pane.card.world_view.sources
                                       if each.is_driven]  # fmt: skip
    pane.set_input("me", 5, "on")  # nothing drives it: it is switched, not forced
    pane.set_input("me", 2, "on")
    pane.set_input("me", 12, "off")
    found = {each["input"]: (each["on"], each["what"]) for each in pane.forced()["forced"]}
    assert set(found) == {2, 12}
    assert found[2][0] is True
    assert found[12] == (False, "opened of gripper")
    assert pane.release_all("me") == 2
    assert pane.forced()["forced"] == []
    assert pane.card.bit[5]
    assert pane.release_all("me") == 0
    elsewhere = WorldPane(Installation.at("127.0.0.1:1", Store(), tmp_path))
    assert elsewhere.forced() == {"why_not": OUT_OF_REACH, "inputs": [], "forced": []}


def test_the_list_of_forced_inputs_is_a_fact_that_follows_the_card(hand: HandStation) -> None:
    (driven, *_) = hand.events("forced")[-1]["inputs"]
    hand.do("world.input", input=driven, state="on")
    assert [each["input"] for each in hand.events("forced")[-1]["forced"]] == [driven]
    assert hand.do("world.release") == {"released": 1}
    assert hand.events("forced")[-1]["forced"] == []
