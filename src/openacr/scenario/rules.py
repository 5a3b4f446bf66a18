"""Rules of a scenario beyond the types of single keys: which keys belong together."""

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet

from msgspec import UNSET, Struct
from msgspec.structs import fields

from openacr.errors import MapError
from openacr.map import flag, parameter
from openacr.plant import inputs
from openacr.plant.world.faults import QUANTITIES
from openacr.scenario.schema import (
    Action,
    Analog,
    Command,
    Condition,
    Drag,
    Expectation,
    Fault,
    Mend,
    Scenario,
)

Step = str | int

# The analog inputs of the card and of up to four CANopen nodes.
ANALOG_INPUTS = frozenset([*range(6408, 6536, 16), *range(33288, 35328, 16)])
STREAMS = ("FIFO", "COM1", "COM2", "DPCB", *(f"STREAM{n}" for n in range(1, 6)))
_INPUTS = "inputs are bits " + ", ".join(f"{first}..{last}" for first, last in inputs.RANGES)
START, END = "start", "end"

STRUCT_OF_KEY: dict[str, type[Struct]] = {
    "at": Action,
    "expect": Expectation,
    "when": Condition,
    "drag": Drag,
    "analog": Analog,
    "fault": Fault,
    "mend": Mend,
    "command": Command,
}

_SUBJECTS = ("parameter", "flag", "axis", "program", "printed", "between")
_DEEDS = ("set", "clear", "release", "press", "send", "key", "drag", "analog", "fault", "mend",
          "command", "checkpoint")  # fmt: skip
_CONDITIONS = ("bit", "parameter", "axis", "printed", "program")
_MOMENTS = ("time_s", "when", "after")
# Of each of these sets an entry has at least one key; of those below it has exactly one.
AT_LEAST_ONE: dict[type[Struct], tuple[tuple[str, ...], ...]] = {Action: (_MOMENTS, _DEEDS)}
EXACTLY_ONE: dict[type[Struct], tuple[tuple[str, ...], ...]] = {
    Condition: (_CONDITIONS,),
    Expectation: (_SUBJECTS,),
}
_COMPANIONS = {
    "parameter": {"is", "above", "below", "tolerance"},
    "flag": {"is"},
    "axis": {"position", "commanded", "tolerance"},
    "program": {"state"},
    "printed": set[str](),
    "between": {"duration_s", "tolerance"},
}
_ANY_SUBJECT = {"name", "time_s", "when", "after", "delay_s"}


class Problem(Struct, frozen=True):
    """One contradiction: its place, its text, and what is allowed."""

    steps: tuple[Step, ...]
    text: str
    hint: str = ""


def allowed_keys(where: Sequence[Step]) -> list[str]:
    """List the keys allowed in the table at this place."""
    name = next((step for step in reversed(where) if isinstance(step, str)), "")
    struct = STRUCT_OF_KEY.get(name, Scenario)
    return [field.encode_name for field in fields(struct)]


def given(item: Struct) -> set[str]:
    """Name the keys that were written down (those that differ from their default)."""
    return {
        field.encode_name
        for field in fields(type(item))
        if getattr(item, field.name) != field.default
    }


def problems(scenario: Scenario) -> Iterator[Problem]:
    """Find every contradiction, in the order of the file's tables."""
    checkpoints = {START, END}
    for index, action in enumerate(scenario.at):
        if action.checkpoint:
            if action.checkpoint in checkpoints:
                text = f"checkpoint {action.checkpoint!r} exists already"
                yield Problem(("at", index, "checkpoint"), text)
            checkpoints.add(action.checkpoint)
    for index, action in enumerate(scenario.at):
        yield from _moment(("at", index), action, scenario, checkpoints, required=True)
        yield from _action(("at", index), action)
    for index, expectation in enumerate(scenario.expect):
        yield from _moment(("expect", index), expectation, scenario, checkpoints, required=False)
        yield from _expectation(("expect", index), expectation, checkpoints)


def _moment(
    where: tuple[Step, ...],
    item: Action | Expectation,
    scenario: Scenario,
    checkpoints: AbstractSet[str],
    *,
    required: bool,
) -> Iterator[Problem]:
    keys = given(item)
    relative = keys & set(_MOMENTS) - {"time_s"}
    if "time_s" in keys and relative | (keys & {"delay_s"}):
        other = sorted(relative | (keys & {"delay_s"}))[0]
        yield Problem((*where, "time_s"), f"`time_s` and `{other}` exclude each other")
    if required and "time_s" not in keys and not relative:
        hint = "`time_s`, `when` or `after`"
        yield Problem(where, "this entry does not say when it happens", hint)
    if item.time_s is not None and item.time_s > (scenario.duration_s or item.time_s):
        text = f"{item.time_s:g} s is after the end of the run at {scenario.duration_s:g} s"
        yield Problem((*where, "time_s"), text)
    if item.after is not None and item.after not in checkpoints - {END}:
        yield _unknown((*where, "after"), item.after, checkpoints - {END})
    if item.when is not None:
        yield from _condition((*where, "when"), item.when)


