"""The PLC of docs/host-software.md that stops a machine whose host is silent."""

import re
from pathlib import Path

import pytest
from tests.controller.hosts import Host, connected

TEXT = (Path(__file__).parents[2] / "docs" / "host-software.md").read_text(encoding="utf-8")
KILLS = (8467, 8499)


@pytest.fixture
def watched() -> Host:
    section = TEXT.partition("### A host that falls silent")[2]
    lines = re.findall(r"```acr\n(.*?)```", section, re.DOTALL)[0].splitlines()
    host = connected()
    heard = host.type(*lines)
    assert re.sub(r"SYS>|P07>|PLC0>", "", heard) == "", "nothing is refused"
    host.type("SYS", "SET 128", "AXIS1 JOG VEL 1", "AXIS1 JOG FWD")
    assert host.card.bit[824], "Jog Active of axis 1"
    return host


def killed(host: Host) -> list[bool]:
    return [host.card.bit[flag] for flag in KILLS]


def test_a_jog_goes_on_when_its_connection_is_closed_until_the_plc_kills_it(watched: Host) -> None:
    card = watched.card
    watched.close()
    card.advance(seconds=1.9)
    assert killed(watched) == [False, False]
    assert card.bit[824]
    card.advance(seconds=0.3)
    assert killed(watched) == [True, True]
    card.advance(seconds=1.0)
    assert not card.bit[824]


def test_a_host_that_is_there_keeps_the_machine_moving(watched: Host) -> None:
    for _ in range(10):
        watched.type("SET 128")
        watched.card.advance(seconds=0.5)
    assert killed(watched) == [False, False]
    watched.card.advance(seconds=2.5)
    watched.type("SET 128")
    watched.card.advance(seconds=0.1)
    watched.type("CLR 8467")
    watched.card.advance(seconds=0.5)
    assert killed(watched) == [False, True], "what is cleared stays clear once the host is back"
