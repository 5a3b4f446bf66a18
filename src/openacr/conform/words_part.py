"""The words of cases about AcroMill: part programs, MDI, the store."""

from __future__ import annotations

from collections.abc import Callable

from openacr.conform.form import (
    ANSWERS,
    BLOCK,
    DifferenceError,
    Step,
    compare,
    compare_messages,
    compare_text,
    compare_values,
    messages_taken,
    word,
)
from openacr.conform.stage import Stage
from openacr.errors import UserError
from openacr.sysvar import SettingError


@word("store WHAT = RESULT", ANSWERS)
def write_cell(stage: Stage, step: Step, name: str, text: str) -> None:
    """Set a cell, by number or name, to a value as users write it; below: why it is refused."""
    try:
        stage.mill.write(name, text)
    except SettingError as error:
        compare(step, [str(error)])
    else:
        compare(step, [])


@word("store ? WHAT -> RESULT")
def read_cell(stage: Stage, step: Step, names: str, expected: str) -> None:
    """The values of cells, with `;` between several."""
    compare_values(stage.mill.value, names, expected)


@word("store on disk")
def keep_on_disk(stage: Stage, step: Step) -> None:
    """The store is a new one on disk: `restart` needs it."""
    stage.mill.keep_on_disk()


@word("restart")
def restart(stage: Stage, step: Step) -> None:
    """End the front end, and start it again with the store on disk; the card runs all the while."""
    stage.mill.restart()


@word("parm PNUMBER = VALUE", ANSWERS)
def write_operator(stage: Stage, step: Step, number: int, value: float) -> None:
    """Set a variable on the P PARM screen: P0 to P99 of the card, P100 to P199 of the store."""
    _try(step, lambda: stage.mill.operator.write(number, value))


@word("parm ? WHAT -> RESULT")
def read_operator(stage: Stage, step: Step, names: str, expected: str) -> None:
    """What P PARM shows now, with `;` between several."""
    operator = stage.mill.operator
    compare_values(lambda name: operator.read(int(name.removeprefix("P"))), names, expected)


@word("file NAME:", BLOCK)
def file(stage: Stage, step: Step, name: str) -> None:
    """A file in the folder of the M codes of the user: M300.TXT."""
    stage.mill.put_file(name, "".join(f"{line.text}\n" for line in step.below))


@word("part:", BLOCK)
def part(stage: Stage, step: Step) -> None:
    """Load a part program; nothing runs."""
    stage.mill.text = "\n".join(line.text for line in step.below) + "\n"


@word("part of dialect NAME:", BLOCK)
def part_of(stage: Stage, step: Step, dialect: str) -> None:
    """The same in another dialect."""
    stage.mill.dialect = dialect
    part(stage, step)


@word("entries:", BLOCK)
@word("entries: TEXT", BLOCK, takes_remark=False)
def entries(stage: Stage, step: Step, text: str = "") -> None:
    """The canonical entries the part becomes without a machine, a line each."""
    compare_text(step, text, list(stage.mill.entries()))


@word("check part:", BLOCK)
def check_part(stage: Stage, step: Step) -> None:
    """Messages of `openacr mill check`: `# E: E203 ...` or `# W: W212 ...` at their lines."""
    text = "\n".join(messages_taken(step)) + "\n"
    found = stage.mill.messages(text)
    compare_messages(
        step, [(each.line, not each.is_error, f"{each.code} {each.text}") for each in found]
    )


@word("run")
def run(stage: Stage, step: Step) -> None:
    """Start the part and wait for its end; `took` is its motion, from first to last."""
    stage.mill.start()
    stage.took_tk = stage.mill.wait_for("IDLE")


@word("wait for MODE")
def wait_for(stage: Stage, step: Step, state: str) -> None:
    """Wait until the machine is in a state; `took` is the motion meanwhile."""
    stage.took_tk = stage.mill.wait_for(state)


def _try(step: Step, act: Callable[[], object]) -> None:
    """Do something that the operator asks for; the lines below are why it is refused."""
    try:
        act()
    except UserError as error:
        compare(step, str(error).split("\n"))
    else:
        compare(step, [])


@word("start", ANSWERS)
@word("start TEXT", ANSWERS)
def start(stage: Stage, step: Step, options: str = "") -> None:
    """Start the part: with `dry`, `block`, `skipping`, `line 5` ...; below: why it is refused."""
    _try(step, lambda: stage.mill.start(options))


@word("press BUTTON", ANSWERS)
def press_button(stage: Stage, step: Step, button: str) -> None:
    """Press a button of the front end; below: why it is refused."""
    _try(step, lambda: stage.mill.press(button))


@word("block STATE")
def block(stage: Stage, step: Step, on: bool) -> None:
    """Switch block mode, also while a program runs."""
    stage.mill.session.runner.block(on)


