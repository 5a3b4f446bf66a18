"""The card's network with nodes of python-canopen, over buses of python-can."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from tests.network.rig import DI, DO, NODE_FAILURE, NODE_ID, START, STATE, node

from openacr.controller import Controller
from openacr.fieldbus.canopen.real_nodes import RealNodes
from openacr.io.can_link import CanLink
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

can = pytest.importorskip("can", reason="python-can is not installed")
canopen = pytest.importorskip("canopen", reason="canopen is not installed")
from tests.fieldbus.canopen.local_node import VENDOR, LocalIo, udp_bus  # noqa: E402

pytestmark = pytest.mark.evidence("client", "python-canopen, a CANopen stack with nodes of its own")

LIMIT_S = 60.0


class Paced:
    """A card on a bus of python-can, no faster than the clock."""

    def __init__(self, link: CanLink, table: str = "") -> None:
        text = '[card]\nmodel = "ACR9000"\n[canopen]\ninterface = "virtual"\n' + table
        file = parse_world(text)
        assert file.canopen is not None
        self.card, self.link = Controller("ACR9000", world=real_world(file)), link
        self.card.is_journalled = False
        self.nodes = RealNodes(self.card.networks.canopen, file.canopen.real, link)
        self.nodes.allow()
        self.card.networks.connect(self.nodes)
        self.card.advance(seconds=0.2)

    def until(self, holds: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + LIMIT_S
        while not holds():
            assert time.monotonic() < end, f"not within {LIMIT_S:g} s: {what}"
            self.card.advance(2)
            time.sleep(0.001)

    def start(self, *ids: int) -> int:
        p = self.card.p
        p[32770], p[32772] = len(ids), 100
        for parameter, number in zip(NODE_ID, ids, strict=False):
            p[parameter] = number
        self.card.bit[START] = True
        self.until(lambda: not self.card.bit[START], "the start ends")
        return int(p[STATE])


@contextmanager
def on_bus(interface: str, channel: str, table: str = "") -> Iterator[Paced]:
    link = CanLink(interface, channel, 125)
    try:
        yield Paced(link, table)
    finally:
        link.close()


@contextmanager
def local(channel: str, node_id: int, **of_eds: int) -> Iterator[LocalIo]:
    made = LocalIo(can.Bus(interface="virtual", channel=channel), node_id, **of_eds)
    try:
        yield made
    finally:
        made.close()


def exchanges(paced: Paced) -> None:
    """Outputs come back at the inputs as this node turns them over."""
    card = paced.card
    card.bit[DO[0] + 9], card.p[33296] = True, 5.0  # counts 16384 at the second analog output
    wanted = [n != 9 for n in range(16)]
    paced.until(lambda: [card.bit[DI[0] + n] for n in range(16)] == wanted, "digital inputs")
    paced.until(lambda: card.p[33304] == -5.0, "analog input")
    assert [card.p[33025 + n] for n in range(6)] == [2, 2, 2, 2, 1, 1]


def test_a_node_of_others_is_set_up_and_exchanges_its_signals() -> None:
    with local("exchange", 3), on_bus("virtual", "exchange", node(3, vendor=VENDOR)) as paced:
        assert paced.start(3) == 2
        exchanges(paced)


def test_a_node_of_others_that_is_pulled_is_dead_and_comes_back() -> None:
    with on_bus("virtual", "pulled") as paced:
        with local("pulled", 3):
            assert paced.start(3) == 2
        paced.until(lambda: paced.card.bit[NODE_FAILURE], "the node is missed")
        assert (paced.card.p[STATE], paced.card.p[33030]) == (7, 0)
        with local("pulled", 3):
            assert paced.start(3) == 2
            exchanges(paced)


def test_a_wrong_node_of_others_is_refused(caplog: pytest.LogCaptureFixture) -> None:
    with local("wrong", 3), on_bus("virtual", "wrong", node(3, product=8)) as paced:
        assert paced.start(3) == 5
    assert "node 3: it has product 0x7, machine.toml says 0x8" in caplog.text
    with local("drive", 3, device_type=402), on_bus("virtual", "drive") as paced:
        assert paced.start(3) == 5
    assert "it is no I/O node" in caplog.text


@pytest.fixture
def vcan() -> Iterator[str]:
    name = f"vc{os.getpid()}"
    made = shutil.which("ip") and subprocess.run(
        ["ip", "link", "add", name, "type", "vcan"], capture_output=True, check=False
    )
    if not made or made.returncode:
        pytest.skip("vcan interfaces need root and a kernel that has them")
    try:
        subprocess.run(["ip", "link", "set", name, "up"], check=True)
        yield name
    finally:
        subprocess.run(["ip", "link", "delete", name], check=False)


def test_a_can_interface_of_linux_carries_it(vcan: str) -> None:
    with on_bus("socketcan", vcan) as paced:
        far = LocalIo(can.Bus(interface="socketcan", channel=vcan), 3)
        try:
            assert paced.start(3) == 2
            exchanges(paced)
        finally:
            far.close()


def test_a_node_in_another_process_is_reached_and_missed_when_that_is_killed() -> None:
    channel = udp_bus()
    far = subprocess.Popen(
        [sys.executable, "-m", "tests.fieldbus.canopen.local_node", channel, "9"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert far.stdout is not None and far.stdout.readline() == "ready\n"
        with on_bus("udp_multicast", channel) as paced:
            assert paced.start(9) == 2
            exchanges(paced)
            far.kill()
            paced.until(lambda: paced.card.bit[NODE_FAILURE], "the node is missed")
            assert paced.card.p[STATE] == 7
    finally:
        far.kill()
        far.communicate()
