"""Two serial ports, one to a host and one to a card, joined into a line that is recorded.

Every byte is passed on as it comes, XON and XOFF too: flow control is between host and card. Each
direction has a thread, as pyserial blocks; an end that does not read holds the other one back by
the buffers of the system. If the recording cannot be written any more, it ends, and the line
goes on.
"""

import logging
import threading

import serial

from openacr.errors import UserError, reason
from openacr.io.recorded_session import SessionRecorder
from openacr.io.serial_port import LineSettings, open_port
from openacr.journal.entries import Entered

log = logging.getLogger(__name__)
THE_LINE = 1  # the only connection of the recording
END_S = 2.0  # for a direction to end


class SerialTap:
    """A serial line with a recorder in it."""

    def __init__(self, host: str, card: str, line: LineSettings) -> None:
        """Open both ports; UserError if one cannot be had."""
        self._card = open_port(card, line)
        try:
            self._host = open_port(host, line)
        except UserError:
            self._card.close()
            raise
        self._recorder: SessionRecorder | None = None
        self._threads: list[threading.Thread] = []
        self._ending = threading.Event()
        self.has_failed = False

    def start(self, recorder: SessionRecorder) -> None:
        """Pass bytes on from now on."""
        self._recorder = recorder
        self._record(Entered.OPEN)
        for source, target, what in (
            (self._host, self._card, Entered.BYTES),
            (self._card, self._host, Entered.SENT),
        ):
            thread = threading.Thread(target=self._pass, args=(source, target, what), daemon=True)
            thread.start()
            self._threads.append(thread)

    def wait(self) -> None:
        """Return when a port has failed; KeyboardInterrupt comes through."""
        while not self._ending.wait(0.2):  # without a limit a signal would wait, too
            pass

    def close(self) -> None:
        """End both directions and close the ports; calling it again has no effect."""
        self._ending.set()
        if self._threads:
            for port in (self._host, self._card):
                port.cancel_write()
            for thread in self._threads:
                thread.join(END_S)
            self._record(Entered.CLOSE)
            self._threads = []
        self._host.close()
        self._card.close()

    def _pass(self, source: serial.Serial, target: serial.Serial, what: Entered) -> None:
        try:
            while not self._ending.is_set():
                if first := source.read(1):
                    data = first + source.read(source.in_waiting)
                    self._record(what, data)
                    target.write(data)
        except (serial.SerialException, OSError, TypeError) as failure:
            if not self._ending.is_set():
                log.error("%s: %s", source.port, reason(failure))
                self.has_failed = True
            self._ending.set()

    def _record(self, what: Entered, data: bytes = b"") -> None:
        if self._recorder is not None:
            self._recorder.note(THE_LINE, what, data)
