"""Cards with nodes on their CANopen bus."""

from openacr.controller import Controller
from openacr.map.rows import bus_nodes
from openacr.plant.bus import terminals
from openacr.plant.describe.load import parse_world

START, RESET = 11265, 11266
FITTED, OPERATIONAL, FAILED, NODE_FAILURE, SW_OVERFLOW, HW_OVERFLOW = range(11268, 11274)
STATE = 32779
NODE_ID = (33024, 33040, 33056, 33072)
DI = tuple(11520 + 1024 * node for node in range(4))
DO = tuple(12032 + 1024 * node for node in range(4))
PANEL = """
[[canopen.node]]
id = 1
digital_inputs = 12
digital_outputs = 12
analog_inputs = 2
analog_outputs = 2
"""


def card(nodes: str = PANEL, *, model: str = "ACR9000", powered_up: bool = True) -> Controller:
    """A card with a bus, powered up unless that is what the test is about."""
    text = f'[card]\nmodel = "{model}"\n[canopen]\n{nodes}'
    made = Controller(model, world=parse_world(text))
    made.is_journalled = False
    if powered_up:
        made.advance(seconds=0.2)
    return made


def node(number: int, **keys: object) -> str:
    """A node in the words of machine.toml."""
    return _table("node", {"id": number, **keys})


def fault(kind: str, **keys: object) -> str:
    """A fault in the words of machine.toml."""
    return _table("fault", {"kind": kind, **keys})


def _table(name: str, keys: dict[str, object]) -> str:
    lines = (f"{key} = {_toml(value)}" for key, value in keys.items())
    return "\n".join([f"[[canopen.{name}]]", *lines, ""])


def _toml(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value).lower()


def expect(made: Controller, *ids: int, bit_rate: int = 125, cycle_ms: int = 50) -> None:
    """Tell the card which nodes it has."""
    made.p[32769], made.p[32770], made.p[32772] = bit_rate, len(ids), cycle_ms
    for parameter, number in zip(NODE_ID, ids, strict=False):
        made.p[parameter] = number


def start(made: Controller) -> int:
    """Start the network and wait for the end of the attempt; the bus state."""
    made.bit[START] = True
    assert made.until(START, is_=False, timeout_s=2.0)
    return int(made.p[STATE])


def running(nodes: str = PANEL, *ids: int, bit_rate: int = 125, cycle_ms: int = 50) -> Controller:
    """A card whose network has started."""
    made = card(nodes)
    expect(made, *(ids or (1,)), bit_rate=bit_rate, cycle_ms=cycle_ms)
    assert start(made) == 2
    return made


def output(made: Controller, place: int, terminal: int) -> bool:
    """Whether a digital output of a node is on, at its terminal."""
    row = terminals.terminal_row(place, terminal, bus_nodes.outputs)
    return bool(made.memory.I[row] >> terminal % 32 & 1)


def converted(made: Controller, place: int, channel: int) -> int:
    """The counts an analog output of a node converts."""
    return made.memory.I[bus_nodes.converted[place] + channel]


def node_state(made: Controller, place: int) -> int:
    """What a node is doing."""
    return made.memory.I[bus_nodes.state[place]]
