import pytest

from openacr.units import quantity


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("90", "s", 90.0), ("10min", "s", 600.0), (" 2 h ", "s", 7200.0), ("250ms", "s", 0.25),
        ("1e3us", "s", 1e-3), (".5 s", "s", 0.5), ("-1", "s", -1.0), ("2sec", "s", 2.0),
        ("5cm", "mm", 50.0), ("1m", "mm", 1000.0), ("25.4mm", "in", 1.0), ("1inch", "mm", 25.4),
        ("2rev", "deg", 720.0), ("180deg", "rev", 0.5), ("500um", "mm", 0.5), ("3", "in", 3.0),
    ],
)  # fmt: skip
def test_a_quantity_is_read_in_the_unit_that_is_asked_for(
    text: str, unit: str, value: float
) -> None:
    assert quantity(text, unit) == pytest.approx(value, rel=1e-15)


def test_a_radian_is_an_angle() -> None:
    assert quantity("3.141592653589793rad", "deg") == pytest.approx(180.0)


@pytest.mark.parametrize("text", ["ten", "", "10 parsecs", "10mm", "1 2 s", "inf", "nan", "s"])
def test_what_is_no_time_is_refused_with_the_units_there_are(text: str) -> None:
    with pytest.raises(ValueError, match=r"a number, with or without a unit \(us, ms, s, sec, min"):
        quantity(text, "s")
