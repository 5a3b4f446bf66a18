"""What is to be debugged, by the arguments of a launch."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from openacr.controller.controller import Controller
from openacr.controller.journal import read_journal
from openacr.debugger import questions
from openacr.debugger.card_target import CardTarget
from openacr.debugger.requests import Launch
from openacr.debugger.target import Target
from openacr.errors import UserError
from openacr.project import find_project

_KINDS = (
    "`program` (a project), `journal` (of a card), `partProgram` (on a virtual machine)"
    " or `host` (a card over a link)"
)


def opened(wanted: Launch, show: Callable[[str], None]) -> Target:
    """The target of a launch; errors of project, journal or part program."""
    if sum(map(bool, (wanted.program, wanted.journal, wanted.part_program, wanted.host))) != 1:
        raise UserError(f"launch: give either {_KINDS}")
    if wanted.host:
        return _over_link(wanted)
    if wanted.part_program:
        return _part_program(wanted, show)
    target = _journal(wanted, show) if wanted.journal else _project(wanted, show)
    for program in wanted.run:
        questions.run_program(target.card, program)
    return target


def _project(wanted: Launch, show: Callable[[str], None]) -> CardTarget:
    target = CardTarget(Controller.from_project(wanted.program), show)
    if scenario := find_project(wanted.program).scenario:
        show(
            f"note: {scenario} is not played here; `openacr run {wanted.program} --journal FILE`"
            " records a run with it, which a launch with `journal` debugs\n"
        )
    return target


def _journal(wanted: Launch, show: Callable[[str], None]) -> CardTarget:
    journal = read_journal(Path(wanted.journal))
    folder = Path(wanted.devices) if wanted.devices else None
    card = Controller(journal.header.model, world=journal.header.world, device_folder=folder)
    card.take_over(journal.snapshot)
    if card.digest() != journal.header.digest:
        raise UserError(f"{wanted.journal}: its snapshot is not that of its first tick")
    card.owns_console = True  # lines that are typed now continue those of the journal
    target = CardTarget(card, show)
    last_tk = max([journal.header.tick, *(entry.tick for entry in journal.entries)])
    target.course.timeline.foresee(journal.entries, last_tk)
    return target


def _part_program(wanted: Launch, show: Callable[[str], None]) -> Target:
    from openacr.debugger.part_programs.target import PartTarget
    from openacr.sysvar.location import open_to_read

    store = open_to_read(Path(wanted.store) if wanted.store else None)
    try:
        return PartTarget(Path(wanted.part_program), store, wanted.dialect or None, show)
    except BaseException:
        store.close()
        raise


def _over_link(wanted: Launch) -> Target:
    from openacr.debugger.real_cards.followers import Followers
    from openacr.debugger.real_cards.link import CardLink
    from openacr.debugger.real_cards.target import RealCardTarget

    if wanted.stop_on_entry and not wanted.run:
        raise UserError("stopOnEntry: a card that runs is not stopped; name programs to `run`")
    link = CardLink(wanted.host)
    followers = Followers(wanted.host)
    try:
        if wanted.listen and link.is_serial:
            raise UserError("listen: a serial line carries the debugger alone; LISTEN needs TCP")
        if not link.is_serial:
            for program in dict.fromkeys(wanted.listen or wanted.run):
                followers.follow(program)
        return RealCardTarget(link, followers, wanted.run, is_held_at_start=wanted.stop_on_entry)
    except BaseException:
        followers.close()
        link.close()
        raise
