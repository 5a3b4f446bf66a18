"""Reading, writing, groups of changes, rules between settings, units, news."""

from pathlib import Path
from threading import Thread

import pytest

from openacr.errors import MapError
from openacr.locks import FileLock
from openacr.mill.config.settings import Settings
from openacr.sysvar import SettingError, Store
from openacr.sysvar.driven import machine_lock
from openacr.sysvar.tabs import FOV, ROV, SOV, OverrideTab

PERSISTENT = [
    pytest.param((100, 150, 199), marks=pytest.mark.req("MILL-P-100-199")),
    pytest.param((200, 233), marks=pytest.mark.req("MILL-P-200-233")),
    pytest.param((234, 248), marks=pytest.mark.req("MILL-P-234-248")),
    pytest.param((249, 270), marks=pytest.mark.req("MILL-P-249-270")),
    pytest.param((271, 280, 399), marks=pytest.mark.req("MILL-P-271-399")),
    pytest.param((400, 799), marks=pytest.mark.req("MILL-P-400-799")),
    pytest.param((800, 832), marks=pytest.mark.req("MILL-P-800-832")),
    pytest.param((833, 899), marks=pytest.mark.req("MILL-P-833-899")),
    pytest.param((900, 999), marks=pytest.mark.req("MILL-P-900-999")),
    pytest.param((1001, 1400), marks=pytest.mark.req("MILL-P-1000-1400")),
    pytest.param((1401, 1499), marks=pytest.mark.req("MILL-P-1401-1499")),
    pytest.param((1501, 1900), marks=pytest.mark.req("MILL-P-1500-1900")),
    pytest.param((1901, 1997), marks=pytest.mark.req("MILL-P-1901-1997")),
    pytest.param((2001, 2999), marks=pytest.mark.req("MILL-P-2000-2999")),
    pytest.param((3001, 3999), marks=pytest.mark.req("MILL-P-3000-3999")),
    pytest.param((4002, 4095), marks=pytest.mark.req("MILL-P-4002-4095")),
]


@pytest.mark.req("MILL-P-PERSIST", "MILL-SYSVAR-NAMES")
@pytest.mark.parametrize("cells", PERSISTENT)
def test_a_value_survives_the_end_of_the_program(cells: tuple[int, ...], tmp_path: Path) -> None:
    path = tmp_path / "sysvar.db"
    with Store(path) as store:
        for n in cells:
            store.write(n, 1.0)
    with Store(path) as store:
        assert [store.read(n) for n in cells] == [1.0 for _ in cells]


@pytest.mark.req("MILL-MSG-PERSIST", "MILL-DIAG-IO-NAMES")
@pytest.mark.parametrize(
    ("n", "value"),
    [
        (1_000_007, "Coolant low"),
        (1_000_003, 12.0),
        (960_005, "Door"),
        (970_063, "Vacuum pump"),
        (283, -1.25),
        (317, 3.5),
        (912, 10.5),
        (987, -4.0),
    ],
)
def test_texts_and_numbers_of_the_machine_survive(
    n: int, value: float | str, tmp_path: Path
) -> None:
    path = tmp_path / "sysvar.db"
    with Store(path) as store:
        store.write_text(n, value) if isinstance(value, str) else store.write(n, value)
    with Store(path) as store:
        assert store.value(n) == value


@pytest.mark.req("MILL-MSG-COLOR")
def test_every_message_has_a_length_and_colours_of_its_own() -> None:
    store = Store()
    with store.transaction():
        for message in range(32):
            for k in (3, 4):
                store.write(1_000_000 + 107 * message + k, (message + k) % 16)
            store.write(1_000_000 + 107 * message + 5, 10 + message)
    for message in range(32):
        first = 1_000_000 + 107 * message
        assert store.parameter(first + 3).name == f"Message {message} text colour"
        found = [store.read(first + k) for k in (3, 4, 5)]
        assert found == [(message + 3) % 16, (message + 4) % 16, 10 + message]


def test_eight_work_systems_have_a_value_for_each_axis() -> None:
    store = Store()
    cells = [900 + 10 * system + axis for system in range(1, 9) for axis in range(8)]
    with store.transaction():
        for n in cells:
            store.write(n, n / 8)
    assert [store.read(n) for n in cells] == [n / 8 for n in cells]


@pytest.mark.parametrize("base", [150_000, 200_003, 300_003, 350_000])
def test_axes_have_values_of_their_own(base: int) -> None:
    store = Store()
    for axis in range(8):
        store.write(base + 1000 * axis, 0.5 + axis)
    assert [store.read(base + 1000 * axis) for axis in range(8)] == [0.5 + a for a in range(8)]


def test_cells_of_the_card_are_not_in_the_store() -> None:
    with pytest.raises(MapError, match="P5 is not in the store: it is a variable of the card"):
        Store().read(5)
    with pytest.raises(MapError, match="holds text"):
        Store().read(100_002)
    with pytest.raises(MapError, match="holds a number"):
        Store().read_text(100_001)


