"""Serial line for part programs (drip feed and LINK), configured by the COMMUNICATIONS tab."""

from dataclasses import dataclass
from pathlib import Path

import serial

from openacr.cnc.reading.text import CONTROL_Z
from openacr.errors import UserError, reason
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import COMMUNICATIONS

PARITIES = (serial.PARITY_NONE, serial.PARITY_EVEN, serial.PARITY_ODD)
XON_XOFF, RTS_CTS = 1, 2
PART, SILENCE_S = ".part", 3.0


@dataclass(frozen=True, slots=True)
class Line:
    """Parameters of the serial line."""

    port: str
    baud: int
    data_bits: int
    parity: str
    stop_bits: int
    handshake: int

    @classmethod
    def of(cls, store: Store, port: str = "") -> "Line":
        """Parameters of the store as they are now; `port` overrides the port of the store."""

        def number(n: int) -> int:
            return int(store.read(n))

        return cls(
            port=port or store.read_text(COMMUNICATIONS.port),
            baud=number(COMMUNICATIONS.baud),
            data_bits=number(COMMUNICATIONS.data_bits),
            parity=PARITIES[number(COMMUNICATIONS.parity)],
            stop_bits=number(COMMUNICATIONS.stop_bits),
            handshake=number(COMMUNICATIONS.handshake),
        )

    def open(self, wait_s: float = 0.0) -> serial.SerialBase:
        """Open the port with a read time-out of `wait_s`; UserError when it cannot be opened.

        With RTS/CTS the driver clears the signals when its buffer is full; XON and XOFF
        are sent by the caller that reads.
        """
        if not self.port:
            raise UserError(
                f"no serial port is configured: set P{COMMUNICATIONS.port}, or name a port"
            )
        try:
            return serial.serial_for_url(
                self.port,
                baudrate=self.baud,
                bytesize=self.data_bits,
                parity=self.parity,
                stopbits=self.stop_bits,
                rtscts=self.handshake == RTS_CTS,
                timeout=wait_s,
                write_timeout=1.0,
            )
        except (serial.SerialException, OSError, ValueError) as failure:
            raise UserError(f"cannot open serial port {self.port}: {reason(failure)}") from None


def receive(port: serial.SerialBase, target: Path, silence_s: float = SILENCE_S) -> int:
    """Store a part program that is sent as a file (LINK); returns its size in bytes.

    It ends with Ctrl-Z, or when nothing more arrives. The file appears only when complete.
    """
    data = bytearray()
    try:
        while CONTROL_Z not in data:
            more = port.read(max(port.in_waiting, 1))
            if not more and data:
                break
            if not more:
                raise UserError(f"nothing was received on {port.port}")
            data += more
            port.timeout = silence_s
    except (serial.SerialException, OSError) as failure:
        raise UserError(f"{port.port} failed: {failure}") from None
    program = bytes(data).partition(CONTROL_Z)[0].replace(b"\r\n", b"\n").strip(b"\0")
    half = target.with_name(target.name + PART)
    half.write_bytes(program)
    half.replace(target)
    return len(program)
