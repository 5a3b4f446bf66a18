"""Rules between settings, checked for the cells a change touches before it is stored."""

import re
from collections.abc import Callable, Collection, Iterable
from typing import Protocol

from openacr.models import MODELS
from openacr.sysvar.lookup import AXIS_LETTERS, known, wired
from openacr.sysvar.schema import AXES, FIRST_SYSTEM, Parameter, Wire
from openacr.sysvar.tabs import AXIS, CELLS, CONTROL, DISPLAY, FOV, GENERAL, IO, ROV, SOV, SPINDLE
from openacr.sysvar.values import SettingError

MODEL, RUN_STATE = GENERAL.card_model, CELLS.run_state
RUNNING = frozenset((1, 2, 3, 4))  # run, paused, wait, stop
ANGLE1, ANGLE2 = CONTROL.acute_angle1_threshold, CONTROL.acute_angle2
TABLES = (FOV.percents, ROV.percents, SOV.percents)
FIRST_LINE = {Wire.INPUT: 0, Wire.OUTPUT: 32}
STEERING = {IO.feedhold_input, IO.cycle_start_input, IO.emergency_stop}  # no second function
REFERENCE_OUTPUTS = {IO.g27_output, IO.g28_error_output}  # may share one lamp
# Switches that are read at four inputs, by the cell of the first.
SWITCH_LINES = dict.fromkeys((IO.jog_joystick_input, FOV.switch, ROV.switch, SOV.switch), 4)
MODULES = CONTROL.io_expansion_modules
FIRST_MODULE_LINE, MODULE_LINES, MODULE_INPUTS = 256, 64, 32


class Reader(Protocol):
    """The cells as they will be after the change."""

    def read(self, n: int) -> float:
        """A number."""

    def read_text(self, n: int) -> str:
        """A text."""


def check(cells: Reader, changed: Collection[int], is_running: Callable[[], bool]) -> None:
    """Refuse a group of changes that break a rule; SettingError names one cell of it.

    `is_running` is asked when a setting of motion is among them.
    """
    system = sorted(n for n in changed if n >= FIRST_SYSTEM)
    for n in system:
        if known(n).row.is_motion and is_running():
            raise SettingError(known(n), None, "a program is running", "stop it first")
    if system:
        for rule in _RULES:
            rule(cells, system)


def _soft_limits(cells: Reader, changed: Collection[int]) -> None:
    for axis in range(AXES):
        numbers = AXIS.plus_soft_limit[axis], AXIS.minus_soft_limit[axis], AXIS.disable_limit[axis]
        if set(numbers).isdisjoint(changed):
            continue
        plus, minus, is_off = (cells.read(n) for n in numbers)
        if not is_off and plus <= minus:
            raise SettingError(
                known(AXIS.plus_soft_limit[axis]),
                plus,
                f"it has to be above the -Soft Limit, {minus:g}",
                f"or set P{AXIS.disable_limit[axis]} Disable Limit",
            )


def _axis_names(cells: Reader, changed: Iterable[int]) -> None:
    if set(AXIS.name).isdisjoint(changed):
        return
    names: dict[str, int] = {}
    for n in AXIS.name:
        name = cells.read_text(n)
        if name not in AXIS_LETTERS or len(name) != 1:
            raise SettingError(known(n), name, "one of " + ", ".join(AXIS_LETTERS))
        if name in names:
            raise SettingError(known(n), name, f"P{names[name]} already has that name")
        names[name] = n


def _angles(cells: Reader, changed: Iterable[int]) -> None:
    if {ANGLE1, ANGLE2} & set(changed):
        first, second = cells.read(ANGLE1), cells.read(ANGLE2)
        if second and second < first:
            raise SettingError(
                known(ANGLE2), second, f"it has to be 0, or at least Acute Angle1, {first:g}"
            )


def _override_tables(cells: Reader, changed: Iterable[int]) -> None:
    for table in TABLES:
        if not any(n in table for n in changed):
            continue
        before = 0.0
        for click, n in enumerate(table):
            percent = cells.read(n)
            if percent < before:
                raise SettingError(
                    known(n),
                    percent,
                    f"click {click - 1} has {before:g}",
                    "percentages must not fall from click to click",
                )
            before = percent


