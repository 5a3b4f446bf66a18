"""The numbers of a new machine, each computed once from what was chosen.

Distances are multiples of a revolution of the motor, so that every unit gives the same machine.
An axis goes from 0, where homing ends, to its travel; an axis that works downwards goes from 0
at the top to minus its travel. Positions are those of the machine, in units.
"""

from collections.abc import Iterator
from math import ceil
from typing import Any

from openacr.configure.answers import Gains
from openacr.configure.setup_code import FLAGS_PER_AXIS
from openacr.starter.choices import (
    INPUTS_PER_AXIS,
    MODEL,
    UNITS,
    Choices,
    Homing,
    Kind,
    Limits,
    Unit,
)

COUNTS_PER_LINE, LINES = 4, 2000
TOOL_OUTPUT, LAMP_OUTPUT = 32, 33
MOVES = 200  # that the CNC side wants to buffer (mill/card/setup.py)
STATIONS = 6  # of a turntable
ENABLE_S, TOOL_S = 0.2, 0.2

# In revolutions of a motor, per second and per second squared.
VELOCITY, ACCELERATION = 20.0, 200.0
SEARCH, APPROACH, SEEK, FEED = 8.0, 1.0, 2.0, 4.0
EXCESS_ERROR, TOLERANCE = 1.0, 0.01
SOFT_MARGIN, SWITCH_MARGIN, STOP_MARGIN = 0.25, 1.5, 2.5  # beyond the travel
EDGE_BEFORE_MARKER, SEEK_MOST = 0.5, 1.05

# Flags of axis 0, of the others in steps of 32.
NOT_EXCESS_ERROR, KILL_REQUEST, HOME_FOUND, HOME_FAILED = 769, 8467, 16134, 16135
HOME_BACKUP, HOME_NEGATIVE_EDGE, HOME_NEGATIVE_FINAL = 16152, 16153, 16154
IN_MOTION = 516


def facts_of(name: str, chosen: Choices) -> dict[str, Any]:
    """Every value that the templates name."""
    turn = UNITS[chosen.unit].per_rev_u
    axes = list(_axes(chosen, turn))
    plane, tool_axes = (axes[:-1], axes[-1:]) if _has_tool_axis(chosen) else (axes, [])
    return {
        **_of_choices(name, chosen),
        **_speeds(turn),
        "axes": axes,
        "plane": plane,
        "tool_axes": tool_axes,
        "homing_order": axes[::-1],
        "names": " ".join(chosen.axes),
        "search_accelerations": _for_each(axes, ACCELERATION * turn),
        "search_speeds": _for_each(axes, SEARCH * turn),
        "approach_speeds": _for_each(axes, APPROACH * turn),
        "quoted_names": ", ".join(f'"{each}"' for each in chosen.axes),
        "there": _targets(plane, 0.8),
        "near": _targets(plane, 0.2),
        "back": _targets(plane, 0.0),
        "down": _targets(tool_axes, 0.5),
        "up": _targets(tool_axes, 0.0),
        **_contour(axes),
        **_of_part_programs(chosen, turn),
        "stations": [
            {"station": number, "to": _targets(axes, number / STATIONS)}
            for number in range(1, STATIONS + 1)
        ],
        "duration_s": _duration_s(chosen, turn),
    }


def _of_choices(name: str, chosen: Choices) -> dict[str, Any]:
    inputs = [
        {"input": chosen.first_free_input + place, "input_name": each}
        for place, each in enumerate(chosen.inputs)
    ]
    is_homed = chosen.homing is not Homing.NONE
    has_soft = chosen.limits in (Limits.SOFT, Limits.BOTH)
    return {
        "name_of_project": name,
        "title": chosen.row.title,
        "work_summary": ("homes, then " if is_homed else "") + chosen.row.work,
        **{f"is_{kind}": kind is chosen.kind for kind in type(chosen.kind)},
        "model": MODEL.name,
        "unit": str(chosen.unit),
        "unit_title": UNITS[chosen.unit].title,
        "is_homed": is_homed,
        "seeks_marker": chosen.homing is Homing.MARKER,
        "has_switches": chosen.limits in (Limits.SWITCHES, Limits.BOTH),
        "has_soft": has_soft,
        "has_soft_after_homing": has_soft and is_homed,
        "has_stops": _has_stops(chosen),
        "has_plc": chosen.has_plc,
        "plcs": int(chosen.has_plc),
        "moves": MOVES if cuts_parts(chosen) else 0,
        "has_tool": bool(chosen.row.tool),
        "tool": chosen.row.tool,
        "has_tool_axis": _has_tool_axis(chosen),
        "tool_output": TOOL_OUTPUT,
        "lamp_output": LAMP_OUTPUT,
        "cuts_parts": cuts_parts(chosen),
        "has_inputs": bool(inputs),
        "start": inputs[:1],
        "conditions": inputs[1:],
        "has_conditions": len(inputs) > 1,
        "inputs": inputs,
        "in_motion": IN_MOTION,
        "enable_s": ENABLE_S,
        "tool_s": TOOL_S,
    }


def cuts_parts(chosen: Choices) -> bool:
    """Whether the CNC side can use the machine: a mill with X, Y and Z, homed to markers."""
    return (
        chosen.kind is Kind.MILL
        and chosen.axes == ("X", "Y", "Z")
        and chosen.unit in (Unit.MM, Unit.INCH)
        and chosen.homing is Homing.MARKER
    )


def _has_tool_axis(chosen: Choices) -> bool:
    return chosen.row.has_tool_axis and len(chosen.axes) > 2


def _has_stops(chosen: Choices) -> bool:
    """A turntable without limits turns for ever; everything else ends somewhere."""
    return chosen.limits is not Limits.NONE or chosen.kind != "turntable"