def test_a_group_is_stored_whole_or_not_at_all(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store, Store(tmp_path / "s.db") as other:
        store.write(2001, 1.0)
        with pytest.raises(RuntimeError), store.transaction():
            store.write(2001, 2.0)
            store.write(3001, 2.0)
            store.write_text(100_002, "ACR2000")
            assert store.read(2001) == 2.0
            assert other.read(2001) == 1.0
            raise RuntimeError
        for each in (store, other):
            assert (each.read(2001), each.read(3001)) == (1.0, 0.0)
            assert each.read_text(100_002) == "ACR8020"
        with store.transaction():
            store.write(2001, 3.0)
            with store.transaction():
                store.write(3001, 3.0)
            assert other.read(3001) == 0.0
        assert (other.read(2001), other.read(3001)) == (3.0, 3.0)


def test_a_cell_can_be_given_its_default_again(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store, Store(tmp_path / "s.db") as other:
        store.write(650_002, 30.0)
        assert other.read(650_002) == 30.0
        store.reset(650_002)
        for each in (store, other):
            assert (each.read(650_002), each.is_set(650_002)) == (10.0, False)


# --- rules between settings -------------------------------------------------------------


@pytest.mark.parametrize(
    ("base", "tab"),
    [
        pytest.param(450_000, "FOV", marks=pytest.mark.req("MILL-SYS-FOV-16", "MILL-SYS-FOV-MONO")),
        pytest.param(500_000, "ROV", marks=pytest.mark.req("MILL-SYS-ROV-16", "MILL-SYS-ROV-MONO")),
        pytest.param(550_000, "SOV", marks=pytest.mark.req("MILL-SYS-SOV-16", "MILL-SYS-SOV-MONO")),
    ],
)
def test_16_percentages_rise_from_click_to_click(base: int, tab: str) -> None:
    store = Store()
    assert [store.parameter(base + click).tab for click in range(16)] == [tab] * 16
    before = [store.read(base + click) for click in range(16)]
    assert before == sorted(before)
    with pytest.raises(SettingError, match="percentages must not fall from click to click"):
        store.write(base + 5, before[6] + 1)
    with pytest.raises(SettingError), store.transaction():
        for click in range(16):
            store.write(base + click, 160 - 10 * click)
    assert [store.read(base + click) for click in range(16)] == before
    with store.transaction():  # falling in between, rising when it is saved
        for click in range(16):
            store.write(base + click, 12 * click)
    assert store.read(base + 15) == 180


@pytest.mark.req("MILL-SYS-FOV-PERSIST", "MILL-SYS-ROV-PERSIST", "MILL-SYS-SOV-PERSIST")
@pytest.mark.parametrize(("base", "tab"), [(450_000, FOV), (500_000, ROV), (550_000, SOV)])
def test_override_tables_survive(base: int, tab: OverrideTab, tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store, store.transaction():
        for click in range(16):
            store.write(base + click, 7 * click)
    with Store(tmp_path / "s.db") as store:
        assert [store.read(base + click) for click in range(16)] == [7 * c for c in range(16)]
        assert Settings(store).table(tab) == tuple(7 * c for c in range(16))


def test_soft_limits_need_room_between_them_when_they_are_on() -> None:
    store = Store()
    with pytest.raises(SettingError, match=r"has to be above the -Soft Limit, 0"):
        store.write(201_002, 0)
    with store.transaction():
        store.write(201_002, 0)
        store.write(201_000, 12)
        store.write(201_001, -1)
    with pytest.raises(SettingError):
        store.write(201_000, -1)
    store.write(202_000, -5)  # off on this axis: anything goes


def test_the_second_angle_is_0_or_not_below_the_first() -> None:
    store = Store()
    store.write(250_011, 90)
    with pytest.raises(SettingError, match="at least Acute Angle1, 95"):
        store.write(250_010, 95)
    store.write(250_011, 0)
    store.write(250_010, 95)


def test_axis_names_are_letters_and_unique() -> None:
    store = Store()
    with pytest.raises(SettingError, match="P200008 already has that name"):
        store.write_text(202_008, "X")
    with pytest.raises(SettingError, match="one of X, Y, Z, A"):
        store.write_text(202_008, "W")
    with store.transaction():  # Z and A change places
        store.write_text(202_008, "A")
        store.write_text(203_008, "Z")
    assert store.read_text(203_008) == "Z"


def test_card_models_and_read_out_formats_are_checked() -> None:
    store = Store()
    with pytest.raises(SettingError, match="one of ACR1200, ACR1500"):
        store.write_text(100_002, "ACR1")
    store.write_text(100_002, "ACR1500")
    with pytest.raises(SettingError, match="one digit, a point, one digit"):
        store.write(850_000, 3.45)
    store.write(850_000, 3.6)


@pytest.mark.req("MILL-SYS-RUNLOCK")
@pytest.mark.parametrize("n", [200_006, 200_000, 350_002, 650_007, 300_003, 150_000, 250_001])
def test_settings_of_motion_do_not_change_while_a_program_runs(n: int) -> None:
    store = Store()
    store.write(200_002, 1)
    before = store.read(n)
    store.write(244, 1)
    with pytest.raises(SettingError, match=r": a program is running \(stop it first\)"):
        store.write(n, 1)
    assert store.read(n) == before
    store.write(2001, 1.5)  # offsets do
    store.write(250_114, 3)  # and colours
    store.write(244, 0)
    store.write(n, 1)
    assert store.read(n) == 1


def test_a_program_that_was_killed_bars_no_settings(tmp_path: Path) -> None:
    """It has left P244 at run; what counts is whether its lock is still held."""
    with Store(tmp_path / "s.db") as store:
        store.write(244, 1)
        lock = FileLock(machine_lock(tmp_path / "s.db"), "taken")
        with pytest.raises(SettingError, match="a program is running"):
            store.write(650_002, 20)
        lock.release()
        store.write(650_002, 20)
        assert (store.read(650_002), store.read(244)) == (20, 1)


def test_a_machine_that_is_driven_and_idle_takes_settings(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store:
        lock = FileLock(machine_lock(tmp_path / "s.db"), "taken")
        store.write(650_002, 20)
        lock.release()
        assert store.read(650_002) == 20


# --- units ------------------------------------------------------------------------------


def test_a_change_of_the_default_unit_converts_every_length_and_keeps_the_machine() -> None:
    store = Store()
    values = {2001: 1.5, 200_000: 12.0, 650_002: 20.0, 280: 0.5, 952_010: 0.1, 203_000: 360.0}
    plain = {150: 7.0, 200: 4.0, 101: 0.75, 150_000: 0.001, 250_010: 45.0}
    for n, value in {**values, **plain}.items():
        store.write(n, value)
    store.write(250_001, 1)
    for n in values:
        is_rotary = n == 203_000  # the soft limit of A is in degrees
        assert store.read(n) == (values[n] if is_rotary else pytest.approx(values[n] * 25.4))
    assert store.read(200_006) == pytest.approx(10_000 / 25.4)
    assert store.read(203_006) == 10_000
    assert {n: store.read(n) for n in plain} == plain
    store.write(250_001, 0)
    assert {n: store.read(n) for n in values} == values
    assert store.read(200_006) == 10_000


def test_a_new_metric_store_has_metric_defaults(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db", is_metric=True) as store:
        assert store.is_metric
        assert (store.read(250_005), store.read(200_006)) == (6.35, 10_000)
    with Store(tmp_path / "s.db") as store:
        assert store.is_metric


# --- news -------------------------------------------------------------------------------


def test_changes_since_a_token_are_listed(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store, Store(tmp_path / "s.db") as other:
        token = store.token
        other.write(150, 1.0)
        other.write_text(100_006, "A.LOG")
        changes = store.changes_since(token)
        assert changes.numbers == {150, 100_006}
        assert store.changes_since(changes.token) == (frozenset(), changes.token)
        store.write(151, 1.0)
        store.write(151, 1.0)  # no news
        assert other.changes_since(changes.token).numbers == {151}


def test_listeners_hear_of_own_changes_and_those_of_others(tmp_path: Path) -> None:
    heard: list[set[int]] = []
    with Store(tmp_path / "s.db") as store, Store(tmp_path / "s.db") as other:
        end = store.subscribe(lambda numbers: heard.append(set(numbers)))
        with store.transaction():
            store.write(150, 1.0)
            store.write(151, 1.0)
        other.write(152, 1.0)
        store.poll()
        with pytest.raises(SettingError), store.transaction():
            store.write(153, 1.0)
            store.write(650_000, -1.0)
        end()
        store.write(154, 1.0)
    assert heard == [{150, 151}, {152}]


def test_listeners_hear_of_others_even_where_an_own_change_comes_first(tmp_path: Path) -> None:
    heard: list[set[int]] = []
    with Store(tmp_path / "s.db") as store, Store(tmp_path / "s.db") as other:
        store.subscribe(lambda numbers: heard.append(set(numbers)))
        other.write(150, 1.0)
        with store.transaction():
            store.write(151, 1.0)
        other.write(152, 1.0)
        with pytest.raises(KeyError), store.transaction():
            store.write(153, 1.0)
            raise KeyError
    assert heard == [{150}, {151}, {152}]


def test_threads_share_a_store(tmp_path: Path) -> None:
    """A group of one thread is not mixed with that of another."""
    with Store(tmp_path / "s.db") as store:

        def count() -> None:
            for _ in range(100):
                with store.transaction(is_durable=False):
                    store.write(150, store.read(150) + 1)

        threads = [Thread(target=count) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert store.read(150) == 300


def test_a_listener_reads_the_new_values() -> None:
    store = Store()
    seen: list[float] = []
    store.subscribe(lambda numbers: seen.extend(store.read(n) for n in numbers))
    store.write(150, 4.5)
    assert seen == [4.5]