def _exists(where: tuple[Step, ...], key: str, number: int | None) -> Iterator[Problem]:
    """Check that a parameter or flag exists: otherwise only the run would show it."""
    if number is None:
        return
    try:
        parameter(number) if key == "parameter" else flag(number)
    except MapError as error:
        yield Problem((*where, key), str(error))


def _unknown(where: tuple[Step, ...], name: str, known: AbstractSet[str]) -> Problem:
    return Problem(where, f"no checkpoint {name!r}", "known: " + ", ".join(sorted(known)))


def _condition(where: tuple[Step, ...], condition: Condition) -> Iterator[Problem]:
    keys = given(condition)
    subjects = keys & set(_CONDITIONS)
    if len(subjects) != 1:
        yield Problem(where, "a condition has exactly one of " + ", ".join(_CONDITIONS))
        return
    subject = subjects.pop()
    companions = {
        "bit": {"is", "becomes"},
        "parameter": {"above", "below"},
        "axis": {"above", "below"},
        "printed": set[str](),
        "program": {"state"},
    }[subject]
    for key in sorted(keys - companions - {subject}):
        yield Problem((*where, key), f"`{key}` does not belong to a condition on a {subject}")
    if subject in {"parameter", "axis", "program"} and not keys & companions:
        yield Problem(
            where, f"what of {subject}?", " or ".join(f"`{c}`" for c in sorted(companions))
        )
    yield from _exists(where, "parameter", condition.parameter)
    yield from _exists(where, "bit", condition.bit)
    if {"is", "becomes"} <= keys:
        yield Problem((*where, "becomes"), "`is` and `becomes` exclude each other")


def _action(where: tuple[Step, ...], action: Action) -> Iterator[Problem]:
    keys = given(action)
    if not keys & set(_DEEDS):
        yield Problem(where, "this entry does nothing", "one of " + ", ".join(_DEEDS))
    for key in ("set", "clear", "release", "press"):
        for bit in getattr(action, key):
            if not inputs.within(bit, inputs.RANGES):
                yield Problem((*where, key), f"bit {bit} is not an input", _INPUTS)
    if action.fault is not None:
        yield from _fault((*where, "fault"), action.fault)
    if action.every and action.when is None:
        hint = "it repeats an action each time the condition becomes true again"
        yield Problem((*where, "every"), "`every` needs `when`", hint)
    if action.every and action.checkpoint is not None:
        yield Problem((*where, "every"), "a checkpoint is one moment: `every` has more")
    if action.analog is not None and action.analog.input not in ANALOG_INPUTS:
        text = f"P{action.analog.input} is not an analog input"
        yield Problem(
            (*where, "analog"),
            text,
            "they are P6408 + 16 k of the card, P33288 + 512 n + 16 k of node n",
        )
    if {"send", "key"} <= keys:
        yield Problem((*where, "key"), "`send` and `key` exclude each other", "use two entries")
    if "stream" in keys and not keys & {"send", "key"}:
        yield Problem((*where, "stream"), "`stream` needs `send` or `key`")
    if action.stream is not None and action.stream not in STREAMS:
        hint = "one of " + ", ".join(STREAMS)
        yield Problem((*where, "stream"), f"no stream {action.stream!r}", hint)


def _fault(where: tuple[Step, ...], fault: Fault) -> Iterator[Problem]:
    """Each kind has its own quantity, or none."""
    wanted = QUANTITIES.get(fault.kind)
    for key in QUANTITIES.values():
        is_given = getattr(fault, key) is not None
        if is_given and key != wanted:
            yield Problem((*where, key), f"`{key}` does not belong to the fault {fault.kind}")
        if key == wanted and not is_given:
            yield Problem(where, f"the fault {fault.kind} needs `{key}`")


def _expectation(
    where: tuple[Step, ...], item: Expectation, checkpoints: AbstractSet[str]
) -> Iterator[Problem]:
    keys = given(item)
    subjects = keys & set(_SUBJECTS)
    if len(subjects) != 1:
        yield Problem(where, "an expectation has exactly one of " + ", ".join(_SUBJECTS))
        return
    subject = subjects.pop()
    for key in sorted(keys - _COMPANIONS[subject] - _ANY_SUBJECT - {subject}):
        hint = "allowed: " + ", ".join(sorted(_COMPANIONS[subject] | _ANY_SUBJECT))
        yield Problem((*where, key), f"`{key}` does not belong to an expected {subject}", hint)
    wanted = sorted(_COMPANIONS[subject] - {"tolerance"})
    if wanted and not keys & set(wanted):
        yield Problem(where, f"what is expected of the {subject}?", " or ".join(wanted))
    if subject == "flag" and item.is_ is not UNSET and not isinstance(item.is_, bool):
        yield Problem((*where, "is"), "a flag is true or false")
    if subject == "parameter" and isinstance(item.is_, bool):
        yield Problem((*where, "is"), "a parameter is a number")
    yield from _exists(where, "parameter", item.parameter)
    yield from _exists(where, "flag", item.flag)
    if item.between is not None:
        if keys & {"time_s", "when", "after"}:
            yield Problem((*where, "between"), "`between` has its own moments")
        for name in item.between:
            if name not in checkpoints:
                yield _unknown((*where, "between"), name, checkpoints)
