"""Inserted moves as lines of a part program."""

from openacr.cnc.canonical import AXES, Arc, Line, Plane, Point, Rapid

MARK = "<ins>"
AXIS_WORDS = "XYZ"
CENTRE_WORDS = "IJK"
INCH_DIGITS = 4
MM_DIGITS = 3
ORIGIN: Point = (0.0,) * AXES


def listing(
    move: Rapid | Line | Arc,
    plane: Plane,
    *,
    shift: Point = ORIGIN,
    scale: float = 1.0,
    is_metric: bool = False,
) -> str:
    """The line of an inserted move: `<ins> G3 X1.25 Y0 I1 J0`, everything absolute.

    `shift` leads from program to machine coordinates, `scale` from default to active unit.
    """
    digits = MM_DIGITS if is_metric else INCH_DIGITS

    def words(letters: str, values: dict[int, float]) -> list[str]:
        shown = {axis: (value - shift[axis]) * scale for axis, value in values.items()}
        return [letters[axis] + _short(shown[axis], digits) for axis in sorted(shown)]

    axes = (plane.first, plane.second)
    parts = [MARK, _code(move), *words(AXIS_WORDS, {axis: move.end[axis] for axis in axes})]
    if isinstance(move, Arc):
        parts += words(CENTRE_WORDS, dict(zip(axes, move.centre, strict=True)))
    return " ".join(parts)


def _code(move: Rapid | Line | Arc) -> str:
    if isinstance(move, Arc):
        return "G3" if move.sweep_rad > 0.0 else "G2"
    return "G0" if isinstance(move, Rapid) else "G1"


def _short(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
