"""`openacr bus emulate` of CANopen nodes: with a master of python-canopen, and with a card."""

import re
import signal
import subprocess
from collections.abc import Iterator
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import Any

import pytest
from tests import warm
from tests.fieldbus.emulator import Emulator, emulating
from tests.waiting import until

from openacr.client import Card
from openacr.io.can_link import MULTICAST, options_of

can = pytest.importorskip("can", reason="python-can is not installed")
canopen = pytest.importorskip("canopen", reason="canopen is not installed")
from tests.fieldbus.canopen.local_node import udp_bus  # noqa: E402

pytestmark = pytest.mark.evidence("client", "python-canopen, a CANopen stack with a master")
LIMIT_S = 60.0
MACHINE = """
[card]
model = "ACR9000"
[canopen]
interface = "udp_multicast"
channel = "{channel}"
[[canopen.node]]
id = 3
digital_inputs = 12
digital_outputs = 12
analog_inputs = 2
analog_outputs = 2
[[canopen.node]]
id = 4
health = "guarding"
digital_inputs = 8
[[canopen.node]]
id = 5
modelled = true
"""


@pytest.fixture
def channel() -> str:
    return udp_bus()


@pytest.fixture
def project(tmp_path: Path, channel: str) -> Path:
    (tmp_path / "machine.toml").write_text(MACHINE.format(channel=channel))
    return tmp_path


def emulated(project: Path, channel: str, *words: str) -> AbstractContextManager[Emulator]:
    return emulating(channel, str(project), "--interface", f"udp_multicast:{channel}", *words)


@pytest.fixture
def master(channel: str) -> Iterator[Any]:
    bus = can.Bus(**options_of(MULTICAST, channel))
    network = canopen.Network(bus)
    network.notifier = can.Notifier(bus, network.listeners, 0.1)
    yield network
    network.disconnect()


def test_a_master_of_others_maps_starts_and_exchanges(
    project: Path, channel: str, master: Any
) -> None:
    with emulated(project, channel) as far:
        assert far.line() == f"emulating on udp_multicast:{channel}: node 3, node 4"
        node = master.add_node(3, canopen.ObjectDictionary())
        node.sdo.RESPONSE_TIMEOUT = LIMIT_S
        upload, download = node.sdo.upload, node.sdo.download
        assert upload(0x1008, 0) == b"openacr I/O node"
        assert upload(0x1000, 0) == (0xF0191).to_bytes(4, "little")
        with pytest.raises(canopen.SdoAbortedError) as refused:
            download(0x1000, 0, bytes(4))
        assert refused.value.code == 0x06010002
        with pytest.raises(canopen.SdoAbortedError) as refused:
            upload(0x1800, 9)
        assert refused.value.code == 0x06090011
        heard: dict[int, bytes] = {}
        for identifier in (0x183, 0x2F0):
            master.subscribe(identifier, lambda i, data, _: heard.update({i: bytes(data)}))
        download(0x1801, 1, (0x800002F0).to_bytes(4, "little"))
        download(0x1A01, 0, b"\0")
        download(0x1A01, 1, (0x64010210).to_bytes(4, "little"))
        download(0x1A01, 0, b"\1")
        download(0x1801, 1, (0x2F0).to_bytes(4, "little"))
        download(0x1017, 0, (20).to_bytes(2, "little"))
        node.nmt.state = "OPERATIONAL"
        until(lambda: node.nmt.wait_for_heartbeat(LIMIT_S) == "OPERATIONAL", "its heartbeat")
        until(lambda: heard.get(0x183) == b"\0\0", "inputs at the start")
        assert far.say("input 3 11 1") == "node 3 has input 11 on"
        until(lambda: heard.get(0x183) == b"\0\x08", "an input that has changed")
        assert far.say("analog 3 1 -10") == "node 3 has -10 at analog input 1"
        master.send_message(0x203, b"\1\2")
        master.sync.transmit()
        until(lambda: heard.get(0x2F0) == b"\0\x80", "the mapped analog input")
        assert far.say("state").startswith("node 3: OPERATIONAL, outputs on: 0 9")
        assert far.line() == "node 4: PRE-OPERATIONAL, outputs on: none"
        assert far.say("power-off 3") == "node 3 has no power"
        assert far.say("state") == "node 3: no power, outputs on: none"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("input 3 12 1", "error: node 3: digital inputs are from 0 to 11"),
        ("analog 4 0 1", "error: node 4: analog inputs are not there"),
        ("input 7 0 1", "error: input 7 0 1: the nodes are 3, 4"),
        ("input 3 0", "error: input 3 0: write input NODE NUMBER LEVEL"),
        ("input 3 0 x", "error: input 3 0 x: x is not a number"),
        ("shout 3", "error: shout: the orders are input, analog, power-off, power-on,"),
    ],
)
def test_wrong_orders_are_refused_with_a_hint(
    project: Path, channel: str, words: str, said: str
) -> None:
    with emulated(project, channel, "--fault", words) as far:
        assert far.line().lower().startswith(said.lower())


def test_a_served_card_and_emulated_nodes_are_two_processes(project: Path, channel: str) -> None:
    with emulated(project, channel) as far:
        far.line()
        words = [
            "serve",
            str(project),
            "--ascii-port",
            "0",
            "--binary-port",
            "0",
            "--real",
            "--yes",
        ]
        served = warm.Popen(
            words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8"
        )
        try:
            assert served.stdout is not None
            place = re.search(r"ascii=(\S+):(\d+)", served.stdout.readline())
            assert place is not None
            with Card.open(f"{place[1]}:{place[2]}") as card:
                for line in ("P32770 = 2", "P32772 = 50", "P33024 = 3", "P33040 = 4", "SET 11265"):
                    card.command(line)
                until(lambda: card.p[32779] == 2, "the network runs")
                card.command("SET 12041")
                until(lambda: far.say("state").endswith(": 9") and bool(far.line()), "output 9")
                far.say("input 4 7 1")
                until(lambda: bool(card.bit[12551]), "input 7 of node 4")
                far.say("disconnect 4")
                until(lambda: bool(card.bit[11271]), "node 4 is missed")
                assert card.p[32779] == 7 and card.p[33046] == 0
            served.send_signal(signal.SIGTERM)
            _, said = served.communicate(timeout=LIMIT_S)
            assert f"CAN {channel}: 125 kbit/s, outputs are sent" in said
            assert "node 4: it reports no health: it is dead until the next start" in said
            until(lambda: far.say("state").endswith("none") and bool(far.line()), "outputs are off")
        finally:
            with suppress(ProcessLookupError):
                served.kill()
            served.communicate(timeout=LIMIT_S)
