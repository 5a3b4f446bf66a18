"""The primary host of an edge node: what its STATE messages say.

Sparkplug 3.0, operational behaviour: `spBv1.0/STATE/HOST` holds JSON, `online` and `timestamp`;
a state older than the last one does not count. Sparkplug 2.2: `STATE/HOST` is ONLINE or OFFLINE.
"""

import logging
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

log = logging.getLogger(__name__)
WORDS = {b"ONLINE": True, b"OFFLINE": False}  # of 2.2


class State(Struct, frozen=True):
    """The payload of a STATE message of 3.0; other keys are skipped."""

    online: bool
    timestamp: Annotated[int, Meta(ge=0)]


class PrimaryHost:
    """Whether one host is online, by the states it leaves at the broker."""

    def __init__(self, name: str) -> None:
        self._topic, self._old_topic = f"spBv1.0/STATE/{name}", f"STATE/{name}"
        self.topics = (self._topic, self._old_topic)
        self.is_online = False
        self._newest_ms: int | None = None
        self._is_said = False

    def forget(self) -> None:
        """A connection has ended: the next one begins with the state the broker has kept."""
        self.is_online = False

    def hear(self, topic: str, data: bytes) -> None:
        """Take a message; what is no state of this host, or does not count, changes nothing."""
        if topic == self._topic:
            self._hear_state(data)
        elif topic == self._old_topic and self._newest_ms is None:  # 3.0 outdates it
            self._hear_word(data)

    def _hear_state(self, data: bytes) -> None:
        try:
            state = msgspec.json.decode(data, type=State)
        except (msgspec.DecodeError, RecursionError) as error:
            self._say(f"is damaged: {error}")
            return
        if self._newest_ms is not None and state.timestamp < self._newest_ms:
            self._say(f"is older than the last one: {state.timestamp}, {self._newest_ms}")
            return
        self._newest_ms = state.timestamp
        self._take(state.online)

    def _hear_word(self, data: bytes) -> None:
        if data in WORDS:
            self._take(WORDS[data])
        else:
            self._say("is neither ONLINE nor OFFLINE")

    def _take(self, is_online: bool) -> None:
        self._is_said = False
        self.is_online = is_online

    def _say(self, text: str) -> None:
        """Report once what is wrong with states, until one counts."""
        if not self._is_said:
            self._is_said = True
            log.warning("sparkplug: a state of the primary host %s", text)
