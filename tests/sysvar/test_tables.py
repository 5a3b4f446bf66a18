"""Numbers, defaults and ranges of the system parameters, as the guide gives them."""

import pytest

from openacr.sysvar import CellKind, Store, parameter
from openacr.sysvar.lookup import parameters
from openacr.sysvar.values import checked

# number: default, unit; of axis 0 where the tab is per axis
DEFAULTS: dict[int, tuple[float | str, str]] = {
    100_000: (1, ""),
    100_001: (3, ""),
    100_002: ("ACR8020", ""),
    100_006: ("MILL.LOG", ""),
    100_012: (17, ""),
    100_015: (54, ""),
    100_016: (64, ""),
    100_017: (98, ""),
    100_018: (-1, ""),
    150_000: (0.00244, "V/pulse"),
    150_001: (0, "V/s/pulse"),
    150_002: (0, "s"),
    150_003: (0, "V"),
    150_004: (0, "V/(pulse/s)"),
    150_005: (0, "s"),
    150_006: (0, "V/(pulse/s2)"),
    150_007: (0, "V/(pulse/s)"),
    150_008: (10, "V"),
    200_000: (0, "u"),
    200_001: (0, "u"),
    200_002: (1, ""),
    200_003: (0, "u"),
    200_004: (0, "u"),
    200_005: (0, ""),
    200_006: (10_000, "pulse/u"),
    200_007: (0, ""),
    200_008: ("X", ""),
    200_009: (-1, ""),
    200_010: (0.005, "u per click"),
    200_011: (4, ""),
    250_001: (0, ""),
    250_002: (1, ""),
    250_003: (2, ""),
    250_004: (2, ""),
    250_005: (0.25, "u"),
    250_006: (0, ""),
    250_007: (24, "u"),
    250_008: (24, "u"),
    250_009: (24, "u"),
    250_010: (0, "deg"),
    250_011: (0, "deg"),
    250_012: (0, "u"),
    250_013: (0, ""),
    250_101: (0.002, "u"),
    250_102: (0.01, "rad"),
    250_103: (-4, ""),
    250_111: (90, ""),
    250_112: (-1, ""),
    250_113: (0, "deg"),
    250_114: (10, ""),
    250_115: (0, ""),
    250_116: (40, ""),
    250_117: (10, ""),
    250_118: (1, ""),
    250_119: ("MILL", ""),
    250_120: (0.1, "u"),
    250_121: (-0.5, "u"),
    250_122: (0.1, "u"),
    250_123: (10, "u/m"),
    250_124: (0, ""),
    250_130: (1, ""),
    250_131: (0, ""),
    250_140: (0.02, "u"),
    250_141: (0.05, "u"),
    250_142: (0, ""),
    251_000: (0, ""),
    252_999: (0, ""),
    300_000: (0, ""),
    300_001: (0, "u"),
    300_002: (16, ""),
    300_003: (10, "u/m"),
    300_004: (5, "u/m"),
    300_005: (2, "u/m"),
    300_006: (100, "u/s2"),
    300_007: (100, "u/s2"),
    300_008: (100, "u/s2"),
    300_009: (1, ""),
    350_000: (10, "u/m"),
    350_001: (100, "u/m"),
    350_002: (150, "u/s2"),
    350_003: (10, "u/s2"),
    350_004: (100, "u/s2"),
    350_005: (0, ""),
    350_006: (1, "u"),
    350_007: (0.1, "u"),
    350_008: (0.01, "u"),
    350_009: (0.001, "u"),
    350_010: (0.0001, "u"),
    **{400_000 + k: (-1, "") for k in (*range(7), 10, 11, 12, 13, 19, *range(101, 114))},
    450_010: (100, "%"),
    450_017: (10, ""),
    500_015: (100, "%"),
    500_017: (15, ""),
    550_010: (100, "%"),
    550_017: (10, ""),
    600_000: (-1, ""),
    600_001: (0, ""),
    600_005: (1, "s"),
    650_000: (200, "u/m"),
    650_001: (100, "u/m"),
    650_002: (10, "u/m"),
    650_003: (40, "u/m"),
    650_004: (0, "u/s"),
    650_005: (0, "%"),
    650_006: (0, "u/m"),
    650_007: (100, "u/s2"),
    650_008: (100, "u/s2"),
    650_014: (5, "s"),
    650_016: (0.0001, "u"),
    700_000: (0, ""),
    700_005: (-1, ""),
    700_001: (1, ""),
    700_002: (0, ""),
    750_001: (9600, ""),
    750_002: (8, ""),
    750_004: (1, ""),
    750_005: (1, ""),
    800_000: (0, ""),
    800_001: (0, "V/rpm"),
    **{800_000 + k: (-1, "") for k in (2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13)},
    800_007: (0, ""),
    800_015: (30, "s"),
    850_000: (3.4, ""),
    850_001: (4.5, ""),
    850_030: (20, ""),
    900_000: (-1, ""),
    900_001: (-1, ""),
    900_002: (1, ""),
    900_010: ("mcodes", ""),
    901_017: (1, ""),
    950_000: (0, "u"),
    952_010: (0, "u"),
    952_997: (0, "u"),
    1_003_424: (0, ""),
}


