"""The project of the card: which programs differ from it, their texts, another text stored."""

import asyncio
import time
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from openacr.client import Level
from openacr.client.backup import backup
from openacr.client.effects import Op
from openacr.client.stored import ListedLine, listing, rooms
from openacr.client.talk import Talk
from openacr.errors import UserError
from openacr.mill.card.setup import lines
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, endpoint
from openacr.panel.server.calls.on_card import OfProgram, talked
from openacr.panel.server.panel import Panel
from openacr.panel.work import project_setup as project_set_up
from openacr.panel.work.project_texts import State, beside, states, store, text_of

MOST_TEXT = 2_000_000  # characters
MOST_WAIT_S, LOOK_S = 30.0, 0.1  # for the end of a jog
Listings = dict[str, list[ListedLine]]


class Stored(Body, frozen=True):
    """The text a program gets in its project; `version` is that of the file it was made of."""

    name: Annotated[str, Meta(pattern="^(PROG(\\d|1[0-5])|PLC[0-7])$")]
    text: Annotated[str, Meta(min_length=1, max_length=MOST_TEXT)]
    version: Annotated[str, Meta(max_length=40)]


class SetUp(Body, frozen=True):
    """The version of the set-up file that was read."""

    version: Annotated[str, Meta(max_length=40)]


@endpoint("GET", "/project")
async def project(call: Call) -> object:
    """The project in whose folder the card has begun, and its programs beside those of the card.

    `name` is empty where there is no project. The state of a text is equal, differs, or where it
    is alone: card, project. What differs on the card is lost with its process.
    """
    root = call.panel.installation.project
    if root is None:
        return {"name": "", "differs": [], "texts": []}
    found = await _states(call.panel, root)
    return {
        "name": call.panel.installation.name,
        "differs": [name for name, state in found.items() if state != "equal"],
        "texts": [{"name": name, "state": state} for name, state in found.items()],
    }


@endpoint("GET", "/project/compare", query=OfProgram)
async def compare_project(call: Call) -> object:
    """A program of the project beside the card's: lines that mean the same are opposite."""
    level = call.query.level
    listed = await talked(call.panel, lambda talk: listing(talk, level))
    rows = await call.panel.checks.run(beside, _root(call), str(level), listed)
    return {"name": str(level), "rows": rows, "is_equal": all(row.is_same for row in rows)}


@endpoint("GET", "/project/text", query=OfProgram)
async def project_text(call: Call) -> object:
    """A program as the project has it, with its comments, and whether the card's is the same."""
    level = call.query.level
    listed = await talked(call.panel, lambda talk: listing(talk, level))
    return asdict(await call.panel.checks.run(text_of, _root(call), str(level), listed))


@endpoint("POST", "/project/text", Role.SERVICE, body=Stored)
async def store_project_text(call: Call) -> object:
    """Store the text of a program in the folder of the project; the card is left as it is.

    What is around the program in its file stays. `conflict` where the file has changed since.
    """
    body: Stored = call.body
    stored = await call.panel.checks.run(store, _root(call), body.name, body.text, body.version)
    call.panel.control.call(lambda station: station.on_card.programs.texts_changed(body.name))
    return {"file": stored.file, "version": stored.version}


@endpoint("GET", "/project/setup")
async def project_setup(call: Call) -> object:
    """The set-up of the card beside that of the project: memory, attachments, aliases, settings.

    Each row has the line of the set-up file (0: none), the value of the project and that of the
    card (null: not there); `by` is machine where it is what AcroMill sets for its machine. The card
    is asked for more than a thousand values: this takes seconds.
    """
    root = _root(call)
    reading = await _reading(call.panel)
    rows = await call.panel.checks.run(project_set_up.compared, root, reading)
    return {
        "version": project_set_up.version(root),
        "differs": sum(not row.by for row in rows),
        "rows": rows,
        "not_compared": project_set_up.not_compared(reading),
    }


@endpoint("POST", "/project/setup", Role.SERVICE, body=SetUp)
async def store_project_setup(call: Call) -> object:
    """Store what differs into the set-up file of the project; the card is left as it is.

    `conflict` where the file has changed since.
    """
    body: SetUp = call.body
    reading = await _reading(call.panel)
    rows = await call.panel.checks.run(project_set_up.store, _root(call), reading, body.version)
    return {"lines": len(rows)}


async def _reading(panel: Panel) -> project_set_up.Reading:
    """What the card reports of its set-up, and what AcroMill has set of it."""

    def ours(station: Station) -> tuple[str, str, tuple[str, ...]]:
        session = station.link.required
        if not session.is_set_up:
            return "", "", ()
        settings = session.runner.settings
        own = Level.program(settings.watchdog_program)
        return str(own), f"PROG{settings.master}", tuple(lines(settings))

    known = await panel.ask(ours)
    until_s = time.monotonic() + MOST_WAIT_S
    while True:  # while an axis is jogged here, the card has the speed of that jog set
        begun = await _at_rest(panel, until_s)
        found = await talked(panel, backup)
        if begun == await panel.ask(lambda station: station.card_jogs.begun):
            return project_set_up.Reading(found, *known)


async def _at_rest(panel: Panel, until_s: float) -> int:
    """Wait until no axis is jogged here; how many jogs there were."""
    while await panel.ask(lambda station: station.card_jogs.are_active):
        if time.monotonic() > until_s:
            raise UserError("an axis is jogged, with a speed of its own: READ when it rests")
        await asyncio.sleep(LOOK_S)
    return await panel.ask(lambda station: station.card_jogs.begun)


async def differences(panel: Panel) -> list[str]:
    """The programs of the card that differ from its project; none where it has no project."""
    root = panel.installation.project
    found = {} if root is None else await _states(panel, root)
    return [name for name, state in found.items() if state != "equal"]


async def _states(panel: Panel, root: Path) -> dict[str, State]:
    def own(station: Station) -> Level | None:
        """The program that the panel itself stores on the card: it is no part of the project."""
        settings = station.times.settings
        return None if settings is None else Level.program(settings.watchdog_program)

    theirs = await panel.ask(own)
    found = await talked(panel, _listings)
    compared = await panel.checks.run(states, root, found)
    return {name: state for name, state in compared.items() if name != str(theirs)}


def _listings(talk: Talk) -> Op[Listings]:
    levels: Iterable[Level] = yield from rooms(talk)
    found = {}
    for level in levels:
        found[str(level)] = yield from listing(talk, level)
    return found


def _root(call: Call) -> Path:
    root = call.panel.installation.project
    if root is None:
        raise UserError("this card has no project: `openacr panel FOLDER` opens one")
    return root
