"""`openacr bus` on a CAN bus with nodes of python-canopen."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.waiting import until
from typer.testing import CliRunner

from openacr.cli import bus_can
from openacr.cli.main import app
from openacr.plant.describe.load import load_world

can = pytest.importorskip("can", reason="python-can is not installed")
pytest.importorskip("canopen", reason="canopen is not installed")
from tests.fieldbus.canopen.local_node import NAME, LocalIo  # noqa: E402

pytestmark = pytest.mark.evidence("client", "python-canopen, a CANopen stack with nodes of its own")
BUS = "virtual:of-tools"


@pytest.fixture
def nodes() -> Iterator[list[LocalIo]]:
    made = [
        LocalIo(can.Bus(interface="virtual", channel="of-tools"), node, device_type=kind)
        for node, kind in ((3, 0xF0191), (127, 402))
    ]
    yield made
    for node in made:
        node.close()


def run(*words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["bus", *words])
    assert result.exit_code == code, result.output
    return result.output


def shows(expected: object, *words: str, read: Callable[[str], object] = str) -> None:
    """Wait for an output: a node of this process may answer too late on a loaded computer."""
    until(lambda: read(run(*words)) == expected, lambda: run(*words))


def test_a_scan_names_all_nodes_and_what_they_have(nodes: list[LocalIo]) -> None:
    said = [
        f"node 3: {NAME}, I/O node, 16 digital inputs, 16 digital outputs, 2 analog inputs,"
        " 2 analog outputs, vendor 0x12345 product 0x7 revision 0x1 serial 3",
        f"node 127: {NAME}, profile 402, vendor 0x12345 product 0x7 revision 0x1 serial 127",
    ]
    shows(said, "scan", BUS, read=str.splitlines)
    identity = {"name": NAME, "vendor": 0x12345, "product": 7, "revision": 1}
    first = {
        "node": 3, "type": 0xF0191, "io": True, "serial": 3, **identity,
        "digital_inputs": 16, "digital_outputs": 16, "analog_inputs": 2, "analog_outputs": 2,
    }  # fmt: skip
    second = {"node": 127, "type": 402, "io": False, "serial": 127, **identity}
    shows([first, second], "scan", BUS, "--json", read=json.loads)


def test_the_file_of_a_scan_is_a_machine(nodes: list[LocalIo], tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    run("scan", BUS, "--bit-rate", "500", "--write", str(path))
    canopen = load_world(path).canopen
    assert canopen is not None
    assert (canopen.interface, canopen.channel, canopen.bit_rate) == ("virtual", "of-tools", 500)
    (node,) = canopen.node
    assert (node.id, node.vendor, node.product, node.digital_inputs) == (3, 0x12345, 7, 16)
    assert "profile 402" in path.read_text() and "it is no I/O node" in path.read_text()
    assert "such a file already" in run("scan", BUS, "--write", str(path), code=2)


def test_states_are_those_that_nodes_report(nodes: list[LocalIo]) -> None:
    for node, state in zip(nodes, ("OPERATIONAL", "PRE-OPERATIONAL"), strict=True):
        node.node.sdo[0x1017].raw = 20
        node.node.nmt.state = state
    shows("node 3: OPERATIONAL\nnode 127: PRE-OPERATIONAL\n", "state", BUS)
    states = [{"node": 3, "state": 5}, {"node": 127, "state": 127}]
    shows(states, "state", BUS, "--json", read=json.loads)


def test_a_node_without_health_reports_is_said_to_have_none(nodes: list[LocalIo]) -> None:
    nodes[1].close()
    shows("node 3: no health report\n", "state", BUS)


def test_objects_are_read_and_written(nodes: list[LocalIo]) -> None:
    assert run("sdo", "read", BUS, "3", "0x1008") == f"{NAME}\n"
    assert run("sdo", "read", BUS, "3", "0x1018:1") == "74565 (0x00012345)\n"
    run("sdo", "write", BUS, "3", "0x6411:2", "-5", "--type", "i16")
    run("sdo", "write", BUS, "3", "0x6200:1", "0x81")
    assert nodes[0].value(0x6411, 2) == -5 and nodes[0].value(0x6200, 1) == 0x81
    assert run("sdo", "read", BUS, "3", "0x6411:2", "--type", "i16") == "-5 (0xFFFB)\n"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["read", BUS, "3", "0x2000"], "node 3: object 0x2000:0: the object does not exist"),
        (["read", BUS, "4", "0x1000"], "node 4: object 0x1000:0: no answer in 0.5 s"),
        (["read", BUS, "128", "0x1000"], "node 128: ids of nodes are 1 to 127"),
        (["read", BUS, "0", "0x1000"], "node 0: ids of nodes are 1 to 127"),
        (["write", BUS, "3", "0x6200:1", "256"], "256: the object has 1 byte"),
        (["read", "eth7", "3", "0x1000", "--bit-rate", "500"], "eth7 is no CAN bus"),
        (["read", "no-such-thing:0", "3", "0x1000"], "CAN 0: "),
    ],
)
def test_what_fails_is_said_with_the_node(
    nodes: list[LocalIo], words: list[str], said: str
) -> None:
    assert said in run("sdo", *words, code=2)


def test_no_node_is_no_failure() -> None:
    assert "no node answers on virtual:nothing at 125 kbit/s" in run("scan", "virtual:nothing")


@pytest.mark.parametrize(
    ("interface", "place"),
    [
        ("can0", ("socketcan", "can0")),
        ("vcan12", ("socketcan", "vcan12")),
        ("slcan0", ("socketcan", "slcan0")),
        ("pcan:PCAN_USBBUS1", ("pcan", "PCAN_USBBUS1")),
        ("udp_multicast:", ("udp_multicast", None)),
        ("eth0", None),
        ("canal", None),
    ],
)
def test_a_can_bus_is_known_by_its_name(interface: str, place: tuple[str, str] | None) -> None:
    assert bus_can.is_can(interface) is (place is not None)
    assert place is None or bus_can.place_of(interface) == place
