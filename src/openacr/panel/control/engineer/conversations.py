"""Conversations with the card beside the session of the machine, on a stream of their own.

Listings, texts that are stored, a program that is listened to: they may take seconds. They are
carried out piece by piece between two steps of the control thread, which never waits for them.
"""

import logging
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from typing import Any, TypeVar

from openacr.client import ConnectionLostError, Options
from openacr.client.drive import Conversation, carry_out, perform
from openacr.client.effects import Effect, Op, Open, Pause, Receive
from openacr.client.links import Link, ProcessLink, SerialLink, link_to
from openacr.client.talk import Talk
from openacr.errors import OpenacrError, UserError
from openacr.panel.control.machine.history import STILL
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.opening import close, opened
from openacr.timeline import Course

log = logging.getLogger(__name__)
T = TypeVar("T")
Talks = Callable[[Talk], Op[T]]
MOST_WAITING = 20
OPTIONS = Options(reconnect_s=0.0)
TURN = 8  # effects between two steps of the machine
NO_SECOND = "a card on a serial port has no second connection: its programs are not read or changed"


def answer_of(moment: Course, talks: Talks[T]) -> T:
    """The result of a conversation with the card as it was at a moment; any thread may ask.

    It is held with a copy of that card, whose answers take no tick: all of them are of the moment.
    What a conversation changes is changed in the copy alone: it only asks.
    """
    link = ProcessLink(moment.at_last())
    return carry_out(talks(Talk(link.name, link.kind, OPTIONS, link.now_s)), link)


class Wait:
    """The outcome of an effect that is not there yet."""


WAIT = Wait()


class Aside:
    """Conversations one after the other, on one stream that is open as long as there are some."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self._waiting: deque[tuple[Talks[Any], Future[Any]]] = deque()
        self._future: Future[Any] | None = None
        self._conversation: Conversation[Any] | None = None
        self._link: Link | None = None
        self._talk: Talk | None = None
        self._opening: Future[None] | None = None
        self._until_s: float | None = None  # of a pause, or the end of a wait for bytes
        self._now_s = 0.0

    @property
    def is_busy(self) -> bool:
        """Whether a conversation is under way or waits."""
        return self._conversation is not None or bool(self._waiting)

    def begin(self, talks: Talks[T], future: "Future[T] | None" = None) -> "Future[T]":
        """Queue a conversation; its result or error is set in the control thread. UserError."""
        if self._is_serial:
            raise UserError(NO_SECOND)
        history = self._installation.history
        if history is not None and history.is_still:
            raise UserError(STILL)
        if len(self._waiting) >= MOST_WAITING:
            raise UserError("too many listings are asked for: try again")
        future = future or Future()
        self._waiting.append((talks, future))
        return future

    @property
    def _is_serial(self) -> bool:
        return isinstance(link_to(self._installation.target), SerialLink)

    def step(self, now_s: float) -> None:
        """Carry on for a few effects; never waits."""
        self._now_s = now_s
        for _ in range(TURN):
            if self._conversation is None and not self._start():
                return
            if not self._carry_on():
                return

    def end(self) -> None:
        """Break everything off: the card is out of reach, or the panel ends."""
        lost = ConnectionLostError("the connection to the card was closed")
        if self._conversation is not None:
            with suppress(Exception):
                self._conversation.go_on(lost)
        waiting, self._waiting = [future for _, future in self._waiting], deque()
        for future in [self._future, *waiting]:
            if future is not None and not future.done():
                future.set_exception(lost)
        self._conversation = self._future = None
        self._close()

    # --- one conversation -------------------------------------------------------------

    def _start(self) -> bool:
        if not self._waiting:
            self._close()
            return False
        talks, self._future = self._waiting.popleft()
        if not self._future.set_running_or_notify_cancel():
            return True
        self._guarded(lambda: Conversation(talks(self._talker())))
        return True

    def _talker(self) -> Talk:
        if self._talk is None:
            self._link = link_to(self._installation.target)
            self._talk = Talk(self._link.name, self._link.kind, OPTIONS, lambda: self._now_s)
        return self._talk

    def _carry_on(self) -> bool:
        """Perform the next effect; False where it has to wait."""
        conversation, link = self._conversation, self._link
        if conversation is None or link is None:
            return True
        outcome: bytes | BaseException | Wait | None
        try:
            outcome = self._outcome(conversation.wanted, link)
        except ConnectionLostError as broken:
            outcome = broken
        if isinstance(outcome, Wait):
            return False
        self._until_s = None
        found = outcome

        def go_on() -> Conversation[Any]:
            conversation.go_on(found)
            return conversation

        self._guarded(go_on)
        return True

    def _outcome(self, effect: Effect | None, link: Link) -> "bytes | Wait | None":
        if isinstance(effect, Receive):
            return link.read(0.0) or (b"" if self._has_passed(effect.wait_s) else WAIT)
        if isinstance(effect, Open):
            return self._opened(link)
        if isinstance(effect, Pause):
            return None if self._has_passed(effect.seconds) else WAIT
        return None if effect is None else perform(effect, link)

    def _opened(self, link: Link) -> "Wait | None":
        """Open the link; a host that does not answer is not waited for here."""
        if self._opening is None:
            self._opening = opened(link)
        if not self._opening.done():
            return WAIT
        opening, self._opening = self._opening, None
        opening.result()
        return None

    def _has_passed(self, seconds: float | None) -> bool:
        """Whether a time has passed since this effect was first tried."""
        if self._until_s is None and seconds is not None:
            self._until_s = self._now_s + seconds
        return self._until_s is not None and self._now_s >= self._until_s

    def _guarded(self, go_on: Callable[[], Conversation[Any]]) -> None:
        """Let the conversation go on; its result or failure ends it."""
        future = self._future
        if future is None:
            return
        try:
            conversation = go_on()
        except OpenacrError as error:
            self._drop()
            future.set_exception(error)
        except Exception as error:
            log.exception("a conversation with the card has failed")
            self._drop()
            future.set_exception(error)
        else:
            self._conversation = conversation
            if conversation.wanted is None:
                self._drop()
                future.set_result(conversation.result)

    def _drop(self) -> None:
        self._conversation, self._future = None, None

    def _close(self) -> None:
        link, self._link, self._talk = self._link, None, None
        opening, self._opening = self._opening, None
        self._until_s = None
        if link is not None:
            close(link, opening)
