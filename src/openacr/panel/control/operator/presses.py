"""Jog keys held on screens: a key moves its axis while its browser keeps saying so.

A press begins with its first message and ends once: by its release, by silence, by anything
that stops the machine. A keep-alive never begins one, and a press that has ended never
comes back, even if the finger is still down and the link returns.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

DEAD_MAN_S = 0.2  # longest time between two keep-alives


class End(Enum):
    """Why a press has ended."""

    RELEASED = "released"
    SILENCE = "silence"
    STOP = "stop"
    ALARM = "alarm"
    MODE = "mode"
    CONTROL = "control"
    REFUSED = "refused"
    LINK = "link"


class Key(NamedTuple):
    """The number of a press, which its browser has chosen."""

    client: int
    number: int


@dataclass(slots=True)
class _Press:
    axis: int
    alive_s: float  # when its last accepted message was received


Ended = Callable[[Key, End, str], None]


class Presses:
    """The presses of all browsers; `drop` stops the axis of one that has ended."""

    def __init__(self, drop: Callable[[int, int], None], ended: Ended) -> None:
        self._drop = drop  # client, axis
        self._ended = ended
        self._held: dict[Key, _Press] = {}
        self._last: dict[int, int] = {}  # the highest number of each client

    @property
    def are_held(self) -> bool:
        """Whether any key is held."""
        return bool(self._held)

    @property
    def axes(self) -> list[int]:
        """The axes that keys hold."""
        return [press.axis for press in self._held.values()]

    def clients(self) -> set[int]:
        """The clients that hold a key."""
        return {key.client for key in self._held}

    def is_new(self, key: Key) -> bool:
        """Whether a number is higher than every earlier one of its client."""
        return key.number > self._last.get(key.client, -1)

    def use_up(self, key: Key) -> None:
        """Note a number as used, whether it moves anything or is refused."""
        self._last[key.client] = max(key.number, self._last.get(key.client, -1))

    def begin(self, key: Key, axis: int, received_s: float) -> None:
        """Note a press that has started its axis."""
        self._held[key] = _Press(axis, received_s)

    def keep(self, key: Key, received_s: float) -> bool:
        """Keep a press alive; False for one that is over or never was."""
        press = self._held.get(key)
        if press is None:
            return False
        press.alive_s = max(press.alive_s, received_s)
        return True

    def end(self, key: Key, why: End, text: str = "") -> None:
        """End a press and stop its axis; one that is over is ignored."""
        press = self._held.pop(key, None)
        if press is None:
            return
        try:
            self._drop(key.client, press.axis)
        finally:
            self._ended(key, why, text)

    def end_axis(self, axis: int, why: End, text: str) -> None:
        """End the press that holds an axis, if there is one."""
        for key in [key for key, press in self._held.items() if press.axis == axis]:
            self.end(key, why, text)

    def end_all(self, why: End, text: str = "", *, client: int | None = None) -> None:
        """End every press, or those of one client."""
        failure: Exception | None = None
        for key in [each for each in self._held if client in (None, each.client)]:
            try:
                self.end(key, why, text)
            except Exception as error:  # the other axes are stopped as well
                failure = error
        if failure is not None:
            raise failure

    def expire(self, now_s: float) -> None:
        """End the presses whose browsers are silent."""
        for key, press in list(self._held.items()):
            if now_s - press.alive_s > DEAD_MAN_S:
                text = f"no sign of the key for {now_s - press.alive_s:.2f} s"
                self.end(key, End.SILENCE, text)

    def forget(self, client: int) -> None:
        """Forget the numbers of a client that has gone; its presses have ended before."""
        self._last.pop(client, None)