@pytest.mark.parametrize("n", DEFAULTS)
def test_a_default_and_its_unit(n: int) -> None:
    value, unit = DEFAULTS[n]
    found = parameter(n)
    assert found is not None
    assert (Store().value(n), found.row.unit) == (value, unit)


def test_per_axis_tabs_repeat_every_1000() -> None:
    for base in (150_000, 200_000, 300_000, 350_000):
        names = {parameter(base + 1000 * axis + 1).name for axis in range(8)}  # type: ignore[union-attr]
        axes = [parameter(base + 1000 * axis + 1).axis for axis in range(8)]  # type: ignore[union-attr]
        assert len(names) == 1
        assert axes == list(range(8))


def test_the_axes_are_called_x_y_z_a_b_c_u_v() -> None:
    store = Store()
    assert "".join(store.read_text(200_008 + 1000 * axis) for axis in range(8)) == "XYZABCUV"


def test_every_default_is_in_its_own_range() -> None:
    for is_metric in (False, True):
        store = Store(is_metric=is_metric)
        for found in parameters():
            default, letter = store.value(found.number), store.letter_of(found)
            assert checked(found, default, is_metric, letter) == default, found


def test_lengths_of_a_metric_store_start_25_4_times_as_large() -> None:
    inch, metric = Store(), Store(is_metric=True)
    for found in parameters():
        here, there = inch.value(found.number), metric.value(found.number)
        is_linear = found.axis not in (3, 4, 5)  # A, B and C turn
        if found.is_length and is_linear and isinstance(here, float):
            assert there == pytest.approx(here * 25.4, rel=1e-12), found
        elif found.number != 250_001:
            assert there == here, found


def test_the_metric_epsilon_has_no_noise_in_its_digits() -> None:
    assert Store(is_metric=True).read(250_101) == 0.0508


def test_every_parameter_explains_itself() -> None:
    for found in parameters():
        assert found.name
        assert found.row.doc.endswith("."), found
        if found.kind is CellKind.CHOICE:
            assert len(found.row.words) >= 2


@pytest.mark.req("MILL-OFS-H-999")
@pytest.mark.parametrize(
    ("base", "count", "name"),
    [
        (1000, 400, "D radius"),
        (1500, 400, "D wear"),
        (2000, 999, "H length"),
        (3000, 999, "H wear"),
    ],
)
def test_offset_n_lies_n_after_its_base(base: int, count: int, name: str) -> None:
    store = Store()
    with store.transaction():
        for n in range(1, count + 1):
            store.write(base + n, n / 1000)
    for n in range(1, count + 1):
        found = parameter(base + n)
        assert found is not None
        assert (found.name, store.read(base + n)) == (f"{name} {n}", n / 1000)
    assert store.read(base) == 0.0


@pytest.mark.req("MILL-SYS-TOOL-COLORS")
def test_each_tool_has_one_of_16_colours() -> None:
    store = Store()
    assert [store.read(901_000 + tool) for tool in (0, 5, 15, 16, 999)] == [0, 5, 15, 0, 7]
    for colour in range(16):
        store.write(901_005, colour)
        assert store.read(901_005) == colour
    with pytest.raises(Exception, match="from 0 to 15"):
        store.write(901_005, 16)


def test_reference_point_1_is_the_home_preset_until_it_is_edited() -> None:
    store = Store()
    store.write(301_001, 2.5)
    assert store.read(281) == 2.5
    assert store.read(291) == 0.0
    store.write(281, 0.0)
    assert store.read(281) == 0.0


def test_messages_are_counted() -> None:
    store = Store()
    assert store.read(1_003_424) == 0
    store.write(1_000_000 + 107 * 31, 1)
    assert store.read(1_003_424) == 1
