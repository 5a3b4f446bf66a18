"""An I/O node of python-canopen, with all of CANopen of others; also as a process of its own.

Its description is an EDS file. It has 16 digital inputs and outputs and two analog ones of each,
no process data until a master maps them, and shows its outputs inverted (digital) or negated
(analog) at its inputs.
"""

import io
import socket
import struct
import sys
from typing import Any

import can
import canopen

from openacr.io.can_link import MULTICAST, options_of

U8, I16, U16, U32, TEXT = 0x5, 0x3, 0x6, 0x7, 0x9
VENDOR = 0x12345
NAME = "a node of python-canopen"


def eds(node: int, device_type: int = 0xF0191) -> str:
    """The EDS file."""
    lines = [f"[DeviceInfo]\nVendorName=tests\nVendorNumber={VENDOR}\nProductNumber=7\n"]

    def variable(section: str, name: str, kind: int, value: object, access: str = "rw") -> None:
        lines.append(
            f"[{section}]\nParameterName={name}\nObjectType=0x7\nDataType=0x{kind:X}\n"
            f"AccessType={access}\nDefaultValue={value}\nPDOMapping=1\n"
        )

    def record(index: int, name: str, kinds: list[tuple[int, object]], first: object) -> None:
        lines.append(
            f"[{index:X}]\nParameterName={name}\nObjectType=0x9\nSubNumber={len(kinds) + 1}\n"
        )
        variable(f"{index:X}sub0", "entries", U8, first)
        for place, (kind, value) in enumerate(kinds, 1):
            variable(f"{index:X}sub{place:X}", f"entry {place}", kind, value)

    variable("1000", "device type", U32, device_type, "ro")
    variable("1001", "error register", U8, 0, "ro")
    variable("1008", "device name", TEXT, NAME, "ro")
    variable("1017", "heartbeat time", U16, 0)
    record(0x1018, "identity", [(U32, VENDOR), (U32, 7), (U32, 1), (U32, node)], 4)
    record(0x6000, "digital inputs", [(U8, 0)] * 2, 2)
    record(0x6200, "digital outputs", [(U8, 0)] * 2, 2)
    record(0x6401, "analog inputs", [(I16, 0)] * 2, 2)
    record(0x6411, "analog outputs", [(I16, 0)] * 2, 2)
    variable("6423", "analog inputs are sent", U8, 0)
    for first in (0x1400, 0x1800):
        for pdo in range(4):
            record(first + pdo, "communication", [(U32, 0x80000000), (U8, 255)], 2)
            record(first + 0x200 + pdo, "mapping", [(U32, 0)] * 8, 0)
    return "\n".join(lines)


class LocalIo:
    """The node on a bus, and what it does with its signals."""

    def __init__(self, bus: can.BusABC, node: int, **of_eds: Any) -> None:
        self.network = canopen.Network(bus)
        # `Network.connect` opens a bus; this one is open.
        self.network.notifier = can.Notifier(bus, self.network.listeners, 0.1)
        text = io.StringIO(eds(node, **of_eds))
        text.name = "node.eds"
        self.node: Any = self.network.create_node(node, canopen.import_od(text))
        self._pending: dict[int, bytes] = {}
        self.network.subscribe(0x80, self._sync)
        for identifier in (0x200 + node, 0x300 + node):
            self.network.subscribe(identifier, self._output)
        self.node.nmt.state = "INITIALISING"
        self.node.nmt.state = "PRE-OPERATIONAL"

    def close(self) -> None:
        self.network.disconnect()

    def value(self, index: int, subindex: int) -> int:
        return int(self.node.sdo[index][subindex].raw)

    def _output(self, identifier: int, data: bytearray, _: float) -> None:
        self._pending[identifier] = bytes(data)

    def _sync(self, _: int, data: bytearray, time: float) -> None:
        if self.node.nmt.state != "OPERATIONAL":
            return
        for pdo in range(4):
            identifier = self.value(0x1400 + pdo, 1)
            if identifier in self._pending:
                self._spread(0x1600 + pdo, self._pending.pop(identifier))
        for place in (1, 2):
            self.node.sdo[0x6000][place].raw = ~self.value(0x6200, place) & 0xFF
            self.node.sdo[0x6401][place].raw = -self.value(0x6411, place)
        for pdo in range(4):
            identifier = self.value(0x1800 + pdo, 1)
            if not identifier >> 31:
                self.network.send_message(identifier & 0x7FF, self._gathered(0x1A00 + pdo))

    def _mapped(self, mapping: int) -> list[tuple[int, int, str]]:
        entries = [self.value(mapping, n + 1) for n in range(self.value(mapping, 0))]
        kinds = {8: "<B", 16: "<h"}
        return [(entry >> 16, entry >> 8 & 0xFF, kinds[entry & 0xFF]) for entry in entries]

    def _spread(self, mapping: int, data: bytes) -> None:
        for index, subindex, kind in self._mapped(mapping):
            size = struct.calcsize(kind)
            (value,), data = struct.unpack(kind, data[:size]), data[size:]
            self.node.sdo[index][subindex].raw = value

    def _gathered(self, mapping: int) -> bytes:
        return b"".join(
            struct.pack(kind, self.value(index, subindex))
            for index, subindex, kind in self._mapped(mapping)
        )


def udp_bus() -> str:
    """A bus that no other test uses, as a channel of udp_multicast."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("", 0))
        return f"239.74.163.2:{free.getsockname()[1]}"


def main(channel: str, node: str) -> None:
    """A process with one node, until its input ends."""
    local = LocalIo(can.Bus(**options_of(MULTICAST, channel)), int(node))
    print("ready", flush=True)
    sys.stdin.read()
    local.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
