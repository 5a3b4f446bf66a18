"""The language side of a card as plain data, for snapshots: texts, queues, channels.

Where programs stand, what they wait for and all numbers lie in the memory map. What they
execute is text here and is compiled anew when a card takes it over.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from msgspec import Meta, Struct

from openacr.basic.channels.devices import Waiting
from openacr.basic.channels.session import Channel
from openacr.basic.memory.program_store import OWNERS, StoredLine
from openacr.basic.memory.ranges import Index, ProgramNumber, ThreadNumber
from openacr.basic.memory.source_table import Collector, Sources, SourceTable
from openacr.basic.memory.string_storage import StringsState
from openacr.errors import CardError, StoreError
from openacr.motion.attachments import Attachments, AttachmentsState

if TYPE_CHECKING:
    from openacr.basic.execute.executor import Executor
    from openacr.basic.execute.system import System


class Language(Struct, frozen=True):
    """What AcroBASIC knows beside the memory map; numbers of lines are places in the table."""

    table: SourceTable
    aliases: Index
    programs: Annotated[list[list[Index]], Meta(min_length=OWNERS, max_length=OWNERS)]
    password: str | None
    threads: dict[ThreadNumber, list[Index]]
    failures: dict[ProgramNumber, str]
    attachments: AttachmentsState
    strings: Annotated[list[StringsState], Meta(min_length=16, max_length=16)]
    devices: list[Waiting]
    channels: dict[str, Channel]
    config: tuple[str, str, str, str]
    addresses: dict[str, str]


def take(system: System, executor: Executor) -> Language:
    """The present state."""
    collector = Collector()
    index = collector.index
    config, threads = system.setup.config, executor.threads
    return Language(
        table=collector.table,
        aliases=collector.names(system.aliases.nodes),
        programs=[list(map(index, system.programs.lines(owner))) for owner in system.owners()],
        password=system.programs.password,
        threads={thread: list(map(index, lines)) for thread, lines in threads.sources.items()},
        failures=dict(threads.failures),
        attachments=system.card.attachments.state(),
        strings=system.storage.locals.strings_state(),
        devices=system.devices.state(),
        channels={name: each.state() for name, each in system.sessions.items()},
        config=(config[0], config[1], config[2], config[3]),
        addresses=dict(system.setup.addresses),
    )


def put_back(system: System, executor: Executor, state: Language) -> None:
    """Take over what `take` returned, after the memory map.

    StoreError, and the language side is in disorder, if the state makes no sense.
    """
    try:
        _put_back(system, executor, state)
    except CardError as error:
        raise StoreError(f"the snapshot holds a text that the card refuses: {error.text}") from None
    except (LookupError, ValueError) as error:
        raise StoreError(f"the snapshot contradicts itself: {error}") from None


def _put_back(system: System, executor: Executor, state: Language) -> None:
    sources = Sources(state.table, system)
    system.card.attachments = Attachments.from_state(state.attachments)
    system.aliases.restore(sources.names[state.aliases])
    texts = [[sources.lines[place] for place in text] for text in state.programs]
    system.programs.restore(texts, state.password)
    system.storage.locals.restore_strings(state.strings)
    system.setup.restore(state.config, state.addresses)
    if state.channels.keys() != system.sessions.keys():
        raise StoreError("the snapshot is of a card with other channels")
    for name, channel in state.channels.items():
        _check_channel(system, channel)
        system.sessions[name].restore(channel)
    system.devices.restore(state.devices)
    threads: dict[int, tuple[StoredLine, ...]] = {
        thread: tuple(sources.lines[place] for place in lines)
        for thread, lines in state.threads.items()
    }
    executor.restore(threads, state.failures)


def _check_channel(system: System, channel: Channel) -> None:
    if channel.partner is not None and channel.partner not in system.sessions:
        raise StoreError(f"the snapshot joins a channel to {channel.partner}, which the card lacks")
    if channel.level == "PLC" and channel.number >= OWNERS - len(system.storage.locals.strings):
        raise StoreError(f"the snapshot has a channel at PLC{channel.number}")
