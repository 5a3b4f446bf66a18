"""Attachments: programs to masters, masters to slaves, axes to feedback and outputs."""

from __future__ import annotations

from openacr.basic.commands.operating_system import GROUP
from openacr.basic.language.grammar import Object, ObjectRef, Str
from openacr.basic.language.registry import ANY, PROG, SYS, command
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import NOT_VALID_AT_THIS_LEVEL
from openacr.motion.axis import attach as attachment

REF = "PG Attachments"
_FEEDBACK = ("ENC", "ADC", "STEPPER")
_SIGNAL = ("DAC", "STEPPER", "CMT")


@command("ATTACH", group=GROUP, levels=SYS | PROG, ref=REF)
def attach(run: Run) -> None:
    """Show the attachments of the program, at SYS those of all axes."""
    if run.program is None:
        lines = attachment.report_system(run.card)
    else:
        lines = attachment.report_program(run.card, run.program)
    for line in lines:
        run.print(line)


@command("ATTACH MASTER #", group=GROUP, levels=PROG, ref=REF, saved=True)
def attach_master(run: Run, number: int) -> None:
    """Give the program a master."""
    attachment.master(run.card, run.needed_program(), number)


@command(
    "ATTACH SLAVE #",
    group=GROUP,
    levels=PROG,
    grammar=(Object("AXIS"), Str("name")),
    ref=REF,
    saved=True,
)
def attach_slave(run: Run, number: int, axis: ObjectRef, name: str) -> None:
    """Give the master of the program an axis, under a name of one to four letters."""
    attachment.slave(run.card, run.needed_program(), number, axis.number, name)


@command(
    "ATTACH AXIS #",
    group=GROUP,
    levels=ANY,
    grammar=(Object(*_FEEDBACK), Object(*_SIGNAL), Object(*_FEEDBACK, optional=True)),
    ref=REF,
    saved=True,
)
def attach_axis(
    run: Run, number: int, position: ObjectRef, signal: ObjectRef, velocity: ObjectRef | None
) -> None:
    """Choose position feedback, output and velocity feedback of an axis."""
    attachment.axis(
        run.card,
        number,
        (attachment.Feedback[position.word], position.number),
        (attachment.Signal[signal.word], signal.number),
        (attachment.Feedback[velocity.word], velocity.number) if velocity else None,
    )


@command("DETACH", group=GROUP, levels=ANY, ref=REF)
def detach(run: Run) -> None:
    """Free the master and all slaves of the program."""
    if run.program is None:
        raise CardError(NOT_VALID_AT_THIS_LEVEL)
    attachment.detach(run.card, run.program)


@command("DETACH SLAVE #", group=GROUP, levels=PROG, ref=REF)
def detach_slave(run: Run, number: int) -> None:
    """Free one slave of the program."""
    attachment.detach_slave(run.card, run.needed_program(), number)


@command("DETACH MASTER #", group=GROUP, levels=PROG, ref=REF)
def detach_master(run: Run, number: int) -> None:
    """Free a master and its slaves."""
    attachment.detach_master(run.card, number)


@command("DETACH ALL", group=GROUP, levels=ANY, ref=REF)
def detach_all(run: Run) -> None:
    """Free the masters and slaves of all programs."""
    attachment.detach_all(run.card)
