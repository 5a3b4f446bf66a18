"""What the network keeps: ESAVE, restarts, snapshots and journals."""

from pathlib import Path

import pytest
from tests.network.rig import (
    DI,
    DO,
    PANEL,
    STATE,
    card,
    fault,
    node,
    output,
    running,
    start,
)

from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay


def reboot(made: Controller) -> None:
    made.send("REBOOT\r")
    made.advance(seconds=0.2)


@pytest.mark.req("ACR-CAN-09")
def test_a_card_that_is_switched_on_again_has_its_network(tmp_path: Path) -> None:
    first = card()
    world = first.world
    kept = Controller("ACR9000", world=world, data=tmp_path)
    kept.p[32769], kept.p[33024], kept.p[33282] = 1000, 17, 5.0
    kept.send("ESAVE\r")
    kept.close()
    again = Controller("ACR9000", world=world, data=tmp_path)
    assert [again.p[number] for number in (32769, 33024, 33282)] == [1000, 17, 5.0]
    again.close()


def test_nodes_live_on_when_the_card_restarts() -> None:
    made = running(PANEL + fault("lost", node=1, at_s=3.0))
    made.bit[DO[0]] = True
    made.set_input(DI[0], True)
    made.advance(seconds=1.5 - made.time_s)
    reboot(made)
    assert output(made, 0, 0), "outputs stay until a program writes others"
    assert start(made) == 2
    made.advance(seconds=0.1)
    assert made.bit[DI[0]] and not output(made, 0, 0)
    made.advance(seconds=2.0)
    assert made.p[STATE] == 7, "the age of the world goes on"


def test_a_snapshot_returns_to_the_middle_of_a_cycle() -> None:
    made = running()
    made.set_input(DI[0], True)
    made.advance(1)
    snapshot, digests = made.snapshot(), []
    for _ in range(2):
        made.restore(snapshot)
        made.bit[DO[0] + 3] = True
        made.advance(seconds=0.5)
        digests.append(made.digest())
        assert made.bit[DI[0]] and output(made, 0, 3)
    assert digests[0] == digests[1]


def test_a_journal_replays_what_happened_at_the_nodes(tmp_path: Path) -> None:
    made = card(PANEL + node(2, digital_inputs=4))
    made.recorder = Recorder(made, tmp_path / "j", project="", fingerprint="")
    made.send("P32770=2\rP33040=2\rSET 11265\r")
    for step in range(8):
        made.advance(seconds=0.3)
        made.set_input(DI[step % 2] + step % 3, step % 3 > 0)
        made.set_analog(33288, 1.5 * step - 5)
    made.advance(seconds=1.0)
    made.close()
    replay = Replay(read_journal(tmp_path / "j"))
    replay.run()
    assert replay.difference is None and replay.equal >= 3
    assert replay.card.p[STATE] == 2
    assert replay.card.p[33288] == made.p[33288] != 0
