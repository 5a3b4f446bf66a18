"""Carry a conversation out: do what its generator asks for, blocking or with asyncio."""

from typing import Generic, TypeVar, cast

from openacr.client.async_links import AsyncLink
from openacr.client.effects import Close, Effect, Op, Open, Pause, Receive, Send
from openacr.client.errors import ConnectionLostError
from openacr.client.links import Link

T = TypeVar("T")


class _Course(Generic[T]):
    """A conversation on its way: the effect that is wanted next, until there is a result."""

    def __init__(self, op: Op[T]) -> None:
        self._op = op
        self._result: T | None = None
        self.wanted: Effect | None = None
        self.go_on(None)

    def go_on(self, outcome: bytes | BaseException | None) -> None:
        """Hand over what came of the effect: bytes, or why it failed."""
        try:
            if isinstance(outcome, BaseException):
                self.wanted = self._op.throw(outcome)
            else:
                self.wanted = self._op.send(outcome)
        except StopIteration as done:
            self.wanted, self._result = None, done.value

    @property
    def result(self) -> T:
        """What the conversation has come to, once nothing is wanted any more."""
        return cast(T, self._result)


def carry_out(op: Op[T], link: Link) -> T:
    """The result of a conversation over a blocking link.

    Ctrl-C is handed to the conversation like a broken link: it may have to tidy up.
    """
    course = _Course(op)
    while course.wanted is not None:
        outcome: bytes | BaseException | None
        try:
            outcome = _perform(course.wanted, link)
        except (ConnectionLostError, KeyboardInterrupt) as broken:
            outcome = broken
        course.go_on(outcome)
    return course.result


def _perform(effect: Effect, link: Link) -> bytes | None:
    match effect:
        case Send(data):
            link.write(data)
        case Receive(wait_s):
            return link.read(wait_s)
        case Pause(seconds):
            link.pause(seconds)
        case Open():
            link.open()
        case Close():
            link.close()
    return None


async def carry_out_async(op: Op[T], link: AsyncLink) -> T:
    """The result of a conversation over an asyncio link."""
    course = _Course(op)
    while course.wanted is not None:
        outcome: bytes | BaseException | None
        try:
            outcome = await _perform_async(course.wanted, link)
        except ConnectionLostError as broken:
            outcome = broken
        course.go_on(outcome)
    return course.result


async def _perform_async(effect: Effect, link: AsyncLink) -> bytes | None:
    match effect:
        case Send(data):
            await link.write(data)
        case Receive(wait_s):
            return await link.read(wait_s)
        case Pause(seconds):
            await link.pause(seconds)
        case Open():
            await link.open()
        case Close():
            await link.close()
    return None
