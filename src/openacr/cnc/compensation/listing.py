"""Inserted moves as lines of a part program."""

from openacr.cnc.canonical import Plane
from openacr.cnc.elements import Element

MARK = "<ins>"
AXIS_WORDS = "XYZ"
CENTRE_WORDS = "IJK"
INCH_DIGITS = 4
MM_DIGITS = 3


def listing(element: Element, *, is_metric: bool = False, axis_words: str = AXIS_WORDS) -> str:
    """The line of an inserted move: `<ins> G3 X1.25 Y0 I1 J0`, everything absolute."""
    digits = MM_DIGITS if is_metric else INCH_DIGITS
    plane = element.plane
    numbers = {plane.first: element.end[plane.first], plane.second: element.end[plane.second]}
    words = [axis_words[axis] + _short(numbers[axis], digits) for axis in sorted(numbers)]
    if element.centre is not None:
        words += _centre(plane, element.centre, digits)
    return " ".join([MARK, _code(element), *words])


def _code(element: Element) -> str:
    if element.centre is not None:
        return "G3" if element.sweep_rad > 0.0 else "G2"
    return "G0" if element.pace is None else "G1"


def _centre(plane: Plane, centre: tuple[float, float], digits: int) -> list[str]:
    numbers = dict(zip((plane.first, plane.second), centre, strict=True))
    return [CENTRE_WORDS[axis] + _short(numbers[axis], digits) for axis in sorted(numbers)]


def _short(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
