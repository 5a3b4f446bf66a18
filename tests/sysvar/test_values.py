"""What cells accept, how users write values, and what is refused with which words."""

import pytest

from openacr.errors import MapError
from openacr.sysvar import SettingError, Store, find
from openacr.sysvar.lookup import one
from openacr.sysvar.values import checked, parsed, shown, unit_of


@pytest.mark.req("MILL-SYS-RANGE")
@pytest.mark.parametrize(
    ("n", "value", "words"),
    [
        (
            650_000,
            -5,
            "P650000 Max Machine Speed cannot be -5: a number above 0 up to 1000000 [in/min]",
        ),
        (650_000, float("nan"), "Max Machine Speed cannot be nan"),
        (650_000, float("inf"), "Max Machine Speed cannot be inf"),
        (100_001, 9, "P100001 Axis count cannot be 9: a whole number from 2 to 8"),
        (100_001, 2.5, "Axis count cannot be 2.5"),
        (201_006, 0, "P201006 Pulses/Unit (axis 1) cannot be 0: a number other than 0 [pulse/in]"),
        (203_006, 0, "Pulses/Unit (axis 3) cannot be 0: a number other than 0 [pulse/deg]"),
        (200_004, -1, "ExcessErr Band (axis 0) cannot be -1: a number from 0 up [in]"),
        (250_101, 0, "Epsilon for Compensation cannot be 0: a number above 0 [in]"),
        (250_120, float("nan"), "DXF Safe Height cannot be nan: any number [in]"),
        (240, 0.5, "Spindle state cannot be 0.5: any whole number"),
        (200_011, 3, "one of -4, -2, -1, 1, 2, 4"),
        (250_001, 2, "one of 0 (inch), 1 (mm)"),
        (250_103, 1, "Root Epsilon cannot be 1: a whole number from -12 to 0"),
        (800_000, 32, "Spindle Code cannot be 32"),
        (400_004, -2, "a whole number from -1 to 511; -1 = disable"),
        (100_000, 2, "it is read-only"),
        (1000, 1, "D radius 0 cannot be 1"),
        (200_008, 1.0, "text is expected"),
    ],
)
def test_a_value_out_of_range_is_refused_with_the_name_and_the_range(
    n: int, value: float, words: str
) -> None:
    store = Store()
    before = store.value(n)
    with pytest.raises(SettingError) as refusal:
        store.write(n, value)
    assert words in str(refusal.value)
    assert refusal.value.parameter.number == n
    assert store.value(n) == before
    assert not store.is_set(n)


@pytest.mark.req("MILL-SYS-RANGE")
def test_words_in_a_number_are_refused() -> None:
    with pytest.raises(SettingError, match=r"P650002 Cut Speed cannot be 'fast': a number above 0"):
        parsed(one("cut speed"), "fast")


def test_ranges_of_lengths_follow_the_unit() -> None:
    store = Store(is_metric=True)
    store.write(650_000, 2e7)  # mm/min: more than the number would allow in inches
    assert store.read(650_000) == 2e7
    with pytest.raises(SettingError, match=r"be 3e\+07: .* above 0 up to 25400000 \[mm/min\]"):
        store.write(650_000, 3e7)
    with pytest.raises(SettingError, match=r"'fast': .* above 0 up to 25400000 \[mm/min\]"):
        parsed(one("P650000"), "fast", is_metric=True)


def test_ranges_of_rotary_axes_are_those_of_degrees() -> None:
    store = Store(is_metric=True)
    store.write(350_000, 2e7)
    with pytest.raises(SettingError, match=r"\(axis 3\) .* up to 1000000 \[deg/min\]"):
        store.write(353_000, 2e7)
    with pytest.raises(SettingError, match=r"\(axis 3\) cannot be '5mm'"):
        parsed(one("P353000"), "5mm", letter="A")


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("dac polarity x", "NEG", 1.0),
        ("default units", "mm", 1.0),
        ("block skip", "disable", -1.0),
        ("spindle dac", "none", -1.0),
        ("default graphics", "off", 0.0),
        ("home reqd y", "yes", 1.0),
        ("epsilon for compensation", "0.0254 mm", 0.001),
        ("epsilon for compensation", ".003in", 0.003),
        ("cut speed", "254mm", 10.0),
        ("cut speed", " 12.5 ", 12.5),
        ("pulses/unit x", "100mm", 2540.0),
        ("machine type", "MILL 2", "MILL 2"),
        ("handwheel src x", "Axis4", 4.0),
        ("handwheel src x", " axis10 ", 10.0),
        ("handwheel src x", "4", 4.0),
        ("handwheel src x", "None", -1.0),
    ],
)
def test_users_write_words_and_units(name: str, text: str, value: float | str) -> None:
    assert parsed(one(name), text) == value