@word("click NAME NUMBER")
def click(stage: Stage, step: Step, override: str, number: int) -> None:
    """Turn the switch of an override (FOV, ROV, SOV) to a click."""
    stage.mill.switch(override, number)


@word("trace NAME", ANSWERS)
def trace(stage: Stage, step: Step, direction: str) -> None:
    """Trace the path of a pause `back`, `forward`, or `stop`; below: why it is refused."""
    _try(step, lambda: stage.mill.trace(direction))


@word("jog TEXT", ANSWERS)
def jog(stage: Stage, step: Step, text: str) -> None:
    """Hold or release a key (`X+`, `X- fast`, `X off`), jog by `X+0.5`, `X- increment 3`."""
    _try(step, lambda: stage.mill.jog(text))


@word("home", ANSWERS)
@word("home TEXT", ANSWERS)
def home(stage: Stage, step: Step, names: str = "") -> None:
    """Begin to home axes, or all; below: why it is refused."""
    _try(step, lambda: stage.mill.home(names))


@word("wheel", ANSWERS)
@word("wheel TEXT", ANSWERS)
def wheel(stage: Stage, step: Step, names: str = "") -> None:
    """Connect the hand wheel to axes; `wheel` alone leaves it."""
    _try(step, lambda: stage.mill.turn(names))


@word("lose NAME")
def lose(stage: Stage, step: Step, what: str) -> None:
    """The `panel` whose keys are held, or the `host` itself, is not heard any more."""
    stage.mill.lose(what)


@word("zero TEXT", ANSWERS)
def zero(stage: Stage, step: Step, words: str) -> None:
    """Set the floating zero: the axes named read 0 (`X`), or a value (`X5`)."""
    _try(step, lambda: stage.mill.zero(words))


@word("clear zero", ANSWERS)
def clear_zero(stage: Stage, step: Step) -> None:
    """Clear the floating zero of all axes."""
    _try(step, stage.mill.clear_zero)


@word("go to zero", ANSWERS)
@word("go to zero TEXT", ANSWERS)
def go_to_zero(stage: Stage, step: Step, names: str = "") -> None:
    """Move axes, or all, to the zero of the program."""
    _try(step, lambda: stage.mill.go_to_zero(names))


@word("reads TEXT")
def reads(stage: Stage, step: Step, text: str) -> None:
    """What the axes read in the program's coordinates, to 4 digits; others read 0."""
    shown = {name: round(value, 4) + 0.0 for name, value in stage.mill.reading().items()}
    wanted = dict.fromkeys(shown, 0.0) | {
        word[0]: float(word[1:]) for word in text.split() if text != "0"
    }
    if wanted != shown:
        raise DifferenceError(_words(wanted), _words(shown))


def _words(places: dict[str, float]) -> str:
    return " ".join(f"{name}{value:g}" for name, value in places.items())


@word("mdi LINE", ANSWERS, takes_remark=False)
def mdi(stage: Stage, step: Step, block: str) -> None:
    """Run a block of MDI to its end; the lines below are the errors it is refused with."""
    compare(step, stage.mill.type(block))
    stage.took_tk = stage.mill.took_tk


@word("state: TEXT")
def state(stage: Stage, step: Step, text: str) -> None:
    """The state of the machine, and its reason."""
    runner = stage.mill.session.runner
    shown = f"{runner.state.name} {runner.reason}".strip()
    if shown != text:
        raise DifferenceError(text, shown)


@word("alarm:", BLOCK)
@word("alarm: TEXT", BLOCK, takes_remark=False)
def alarm(stage: Stage, step: Step, text: str = "") -> None:
    """The active alarms with their codes, oldest first; a case without it has none at its end."""
    stage.mill.are_alarms_expected = True
    compare_text(step, text, stage.mill.alarms())


@word("says:", BLOCK)
@word("says: TEXT", BLOCK, takes_remark=False)
def says(stage: Stage, step: Step, text: str = "") -> None:
    """All that the operator has been shown since it was last compared."""
    shown, stage.mill.heard[:] = list(stage.mill.heard), []
    compare_text(step, text, shown)


@word("at TEXT")
def at(stage: Stage, step: Step, text: str) -> None:
    """Where the axes are commanded to be, in machine coordinates, to the pulse; others are at 0."""
    pulses, per_unit = stage.mill.place()
    wanted = dict.fromkeys(pulses, 0)
    for axis in text.split() if text != "0" else ():
        wanted[axis[0]] = round(float(axis[1:]) * per_unit.get(axis[0], 1.0))
    if wanted != pulses:
        raise DifferenceError(_place(wanted), _place(pulses))


def _place(pulses: dict[str, int]) -> str:
    return " ".join(f"{axis}{value}" for axis, value in pulses.items()) + " pulses"
