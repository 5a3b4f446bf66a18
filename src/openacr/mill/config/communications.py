"""Serial line for part programs (drip feed and LINK), configured by the COMMUNICATIONS tab."""

import errno
from dataclasses import dataclass

import serial

from openacr.errors import UserError, reason
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import COMMUNICATIONS

PARITIES = (serial.PARITY_NONE, serial.PARITY_EVEN, serial.PARITY_ODD)
XON_XOFF, RTS_CTS = 1, 2
IN_USE = (errno.EAGAIN, errno.EBUSY)


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
        are sent by the caller that reads. A port has one reader at a time.
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
                exclusive=True,
            )
        except (serial.SerialException, OSError, ValueError) as failure:
            is_used = getattr(failure, "errno", None) in IN_USE
            why = "it is in use" if is_used else reason(failure)
            raise UserError(f"cannot open serial port {self.port}: {why}") from None