def _card_model(cells: Reader, changed: Iterable[int]) -> None:
    if MODEL in changed and cells.read_text(MODEL) not in MODELS:
        raise SettingError(known(MODEL), cells.read_text(MODEL), "one of " + ", ".join(MODELS))


def _wires(cells: Reader, changed: Iterable[int]) -> None:
    """Refuse numbers of inputs and outputs that the card model does not have."""
    count = MODELS[cells.read_text(MODEL)].lines
    modules = int(cells.read(MODULES))
    if MODEL in changed or MODULES in changed:
        changed = [each.number for each in wired()]
    for n in changed:
        row = known(n).row
        if row.wire is None or (value := cells.read(n)) in (-1, row.default):
            continue
        first = FIRST_LINE[row.wire]
        if not first <= value < first + count and not _is_on_module(value, row.wire, modules):
            raise SettingError(
                known(n),
                value,
                f"{row.wire.value}s of the card are {first} to {first + count - 1}",
                "-1: not connected",
            )


def _is_on_module(value: float, wire: Wire, modules: int) -> bool:
    """Whether a line is on an expansion module: each has 32 inputs, then 32 outputs."""
    module, line = divmod(int(value) - FIRST_MODULE_LINE, MODULE_LINES)
    return 0 <= module < modules and (line >= MODULE_INPUTS) == (wire is Wire.OUTPUT)


def _display_formats(cells: Reader, changed: Iterable[int]) -> None:
    for n in changed:
        if n not in DISPLAY.inch_format and n not in DISPLAY.metric_format:
            continue
        value = cells.read(n)
        if not re.fullmatch(r"[0-9]\.[0-9]", f"{value!r}"):
            raise SettingError(known(n), value, "one digit, a point, one digit", "3.4 is ###.####")


def _sharing(cells: Reader, changed: Collection[int]) -> None:
    """Refuse two functions on one output, one DAC or one control input."""
    lines = wired()
    dacs = {SPINDLE.dac, *AXIS.configured, *AXIS.dac_number}
    if not {each.number for each in lines}.isdisjoint(changed):
        _refuse_shared(cells, changed, _users(cells, lines))
    if not dacs.isdisjoint(changed):
        _refuse_shared(cells, changed, _dac_users(cells))


def require_wiring(cells: Reader) -> None:
    """Refuse a machine with two functions on one output, DAC or control input."""
    everything = [each.number for each in wired()]
    _refuse_shared(cells, everything, _users(cells, wired()))
    _refuse_shared(cells, everything, _dac_users(cells))


Users = dict[tuple[str, int], list[int]]  # by line: the cells that name it


def _users(cells: Reader, lines: Iterable[Parameter]) -> Users:
    users: Users = {}
    for each in lines:
        value = int(cells.read(each.number))
        if each.row.wire is None or value in (-1, each.row.default):
            continue
        for line in range(value, value + SWITCH_LINES.get(each.number, 1)):
            users.setdefault((each.row.wire.value, line), []).append(each.number)
    return {
        key: numbers
        for key, numbers in users.items()
        if (key[0] == Wire.OUTPUT.value and set(numbers) != REFERENCE_OUTPUTS)
        or STEERING & set(numbers)
    }


def _dac_users(cells: Reader) -> Users:
    users: Users = {}
    spindle = int(cells.read(SPINDLE.dac))
    if spindle >= 0:
        users["DAC", spindle] = [SPINDLE.dac]
    for configured, dac in zip(AXIS.configured, AXIS.dac_number, strict=True):
        if cells.read(configured):
            users.setdefault(("DAC", int(cells.read(dac))), []).append(dac)
    return users


def _refuse_shared(cells: Reader, changed: Collection[int], users: Users) -> None:
    for (what, line), numbers in users.items():
        if len(numbers) > 1:
            mine = next((n for n in numbers if n in changed), numbers[-1])
            other = known(next(n for n in numbers if n != mine))
            text = f"{what} {line} is already used by P{other.number} {other.name}"
            raise SettingError(known(mine), cells.read(mine), text)


_RULES: tuple[Callable[[Reader, Collection[int]], None], ...] = (
    _soft_limits,
    _axis_names,
    _angles,
    _override_tables,
    _card_model,
    _display_formats,
    _wires,
    _sharing,
)
