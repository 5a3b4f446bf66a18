"""A card with real nodes: emulated ones on a bus in this process; time is the card's own."""

from collections.abc import Callable, Collection

from tests.network.rig import NODE_ID, START, STATE

from openacr.controller import Controller
from openacr.fieldbus.canopen.emulated import EmulatedNodes
from openacr.fieldbus.canopen.frames import Frame, Trouble
from openacr.fieldbus.canopen.real_nodes import RealNodes
from openacr.map.rows import bus_nodes
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

HEAD = '[card]\nmodel = "ACR9000"\n[canopen]\ninterface = "virtual"\n'


class Wire:
    """A bus to which any number of links are connected."""

    def __init__(self) -> None:
        self.now_s: Callable[[], float] = lambda: 0.0
        self.links: list[WireLink] = []
        self.sent: list[Frame] = []
        self.passed_on: Callable[[Frame], list[Frame]] = lambda frame: [frame]

    def carry(self, frame: Frame, sender: "WireLink | None" = None) -> None:
        """Bring a frame to all but the sender."""
        self.sent.append(frame)
        for each in self.passed_on(frame):
            for link in self.links:
                if link is not sender and (link.heard is None or each.id in link.heard):
                    link.waiting.append(each)


class WireLink:
    """One connection to the bus."""

    name = "can0"

    def __init__(self, wire: Wire, bit_rate: int = 125) -> None:
        self.wire, self.bit_rate = wire, bit_rate
        self.waiting: list[Frame] = []
        self.now = Trouble()
        self.reopening = ""
        self.takes = True
        self.heard: Collection[int] | None = None
        wire.links.append(self)

    def send(self, frame: Frame) -> bool:
        if self.takes:
            self.wire.carry(frame, self)
        return self.takes

    def take(self) -> list[Frame]:
        taken, self.waiting = self.waiting, []
        return taken

    def listen(self, identifiers: Collection[int] | None) -> None:
        self.heard = identifiers

    def trouble(self) -> Trouble:
        now, self.now = self.now, Trouble(errors=self.now.errors, failure=self.now.failure)
        return now

    def reopen(self) -> str:
        if not self.reopening:
            self.now, self.takes = Trouble(), True
        return self.reopening

    def now_s(self) -> float:
        return self.wire.now_s()


class OnCan:
    """A card, its link and the nodes of a machine on the other side."""

    def __init__(self, nodes: str, *, far: str | None = None, is_real: bool = True) -> None:
        file = parse_world(HEAD + nodes)
        assert file.canopen is not None
        self.card = Controller("ACR9000", world=real_world(file))
        self.card.is_journalled = False
        self.wire = Wire()
        self.wire.now_s = lambda: self.card.time_s
        self.link = WireLink(self.wire)
        self.far = [self.add(nodes if far is None else far)]
        self.nodes = RealNodes(self.card.networks.canopen, file.canopen.real, self.link)
        if is_real:
            self.nodes.allow()
        self.card.networks.connect(self.nodes)
        self.card.devices.join(self)
        self.card.advance(seconds=0.2)

    def add(self, nodes: str) -> EmulatedNodes:
        """Nodes of a machine on the bus."""
        return EmulatedNodes(parse_world(HEAD + nodes), WireLink(self.wire))

    def attend(self, tick: int) -> int:
        for each in self.far:
            each.attend()
        return tick + 1

    def start(self, *ids: int, cycle_ms: int = 20, bit_rate: int = 125) -> int:
        """Start the network with these nodes; the bus state."""
        p = self.card.p
        p[32769], p[32770], p[32772] = bit_rate, len(ids), cycle_ms
        for parameter, number in zip(NODE_ID, ids, strict=False):
            p[parameter] = number
        self.card.bit[START] = True
        assert self.card.until(START, is_=False, timeout_s=60.0)
        return int(p[STATE])

    def level(self, number: int, is_on: bool, node: int = 0) -> None:
        """Switch a digital input at the terminal of a far node."""
        memory = self.far[0].memory
        at = bus_nodes.levels[node] + number // 32
        bit = 1 << number % 32
        word = (memory.I[at] & 0xFFFFFFFF & ~bit) | (bit if is_on else 0)
        memory.I[at] = word - (word >> 31 << 32)

    def output(self, number: int, node: int = 0) -> bool:
        """Whether a digital output of a far node is on."""
        word = self.far[0].memory.I[bus_nodes.outputs[node] + number // 32]
        return bool(word >> number % 32 & 1)

    def converted(self, channel: int, node: int = 0) -> int:
        """The counts at an analog output of a far node."""
        return self.far[0].memory.I[bus_nodes.converted[node] + channel]
