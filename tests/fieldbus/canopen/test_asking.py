"""A tool that asks emulated nodes; time passes where it pauses."""

import pytest
from tests.fieldbus.canopen.can_rig import HEAD, Wire, WireLink
from tests.network.rig import node

from openacr.errors import UserError
from openacr.fieldbus.canopen.asking import Asking, state_name
from openacr.fieldbus.canopen.emulated import EmulatedNodes
from openacr.fieldbus.canopen.frames import Frame, Nmt, nmt
from openacr.fieldbus.canopen.sdo import NodeError, read
from openacr.plant.describe.load import parse_world


class Bench:
    """A tool and nodes on one wire."""

    def __init__(self, nodes: str) -> None:
        self.now_s = 0.0
        self.wire = Wire()
        self.wire.now_s = lambda: self.now_s
        self.link = WireLink(self.wire)
        self.far = EmulatedNodes(parse_world(HEAD + nodes), WireLink(self.wire))
        self.tool = Asking(self.link, self.pause)

    def pause(self, seconds: float) -> None:
        self.now_s += seconds
        self.far.attend()


def test_all_nodes_are_found_within_the_time_of_one_answer() -> None:
    bench = Bench(node(1) + node(64, digital_inputs=12) + node(127, health="guarding"))
    assert [device.node for device in bench.tool.scan()] == [1, 64, 127]
    assert bench.now_s < 0.6


def test_a_bus_that_takes_frames_slowly_is_waited_for() -> None:
    bench = Bench(node(127))
    room = [0]

    class Narrow(WireLink):
        def send(self, frame: Frame) -> bool:
            room[0] += 1
            return room[0] % 10 != 0 and super().send(frame)

    tool = Asking(Narrow(bench.wire), bench.pause)
    assert [device.node for device in tool.scan()] == [127]


def test_a_bus_that_takes_no_frames_is_said() -> None:
    bench = Bench(node(1))
    bench.link.takes = False
    with pytest.raises(UserError, match=r"CAN can0: the bus takes no frames \(is another node"):
        bench.tool.scan()
    assert bench.now_s == pytest.approx(0.2, abs=0.01)


def test_nodes_with_guarding_are_asked_for_their_state() -> None:
    bench = Bench(node(1, health="guarding") + node(2))
    bench.pause(0.0)
    bench.link.take()  # the reports of their start
    bench.wire.carry(nmt(Nmt.START, 1))
    bench.pause(0.0)
    assert bench.tool.states([1, 2]) == {1: 5, 2: None}
    assert bench.now_s == pytest.approx(2.0, abs=0.01)


def test_a_long_object_comes_in_segments_and_a_broken_transfer_ends() -> None:
    bench = Bench(node(1))
    values = bench.far.nodes[0].objects.values
    for length in (1, 4, 5, 7, 8, 14, 15, 200):
        values[0x1008, 0] = bytes(range(length))
        assert bench.tool.one(1, read(0x1008)) == bytes(range(length))
    values[0x1008, 0] = bytes(4104)
    with pytest.raises(NodeError, match="node 1: object 0x1008:0: longer than 4096 bytes"):
        bench.tool.one(1, read(0x1008))
    values[0x1008, 0] = bytes(20)
    passed = [0]

    def lost(frame: Frame) -> list[Frame]:
        passed[0] += frame.id == 0x581
        return [] if frame.id == 0x581 and passed[0] == 3 else [frame]

    bench.wire.passed_on = lost
    with pytest.raises(NodeError, match=r"object 0x1008:0: no answer in 0\.5 s"):
        bench.tool.one(1, read(0x1008))
    assert bench.tool.one(1, read(0x1008)) == bytes(20), "the next access begins anew"


def test_states_have_names() -> None:
    assert [state_name(state) for state in (None, 0, 4, 5, 127, 9)] == [
        "no health report", "BOOT", "STOPPED", "OPERATIONAL", "PRE-OPERATIONAL", "state 9",
    ]  # fmt: skip
