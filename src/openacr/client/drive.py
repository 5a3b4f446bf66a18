"""Run a conversation: perform the effects its generator requests, blocking or with asyncio."""

from typing import Generic, TypeVar, cast

from openacr.client.async_links import AsyncLink
from openacr.client.effects import Close, Effect, Op, Open, Pause, Receive, Send
from openacr.client.errors import ConnectionLostError
from openacr.client.links import Link

T = TypeVar("T")


class Conversation(Generic[T]):
    """A running conversation: the effect `wanted` next, None once there is a result."""

    def __init__(self, op: Op[T]) -> None:
        self._op = op
        self._result: T | None = None
        self.wanted: Effect | None = None
        self.go_on(None)

    def go_on(self, outcome: bytes | BaseException | None) -> None:
        """Resume the conversation with the outcome of the effect: bytes, or its failure."""
        try:
            if isinstance(outcome, BaseException):
                self.wanted = self._op.throw(outcome)
            else:
                self.wanted = self._op.send(outcome)
        except StopIteration as done:
            self.wanted, self._result = None, done.value

    @property
    def result(self) -> T:
        """The result of the conversation, once it requests no more effects."""
        return cast(T, self._result)


def carry_out(op: Op[T], link: Link) -> T:
    """Run a conversation over a blocking link and return its result.

    Ctrl-C is passed to the conversation like a broken link: it may have to clean up.
    """
    conversation = Conversation(op)
    while conversation.wanted is not None:
        outcome: bytes | BaseException | None
        try:
            outcome = perform(conversation.wanted, link)
        except (ConnectionLostError, KeyboardInterrupt) as broken:
            outcome = broken
        conversation.go_on(outcome)
    return conversation.result


def perform(effect: Effect, link: Link) -> bytes | None:
    """Perform one effect over a blocking link; the bytes that were received."""
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
    """Run a conversation over an asyncio link and return its result."""
    conversation = Conversation(op)
    while conversation.wanted is not None:
        outcome: bytes | BaseException | None
        try:
            outcome = await _perform_async(conversation.wanted, link)
        except ConnectionLostError as broken:
            outcome = broken
        conversation.go_on(outcome)
    return conversation.result


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
