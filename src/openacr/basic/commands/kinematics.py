"""Inverse kinematics: INVK."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.interpolation import GROUP, REF
from openacr.basic.language import registry
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.path import kinematics

command = partial(registry.command, group=GROUP, ref=REF)


@command("INVK", levels=BY_OBJECT)
def invk(run: Run) -> None:
    """Report the program of the kinematics, and whether they are on."""
    master = run.master()
    program = kinematics.program_of(run.card, master)
    state = "ON" if kinematics.is_on(run.card, master) else "OFF"
    run.print(state if program is None else f"PROG{program} {state}")


@command("INVK PROG #", levels=BY_OBJECT)
def invk_prog(run: Run, program: int) -> None:
    """Choose the program that computes the joints (P12361) of the tool's place (P12360)."""
    if not 0 <= program < PROGRAMS:
        raise CardError(INVALID_ARGUMENT)
    master = run.master()
    kinematics.needs_rest(run.card, master)
    kinematics.choose(run.card, master, program)
    if kinematics.is_on(run.card, master):
        run.system.runner.load_kinematics(master, program)


@command("INVK ON", levels=BY_OBJECT)
def invk_on(run: Run) -> None:
    """Let the path of the master be that of the tool, and its axes the joints."""
    master = run.master()
    program = kinematics.program_of(run.card, master)
    if program is None or not run.system.programs.lines(program):
        raise CardError(INVALID_ARGUMENT)
    kinematics.needs_rest(run.card, master)
    run.system.runner.load_kinematics(master, program)
    kinematics.switch_on(run.card, master)


@command("INVK OFF", levels=BY_OBJECT)
def invk_off(run: Run) -> None:
    """Let the path of the master be that of its axes again."""
    master = run.master()
    if kinematics.is_on(run.card, master):
        kinematics.needs_rest(run.card, master)
        kinematics.switch_off(run.card, master)
        run.system.runner.forget_kinematics(master)
