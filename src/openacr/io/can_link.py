"""Frames of a CAN bus through python-can: a thread reads them, the card takes them from a queue."""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections import deque
from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from openacr.errors import UserError, reason
from openacr.fieldbus.canopen.frames import OFF, WARNING, Frame, Trouble

if TYPE_CHECKING:
    import can

MOST_WAITING = 4096  # frames: half a second of a full bus at 1 Mbit/s
READ_S = 0.1
FAILURES = 10  # in a row, of reading: then the interface is gone
MULTICAST = "udp_multicast"
# Of error frames of Linux (linux/can/error.h): classes in the identifier, details in a byte.
_ERROR_CONTROLLER, _ERROR_BUS_OFF, _ERROR_RESTARTED = 0x04, 0x40, 0x100
_RECEIVE_OVERRUN, _WARNINGS, _ACTIVE = 0x01, 0x3C, 0x40


def _python_can() -> Any:
    try:
        import can
    except ImportError:
        raise UserError("a CAN bus needs python-can: pip install 'openacr[can]'") from None
    logging.getLogger("can").setLevel(logging.ERROR)  # what fails is said by the link
    return can


class CanLink:
    """A CAN bus of the computer; UserError if it cannot be opened.

    `interface` and `channel` as python-can has them, `bit_rate` in kbit/s; it is set where
    python-can can (of `socketcan` it is set by `ip link`).
    """

    def __init__(self, interface: str, channel: str | None, bit_rate: int) -> None:
        self._can = _python_can()
        self.name = channel or interface
        self.bit_rate = bit_rate
        self._how = (interface, channel)
        self._waiting: deque[Frame] = deque()
        self._lost, self._is_overrun, self._errors = 0, False, 0
        self._failure = ""
        self._heard: Collection[int] | None = None
        self._lock = threading.Lock()
        self._bus: can.BusABC | None = None
        self._reader: threading.Thread | None = None
        if failure := self._open():
            raise UserError(f"CAN {self.name}: {failure}")

    def send(self, frame: Frame) -> bool:
        """Send a frame; False if the bus does not take it at once."""
        if self._bus is None or self._failure:
            return False
        message = self._can.Message(
            arbitration_id=frame.id,
            data=frame.data,
            is_extended_id=False,
            is_remote_frame=frame.is_remote,
        )
        try:
            self._bus.send(message, timeout=0)
        except (self._can.CanError, OSError, ValueError):
            return False
        return True

    def take(self) -> list[Frame]:
        """All frames that have arrived since the last call."""
        with self._lock:
            frames = list(self._waiting)
            self._waiting.clear()
        return frames

    def listen(self, identifiers: Collection[int] | None) -> None:
        """Leave out frames with other identifiers, so that they cost nothing; None: take all."""
        self._heard = identifiers
        if self._bus is not None:
            with contextlib.suppress(self._can.CanError, OSError):  # then all are taken
                self._bus.set_filters(_filters(identifiers))

    def trouble(self) -> Trouble:
        """What has gone wrong since the last call."""
        with self._lock:
            now = Trouble(self._lost, self._is_overrun, self._errors, self._failure)
            self._lost, self._is_overrun = 0, False
        return now

    def reopen(self) -> str:
        """Close the bus and open it again; why that is not possible, "" if it is."""
        self.close()
        return self._open()

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""
        return time.monotonic()

    def close(self) -> None:
        """Close the bus; the thread ends within READ_S."""
        bus, self._bus = self._bus, None
        if self._reader is not None:
            self._reader.join()
            self._reader = None
        if bus is not None:
            with contextlib.suppress(Exception):  # whatever a driver raises: it is closed
                bus.shutdown()

    def _open(self) -> str:
        try:
            bus = self._can.Bus(bitrate=1000 * self.bit_rate, **options_of(*self._how))
        except Exception as failure:  # python-can passes on whatever a driver raises
            return _said(failure)
        with self._lock:
            self._waiting.clear()
            self._lost, self._is_overrun, self._errors, self._failure = 0, False, 0, ""
        self._bus = bus
        self.listen(self._heard)
        self._reader = threading.Thread(
            target=self._read, args=(bus,), name=f"CAN {self.name}", daemon=True
        )
        self._reader.start()
        return ""

    def _read(self, bus: can.BusABC) -> None:
        failures = 0  # in a row
        while self._bus is bus and failures < FAILURES:
            try:
                message = bus.recv(READ_S)
            except Exception as failure:  # whatever a driver raises
                failures += 1
                if self._bus is bus and failures == FAILURES:
                    self._failure = _said(failure)
            else:
                failures = 0
                if message is not None:
                    self._arrived(message)

    def _arrived(self, message: can.Message) -> None:
        if message.is_error_frame:
            self._note_error(message)
        elif not message.is_extended_id and not message.is_fd:
            with self._lock:
                if len(self._waiting) < MOST_WAITING:
                    data = bytes(message.data)
                    self._waiting.append(
                        Frame(message.arbitration_id, data, message.is_remote_frame)
                    )
                else:
                    self._lost += 1

    def _note_error(self, message: can.Message) -> None:
        kind, detail = message.arbitration_id, message.data[1] if len(message.data) > 1 else 0
        with self._lock:
            if kind & _ERROR_BUS_OFF:
                self._errors = OFF
            elif kind & _ERROR_RESTARTED:
                self._errors = 0
            elif kind & _ERROR_CONTROLLER:
                self._is_overrun |= bool(detail & _RECEIVE_OVERRUN)
                if detail & _WARNINGS:
                    self._errors = max(self._errors, WARNING)
                elif detail & _ACTIVE and self._errors < OFF:
                    self._errors = 0


def options_of(interface: str, channel: str | None) -> dict[str, Any]:
    """How python-can opens a bus.

    A bus of `udp_multicast` stays on this computer; its channel is a group, or GROUP:PORT, as
    all groups at a port are one bus.
    """
    options: dict[str, Any] = {"interface": interface}
    if channel is not None:
        options["channel"] = channel
    if interface == MULTICAST:
        options |= {"hop_limit": 0, "fd": False}
        group, separator, port = (channel or "").rpartition(":")
        if separator and port.isdigit() and "." in group:
            options |= {"channel": group, "port": int(port)}
    return options


def _filters(identifiers: Collection[int] | None) -> Any:
    if identifiers is None:
        return None
    return [{"can_id": each, "can_mask": 0x7FF, "extended": False} for each in identifiers]


def _said(failure: Exception) -> str:
    return reason(failure) or type(failure).__name__
