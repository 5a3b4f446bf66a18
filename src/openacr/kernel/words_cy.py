"""32-bit words as the card keeps them: wrapping, rounding and single bits."""

from openacr.cmath import fabs, rint

__all__ = ["round32", "wrap32"]


def wrap32(value: int) -> int:
    """The low 32 bits of `value` as a signed number."""
    return ((value + 2147483648) & 4294967295) - 2147483648


def round32(value: float) -> int:
    """`value` rounded to the nearest integer (halves to even), wrapped to 32 bits.

    Beyond +-2**62, and for NaN, where a C conversion would be undefined, the result is 0.
    """
    if not fabs(value) < 4.611686018427388e18:
        return 0
    return wrap32(int(rint(value)))