def _speeds(turn: float) -> dict[str, str]:
    speeds = {
        "velocity": VELOCITY, "acceleration": ACCELERATION, "search": SEARCH,
        "approach": APPROACH, "seek": SEEK, "excess_error": EXCESS_ERROR, "tolerance": TOLERANCE,
        "units_per_rev": 1.0,
    }  # fmt: skip
    return {name: _number(value * turn) for name, value in speeds.items()} | {
        "counts_per_rev": str(COUNTS_PER_LINE * LINES),
        "lines": str(LINES),
    }


def _axes(chosen: Choices, turn: float) -> Iterator[dict[str, Any]]:
    for number, name in enumerate(chosen.axes):
        is_downwards = _has_tool_axis(chosen) and number == len(chosen.axes) - 1
        yield _axis(chosen, turn, number, name, -1 if is_downwards else 1)


def _axis(chosen: Choices, turn: float, number: int, name: str, sign: int) -> dict[str, Any]:
    """One axis; `sign` is the direction from its zero into its travel."""
    end = sign * chosen.travel_u
    low, high = sorted((0.0, end))
    edge = -EDGE_BEFORE_MARKER * turn if chosen.homing is Homing.MARKER else 0.0
    home = sorted((sign * edge, -sign * STOP_MARGIN * turn))
    shift = FLAGS_PER_AXIS * number
    return {
        "number": number,
        "name": name,
        "end": end,
        "initial": _number(0.0 if chosen.homing is Homing.NONE else 0.5 * end),
        "stop_low": _number(low - STOP_MARGIN * turn),
        "stop_high": _number(high + STOP_MARGIN * turn),
        "switch_low": _number(low - SWITCH_MARGIN * turn),
        "switch_high": _number(high + SWITCH_MARGIN * turn),
        "soft_low": _number(low - SOFT_MARGIN * turn),
        "soft_high": _number(high + SOFT_MARGIN * turn),
        "soft_is_off": "false" if chosen.limits in (Limits.SOFT, Limits.BOTH) else "true",
        "home_negative": int(sign > 0),
        "home_priority": 2 if sign > 0 else 1,
        "home_low": _number(home[0]),
        "home_high": _number(home[1]),
        "positive_input": INPUTS_PER_AXIS * number,
        "negative_input": INPUTS_PER_AXIS * number + 1,
        "home_input": INPUTS_PER_AXIS * number + 2,
        "home_direction": -sign,
        "home_side": "positive" if sign > 0 else "negative",
        "home_edge_command": "CLR" if sign > 0 else "SET",
        "seek_by": _number(sign * SEEK_MOST * turn),
        "no_excess_error": NOT_EXCESS_ERROR + shift,
        "kill_request": KILL_REQUEST + shift,
        "home_found": HOME_FOUND + shift,
        "home_failed": HOME_FAILED + shift,
        "home_backup": HOME_BACKUP + shift,
        "home_negative_edge": HOME_NEGATIVE_EDGE + shift,
        "home_negative_final": HOME_NEGATIVE_FINAL + shift,
        "is_first": number == 0,
    }


def _targets(axes: list[dict[str, Any]], part: float) -> str:
    """The words of a move to a part of the travel of each axis."""
    return " ".join(f"{axis['name']}{_number(part * axis['end'])}" for axis in axes)


def _for_each(axes: list[dict[str, Any]], value: float) -> str:
    """The same value for every axis, as a command takes it."""
    return " ".join(f"{axis['name']}{_number(value)}" for axis in axes)


def _contour(axes: list[dict[str, Any]]) -> dict[str, str]:
    """A plate of a mill: three straight sides and a round one, in its first two axes."""
    if len(axes) < 2:
        return {}
    (first, x), (second, y) = ((axis["name"], axis["end"]) for axis in axes[:2])
    low, high, middle = 0.25, 0.5, 0.375
    return {
        "corner": f"{first}{_number(low * x)} {second}{_number(low * y)}",
        "right": f"{first}{_number(high * x)}",
        "arc": f"{first}({_number(high * x)},{_number(high * x)})"
        f" {second}({_number(high * y)},{_number(middle * y)})",
        "left": f"{first}{_number(low * x)}",
        "close": f"{second}{_number(low * y)}",
        "arc_end": f"{first}{_number(high * x)} {second}{_number(high * y)}",
        "arc_centre": f"I0 J{_number((middle - low) * y)}",
    }


def _of_part_programs(chosen: Choices, turn: float) -> dict[str, str]:
    """What the CNC side counts otherwise: speeds per minute, resolution per unit."""
    gains = Gains()
    is_metric = chosen.unit is Unit.MM
    return {
        "store_unit": "mm" if is_metric else "inch",
        "unit_word": "G21" if is_metric else "G20",
        "unit_code": "21" if is_metric else "20",
        "pgain": _number(gains.pgain),
        "dgain": _number(gains.dgain),
        "pulses_per_unit": _number(COUNTS_PER_LINE * LINES / turn),
        "in_position": _number(TOLERANCE * turn),
        "search_min": _number(60.0 * SEARCH * turn),
        "approach_min": _number(60.0 * APPROACH * turn),
        "velocity_min": _number(60.0 * VELOCITY * turn),
        "feed_min": _number(60.0 * FEED * turn),
    }


def _duration_s(chosen: Choices, turn: float) -> int:
    """Longer than homing and one cycle take."""
    travel = chosen.travel_u / turn
    homing = len(chosen.axes) * (0.5 * travel / SEARCH + 4.0)
    cycle = 2.0 * STATIONS * (travel / VELOCITY + 1.0)
    return ceil((homing if chosen.homing is not Homing.NONE else 0.0) + cycle)


def _number(value: float) -> str:
    return f"{value:.9g}" if value else "0"
