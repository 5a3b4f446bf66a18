"""Two serial ports, one to a host and one to a card, joined into a line that is recorded.

Every byte is passed on as it comes, XON and XOFF too: flow control is between host and card. Each
direction has a thread, as pyserial blocks; an end that does not read holds the other one back by
the buffers of the system. If the recording cannot be written any more, it ends, and the line
goes on.
"""

import logging
import threading
import time

import serial

from openacr.errors import UserError, reason
from openacr.io.recording import Event, Recorder, What
from openacr.io.serial_port import LineSettings, open_port

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
        self._begin_s = time.monotonic()
        self._lock = threading.Lock()  # two threads write the recording
        self._recorder: Recorder | None = None
        self._threads: list[threading.Thread] = []
        self._ending = threading.Event()
        self.events = 0
        self.has_failed = False

    def start(self, recorder: Recorder) -> None:
        """Pass bytes on from now on."""
        self._recorder = recorder
        self._record(What.OPEN)
        for source, target, what in (
            (self._host, self._card, What.HOST),
            (self._card, self._host, What.CARD),
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
            self._record(What.CLOSE)
            self._threads = []
        self._host.close()
        self._card.close()

    def _pass(self, source: serial.Serial, target: serial.Serial, what: What) -> None:
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

    def _record(self, what: What, data: bytes = b"") -> None:
        with self._lock:
            if self._recorder is None:
                return
            try:
                self._recorder.add(Event(time.monotonic() - self._begin_s, THE_LINE, what, data))
                self.events += 1
            except OSError as failure:
                self._recorder = None
                log.error("the recording ends here: %s; the line goes on", reason(failure).lower())
