"""A device of the segment: where it is, who it is, its states."""

from collections.abc import Iterator
from dataclasses import dataclass

from openacr.fieldbus.ethercat.master import eeprom
from openacr.fieldbus.ethercat.master.port import FIRST_STATION, BusError, Port
from openacr.fieldbus.ethercat.master.topology import Place, open_ports, places
from openacr.fieldbus.ethercat.wire.frames import Command, by_position, by_station
from openacr.fieldbus.ethercat.wire.registers import (
    ERROR,
    STATE_MASK,
    Register,
    State,
    al_text,
)
from openacr.fieldbus.ethercat.wire.sii import Description

MOST_DEVICES = 1000
STATE_S = 5.0  # a change of state takes at most
POLL_S = 0.001


@dataclass(slots=True)
class Device:
    """A device that was found by a scan."""

    port: Port
    position: int
    alias: int
    description: Description
    place: Place | None = None  # of the first one, which has the cable of the computer

    @property
    def is_in_line(self) -> bool:
        """Whether it follows the device before it."""
        return self.place is None or self.place.device == self.position - 1

    @property
    def station(self) -> int:
        """Its station address."""
        return FIRST_STATION + self.position

    @property
    def label(self) -> str:
        """What messages call it."""
        name = self.description.name or self.description.order
        return f"device {self.position} ({name})" if name else f"device {self.position}"

    @property
    def is_drive(self) -> bool:
        """Whether it has the objects of a drive in its process data."""
        pdos = (*self.description.receive, *self.description.transmit)
        return any(entry.index in (0x6040, 0x6041) for pdo in pdos for entry in pdo.entries)

    def state(self) -> tuple[State, int]:
        """Its state, and the code of its error: 0 without one."""
        return _state(self.port.read(self.station, Register.AL_STATUS, 6))

    def state_now(self) -> tuple[State, int] | None:
        """The same, asked once; None if it does not answer."""
        data = self.registers_now(Register.AL_STATUS, 6)
        return None if data is None else _state(data)

    def registers_now(self, register: int, size: int) -> bytes | None:
        """Registers, asked once; None if it does not answer."""
        back = self.port.once([by_station(Command.FPRD, self.station, register, bytes(size))])
        return back[0].data if back and back[0].counter == 1 else None

    def request(self, state: State) -> None:
        """Ask for a state; an error is acknowledged first."""
        status = self.port.word(self.station, Register.AL_STATUS)
        if status & ERROR:
            acknowledged = status & STATE_MASK | ERROR
            self.port.write_word(self.station, Register.AL_CONTROL, acknowledged)
        self.port.write_word(self.station, Register.AL_CONTROL, state)

    def reach(self, state: State) -> None:
        """Bring it into a state; BusError with the reason the device gives."""
        self.request(state)
        deadline_s = self.port.link.now_s() + STATE_S
        while True:
            now, code = self.state()
            if now is state and not code:
                return
            if code or self.port.link.now_s() > deadline_s:
                why = al_text(code) if code else f"not within {STATE_S:g} s"
                raise BusError(f"{self.label} does not reach {state.name}: {why}")
            self.port.link.pause(POLL_S)


def _state(data: bytes) -> tuple[State, int]:
    return state_of(int.from_bytes(data[:2], "little"), int.from_bytes(data[4:6], "little"))


def state_of(status: int, code: int) -> tuple[State, int]:
    """A state by its two registers, and the code of its error: 0 without one."""
    shown = status & STATE_MASK  # other values are no states
    state = State(shown) if shown in tuple(State) else State.INIT
    return state, code if status & ERROR else 0


def count(port: Port) -> int:
    """How many devices answer."""
    return port.ask(by_station(Command.BRD, 0, Register.TYPE, b"\0")).counter


def scan(port: Port) -> list[Device]:
    """All devices in the order of the cable, with station addresses; BusError for none."""
    found = count(port)
    if not 1 <= found <= MOST_DEVICES:
        raise BusError(f"{found} devices answer on {port.link.name}: is there one with power?")
    return list(_found(port, found))


def _found(port: Port, number: int) -> Iterator[Device]:
    for position in range(number):
        station = FIRST_STATION + position
        address = station.to_bytes(2, "little")
        port.ask(by_position(Command.APWR, position, Register.STATION, address))
    status = [port.word(FIRST_STATION + n, Register.DL_STATUS) for n in range(number)]
    attached = places([open_ports(word) for word in status])
    for position in range(number):
        station = FIRST_STATION + position
        alias = port.word(station, Register.ALIAS)
        description = eeprom.description(port, station)
        yield Device(port, position, alias or description.alias, description, attached[position])
