"""Carry a conversation out: do what its generator asks for, blocking or with asyncio."""

from typing import TypeVar

from openacr.client.async_links import AsyncLink
from openacr.client.errors import ConnectionLostError
from openacr.client.links import Link
from openacr.client.talk import Close, Effect, Op, Open, Pause, Receive, Send

T = TypeVar("T")


def carry_out(op: Op[T], link: Link) -> T:
    """The result of a conversation over a blocking link.

    Ctrl-C is handed to the conversation like a broken link: it may have to tidy up.
    """
    result: bytes | None = None
    failure: ConnectionLostError | KeyboardInterrupt | None = None
    while True:
        try:
            effect = op.throw(failure) if failure else op.send(result)
        except StopIteration as done:
            value: T = done.value
            return value
        result = failure = None
        try:
            result = _perform(effect, link)
        except (ConnectionLostError, KeyboardInterrupt) as broken:
            failure = broken


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
    result: bytes | None = None
    failure: ConnectionLostError | None = None
    while True:
        try:
            effect = op.throw(failure) if failure else op.send(result)
        except StopIteration as done:
            value: T = done.value
            return value
        result = failure = None
        try:
            result = await _perform_async(effect, link)
        except ConnectionLostError as broken:
            failure = broken


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
