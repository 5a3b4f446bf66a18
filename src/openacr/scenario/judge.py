"""Judge one expectation: compare the expected with the actual value."""

from collections.abc import Mapping, Sequence

from msgspec import UNSET, Struct

from openacr.scenario.schema import Condition, Expectation
from openacr.scenario.world import World


class Verdict(Struct, frozen=True):
    """The result of one expectation."""

    name: str
    ok: bool
    expected: str
    actual: str
    time_s: float | None = None

    def __str__(self) -> str:
        at = "" if self.time_s is None else f" at {self.time_s:.4f} s"
        name = f"{self.name}: " if self.name else ""
        return f"{name}expected {self.expected}, found {self.actual}{at}"


def judge(
    item: Expectation,
    world: World,
    printed: str,
    checkpoints: Mapping[str, int],
    period_s: float,
) -> Verdict:
    """Compare one expectation with the card as it is now."""
    if item.between is not None:
        ok, actual = _duration(item, checkpoints, period_s)
    elif item.printed is not None:
        ok, actual = _printed(_texts(item), printed)
    elif item.program is not None:
        state = world.program_state(item.program)
        ok, actual = state is item.state, state.value
    elif item.flag is not None:
        value = world.bit(item.flag)
        ok, actual = value is item.is_, _on_off(value)
    elif item.axis is not None:
        ok, actual = _position(item, item.axis, world)
    else:
        ok, actual = _parameter(item, world.read(item.parameter or 0))
    return Verdict(item.name, ok, expected_text(item), actual, world.tick * period_s)


def never(item: Expectation, moment: str) -> Verdict:
    """Fail an expectation whose moment did not occur."""
    return Verdict(item.name, False, f"{expected_text(item)} {moment}", "that this never came")


def expected_text(item: Expectation) -> str:
    """Say in words what is expected."""
    if item.between is not None:
        first, second = item.between
        return f"{_within(item.duration_s or 0.0, item.tolerance)} s from {first} to {second}"
    if item.printed is not None:
        return "printed " + " then ".join(repr(text) for text in _texts(item))
    if item.program is not None:
        return f"PROG{item.program} {item.state.value if item.state else ''}"
    if item.flag is not None:
        return f"BIT{item.flag} {_on_off(item.is_ is True)}"
    subject = f"P{item.parameter}" if item.axis is None else f"axis {item.axis}"
    bounds = [f"{word} {_within(wanted, item.tolerance)}" for word, wanted in _wanted(item)]
    bounds += [
        f"{w} {b:g}" for w, b in (("above", item.above), ("below", item.below)) if b is not None
    ]
    return f"{subject} " + " and ".join(bounds)


def _wanted(item: Expectation) -> list[tuple[str, float]]:
    is_ = None if item.is_ is UNSET else float(item.is_)
    words = (("at", is_), ("position", item.position), ("commanded", item.commanded))
    return [(word, value) for word, value in words if value is not None]


def _texts(item: Expectation) -> tuple[str, ...]:
    return (item.printed,) if isinstance(item.printed, str) else item.printed or ()


def condition_text(condition: Condition) -> str:
    """Say a condition in words."""
    if condition.bit is not None:
        wanted = condition.is_ if condition.becomes is None else condition.becomes
        verb = "is" if condition.becomes is None else "becomes"
        return f"BIT{condition.bit} {verb} {_on_off(wanted is not False)}"
    if condition.printed is not None:
        return f"{condition.printed!r} is printed"
    if condition.program is not None:
        return f"PROG{condition.program} is {condition.state.value if condition.state else ''}"
    subject = f"P{condition.parameter}" if condition.axis is None else f"axis {condition.axis}"
    bounds = (("above", condition.above), ("below", condition.below))
    return f"{subject} is " + " and ".join(f"{w} {b:g}" for w, b in bounds if b is not None)


def _on_off(value: bool) -> str:
    return "set" if value else "clear"


def _within(value: float, tolerance: float) -> str:
    return f"{value:.10g} ± {tolerance:g}" if tolerance else f"{value:.10g}"


def _parameter(item: Expectation, value: float) -> tuple[bool, str]:
    ok = all(abs(value - wanted) <= item.tolerance for _, wanted in _wanted(item))
    ok = ok and (item.above is None or value > item.above)
    return ok and (item.below is None or value < item.below), f"{value:.10g}"


def _position(item: Expectation, axis: int, world: World) -> tuple[bool, str]:
    found = {"position": world.position_u(axis), "commanded": world.commanded_u(axis)}
    wanted = _wanted(item)
    ok = all(abs(found[word] - value) <= item.tolerance for word, value in wanted)
    return ok, " and ".join(f"{found[word]:.10g}" for word, _ in wanted)


def _printed(texts: Sequence[str], printed: str) -> tuple[bool, str]:
    """Search for the texts in order; report where the search ended."""
    at = 0
    for text in texts:
        found = printed.find(text, at)
        if found < 0:
            rest = printed[at:][-120:]
            return False, f"no {text!r} in {rest!r}" if rest else "nothing printed"
        at = found + len(text)
    return True, "printed"


def _duration(
    item: Expectation, checkpoints: Mapping[str, int], period_s: float
) -> tuple[bool, str]:
    """Compare the time between two checkpoints; the tick is the finest step of time."""
    first, second = item.between or ("", "")
    missing = [name for name in (first, second) if name not in checkpoints]
    if missing:
        return False, f"that {missing[0]} was not reached"
    actual_s = (checkpoints[second] - checkpoints[first]) * period_s
    ok = abs(actual_s - (item.duration_s or 0.0)) <= item.tolerance + period_s / 2
    return ok, f"{actual_s:.6g} s"
