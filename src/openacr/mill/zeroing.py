"""Floating zero: set at the present position, cleared, moved to (SET, CLR and GOTO ZERO).

The shift is that of G92 (P800 to P832); it applies to every work system and is kept in the store.
"""

from collections.abc import Callable, Iterable, Iterator

from openacr.cnc.canonical import TOOL_AXIS, Point
from openacr.cnc.codes.gcodes.work import clear_zero, preset_zero
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load_blank
from openacr.errors import UserError
from openacr.mill.config.folders import folders_of
from openacr.mill.session import MillSession

MDI_DIALECT = "acromill"


def reader(shop: MillSession) -> Interpreter:
    """An interpreter at the position of the machine, in the initial state of MDI."""
    program = load_blank(shop.cells, MDI_DIALECT, folders_of(shop.cells, None), name="ZERO")
    return Interpreter(program, shop.cells, shop.runner.stream.host, MDI_DIALECT)


def set_zero(shop: MillSession, axes: Iterable[int]) -> Point:
    """Set the floating zero of axes to their position (SET ZERO); returns the program position."""
    return preset(shop, dict.fromkeys(axes, 0.0))


def preset(shop: MillSession, values: dict[int, float]) -> Point:
    """Set the floating zero so that axes read these values, in default units; as `set_zero`."""
    _require_rest(shop)
    run = reader(shop)
    with shop.cells.transaction():
        preset_zero(run, values)
    return run.position


def clear_all(shop: MillSession) -> Point:
    """Clear the floating zero of all axes (CLR ZERO); returns the program position."""
    _require_rest(shop)
    run = reader(shop)
    with shop.cells.transaction():
        clear_zero(run)
    return run.position


def goto_zero(
    shop: MillSession, axes: Iterable[int], attend: Callable[[MillSession], None]
) -> Iterator[Point]:
    """Move axes to program 0 by rapids (GOTO ZERO); yields the program position after each.

    The tool axis goes first where that is upward, else last; the others go together.
    """
    for _ in shop.run_blocks(goto_blocks(shop, axes), MDI_DIALECT, attend):
        yield reader(shop).position


def goto_blocks(shop: MillSession, axes: Iterable[int]) -> list[str]:
    """The blocks that move axes to program 0, one after the other."""
    names = {axis: shop.runner.settings.axis(axis).name for axis in sorted(set(axes))}
    others = "".join(f" {name}0" for axis, name in names.items() if axis != TOOL_AXIS)
    blocks = [f"G90 G0{others}"] if others else []
    if TOOL_AXIS in names:
        is_upward = reader(shop).position[TOOL_AXIS] < 0.0
        blocks.insert(0 if is_upward else len(blocks), f"G90 G0 {names[TOOL_AXIS]}0")
    return blocks


def _require_rest(shop: MillSession) -> None:
    """Refuse a zero while the machine moves or an alarm is active."""
    shop.runner.alarms.require_none()
    if shop.runner.is_busy or shop.machine.poll().is_moving or shop.machine.is_jogging():
        raise UserError("the machine is moving: a zero can be set only at rest")