@pytest.mark.parametrize("text", ["Axis", "Axis-1", "Axis4.5", "Axis 4", "DAC4", "Axis\u00b2"])
def test_other_words_are_no_source_of_a_handwheel(text: str) -> None:
    with pytest.raises(SettingError, match=r"from -1 to 23; -1 = None; Axis4 = 4"):
        parsed(one("handwheel src x"), text)


def test_the_dacs_of_a_spindle_are_those_the_guide_prints() -> None:
    assert checked(one("spindle dac"), 7.0) == 7.0
    assert checked(one("handwheel src x"), parsed(one("handwheel src x"), "Axis23")) == 23.0
    for name, value, words in (
        ("spindle dac", 8.0, r"cannot be 8: a whole number from -1 to 7; -1 = none"),
        ("handwheel src x", 24.0, r"cannot be 24: a whole number from -1 to 23"),
    ):
        with pytest.raises(SettingError, match=words):
            checked(one(name), value)


def test_lengths_are_converted_into_a_metric_store() -> None:
    assert parsed(one("epsilon for compensation"), "0.001 in", is_metric=True) == 0.0254
    assert parsed(one("epsilon for compensation"), "0.03 mm", is_metric=True) == 0.03


def test_values_are_shown_with_their_words_and_units() -> None:
    assert shown(one("P250003"), 2.0) == "2 (absolute)"
    assert shown(one("P250101"), 0.002) == "0.002"
    assert shown(one("P200011"), 4.0) == "4"
    assert shown(one("P200009"), 4.0) == "4 (Axis4)"
    assert shown(one("P200009"), -1.0) == "-1 (None)"
    assert unit_of(one("P650000"), is_metric=True) == "mm/min"
    assert unit_of(one("P203000"), is_metric=True, letter="A") == "deg"
    assert unit_of(one("P200006"), is_metric=False) == "pulse/in"


def test_parameters_are_found_by_number_name_axis_and_tab() -> None:
    assert [found.number for found in find("P650000")] == [650_000]
    assert [found.number for found in find("650000")] == [650_000]
    assert one("MAX machine speed").number == 650_000
    assert one("jog feedrate axis 2").number == 352_000
    assert one("jog feedrate u").number == 356_000
    assert one("+soft limit y").number == 201_000
    assert one("h length 12").number == 2012
    assert one("fov click 3").number == 450_003
    assert one("fixture 99 x").number == 952_990
    assert len(find("servo")) == 80
    assert {found.tab for found in find("servo y")} == {"SERVO"}
    assert len(find("servo y")) == 10
    assert len(find("jog feedrate")) == 8
    assert [found.number for found in find("cells cycle code")] == [249]  # not the return code


def test_an_unclear_name_lists_what_it_can_mean() -> None:
    with pytest.raises(MapError, match=r"'jog feedrate' can be P350000 .* and 3 more"):
        one("jog feedrate")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("flux capacitor", "no parameter of the store is named 'flux capacitor'"),
        ("P5", "variable of the card"),
        ("P4096", "parameter of the card"),
        ("P250015", "P250015 is not in the store"),
        ("9" * 5000, "no parameter of the store is named '999"),
    ],
)
def test_unknown_names_and_numbers_are_refused(text: str, words: str) -> None:
    with pytest.raises(MapError, match=words):
        find(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("cut sped", "no parameter of the store is named 'cut sped': did you mean 'Cut Speed'?"),
        ("cutspeed", "no parameter of the store is named 'cutspeed': did you mean 'Cut Speed'?"),
        ("SPEDS", "no parameter of the store is named 'SPEDS': did you mean 'SPEEDS'?"),
        ("jog fedrate", "no parameter of the store is named 'jog fedrate': "
         "did you mean 'Jog Feedrate'?"),
        ("flux capacitor", "no parameter of the store is named 'flux capacitor'"),
        ("P650900", "P650900 is not in the store (the nearest: P650018 and P700000)"),
        ("P24000", "P24000 is not in the store (the nearest: P4095 and P100000)"),
        ("P999999999", "P999999999 is not in the store (the nearest: P1003424)"),
    ],
)  # fmt: skip
def test_a_misspelt_name_or_number_names_what_is_near(text: str, message: str) -> None:
    with pytest.raises(MapError) as caught:
        find(text)
    assert str(caught.value) == message
