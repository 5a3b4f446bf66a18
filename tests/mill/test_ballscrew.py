"""Ballscrew tables: files, measurements, and compensation on the virtual machine."""

from pathlib import Path

import pytest
from tests.mill.shop import Shop, at, end, line

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.card.ballscrew import Table, install, measured, parse, read
from openacr.mill.config.settings import Settings
from openacr.mill.session import MillSession
from openacr.sysvar import Store

PSP, SSP, PER_AXIS = 12294, 12295, 256
GUIDE = "X0E.00325\nX1E.00175\nX2E-.00250\n"


def test_positions_below_0_and_more_digits_than_five_are_written_as_they_are() -> None:
    assert parse("A-90E1\nA90E-.123456\n", "A").text() == "A-90E1.00000\nA90E-.123456\n"


# The table of Appendix A as it is printed, with the position of its last row, which the guide
# prints as 40: the mean it gives and the entry X39E.00250 are those of 41.
PRINTED = """\
Primary Setpoint Actual 1 Actual 2 Actual 3 Actual 4 Actual Mean Actual Difference
(N) (n1) (n2) (n3) (n4) (n1+n2+n3+n4)/\u03a3n (N\u2212ActualMean)

0 0 0 0 0 0 0
1 0.979 1.000 0.997 0.999 0.99375 0.00625
2 1.996 1.998 1.995 1.998 1.99675 0.00325
3 2.997 3.000 2.997 2.999 2.99825 0.00175
4 4.004 4.001 4.004 4.001 4.00250 \u22120.00250
"""


@pytest.mark.parametrize("separator", [" ", ",", ";", "\t"])
def test_results_after_the_measurements_need_no_headline(tmp_path: Path, separator: str) -> None:
    rows = PRINTED.splitlines()[3:]
    file = tmp_path / "x.txt"
    file.write_text("\n".join(row.replace(" ", separator) for row in rows))
    assert measured(file, "X", 2.0).text() == GUIDE + "X3E.00000\nX4E.00625\n"
    file.write_text("0 0 0 0\n1 1.0 1.0 1.1\n")  # four measurements in all, no results
    assert measured(file, "X", 0.0).entries[1] == (1.0, -0.033333333)


def test_a_position_may_have_its_measurements_in_several_lines(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    file.write_text("0, 0\n1, .979\n2, 1.996\n1, 1.000\n1, .997\n2, 1.998\n1, .999\n")
    assert measured(file, "X", 0.0).entries == ((0.0, 0.0), (1.0, 0.00625), (2.0, 0.003))


@pytest.mark.parametrize(
    ("text", "home", "said"),
    [
        ("0 0\n1 x\n", 0, "m.csv:2: a position and at least one measurement"),
        ("0 0\n1\n", 0, "m.csv:2: a position and at least one measurement"),
        ("0 0\n0 1\n", 0, "1 position; a table needs 2"),
        ("Mean\n0 0 0 0\n1 1.002 1.002 0\n", 0, "m.csv:3: the last two columns are not the mean"),
        ("Mean\n0 0 0 0\n1 1.002 1.003 -.003\n", 0, "m.csv:3: the last two columns are not"),
        ("Difference\n0 0 0\n1 1 0\n", 0, "m.csv:2: the last two columns are not the mean"),
        ("0 0\n1 1\n", 7, "home 7 is not between 0 and 1"),
        ("# nothing\n", 0, "0 positions; a table needs 2"),
    ],
)
def test_measurements_that_make_no_table(tmp_path: Path, text: str, home: float, said: str) -> None:
    file = tmp_path / "m.csv"
    file.write_text(text)
    with pytest.raises(UserError, match=said):
        measured(file, "X", home)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "BIN").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match="it is not text"):
        read(tmp_path / "BIN", "X")
    with pytest.raises(UserError, match="no such file"):
        read(tmp_path / "NONE", "X")
    with pytest.raises(UserError, match="is a directory"):
        read(tmp_path, "X")


# on the card


KILL_X = 8467


def equipped(tables: dict[int, Table], **cells: float) -> Shop:
    """A machine whose axes are homed, with tables."""
    shop = Shop(P271=255, **cells)
    install(shop.card, Settings(shop.store), tables)
    return shop


def compensation(shop: Shop, axis: int = 0) -> float:
    """Secondary minus primary setpoint."""
    return float(
        shop.controller.p[SSP + PER_AXIS * axis] - shop.controller.p[PSP + PER_AXIS * axis]
    )


def test_soft_limits_say_which_entries_lie_beyond_the_reference_point() -> None:
    table = parse(GUIDE + "X3E.00000\nX4E.00625\n", "X")
    assert [p for p, _ in table.along((2.0, -2.0))] == [-2, -1, 0, 1, 2]
    assert [p for p, _ in table.along((4.0, 0.0))] == [0, 1, 2, 3, 4]
    assert [p for p, _ in table.along(None)] == [*range(-5, 5)]
    negative = parse("X-1E.1\nX0E0\nX1E.1\n", "X")
    assert negative.along(None) == negative.entries
    shop = equipped({0: table}, P200000=4.0, P200001=-0.5, P200002=0)
    shop.finish(line(1, at(-0.4)), end())
    shop.pass_time(0.2)
    assert compensation(shop) == pytest.approx(32.5, abs=1.0)  # held before the first entry


def test_uneven_spacing_and_a_home_preset() -> None:
    table = parse("X0E0\nX1E.01\nX2E.02\nX4E.04\nX4.5E0\n", "X")
    shop = equipped({0: table}, P300001=1.0, P200000=10.0, P200001=-1.0, P200002=0)
    for place, expected in ((1.0, 0), (2.5, 150), (4.0, 300), (5.25, 200)):
        shop.finish(line(1, at(place)), end())
        shop.pass_time(0.2)
        assert compensation(shop) == pytest.approx(expected, abs=1.0)


def test_a_table_waits_for_the_reference_point_and_goes_with_its_switch() -> None:
    shop = Shop()
    table = {0: parse(GUIDE, "X")}
    install(shop.card, Settings(shop.store), table)
    assert shop.card.command("BSC X", program=0) == ["OFF"]
    shop.store.write(271, 1)
    install(shop.card, Settings(shop.store), table)
    assert shop.card.command("BSC X", program=0) == ["ON"]
    shop.pass_time(0.1)
    assert compensation(shop) == pytest.approx(32.5, abs=1.0)
    install(shop.card, Settings(shop.store), {})
    shop.pass_time(0.1)
    assert compensation(shop) == 0


def test_a_table_acts_again_when_a_kill_is_taken_back(tmp_path: Path) -> None:
    (tmp_path / "X.BSC").write_text(GUIDE)
    with Store(tmp_path / "sysvar.db") as store:
        store.write_text(950_020, "X.BSC")
        store.write(950_010, 1)
        store.write(200_007, 0)
        controller = Controller()
        shop = MillSession.real(controller, store, lambda _text: None)
        shop.runner.settings.mark_homed(0, homed=True)
        controller.bit[KILL_X] = True
        for _ in range(5):
            shop.step()
        assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [14]
        assert shop.card.command("BSC X", program=0) == ["OFF"]
        assert shop.runner.acknowledge() == []
        assert shop.card.command("BSC X", program=0) == ["ON"]


def test_a_card_that_lost_its_position_gets_its_table_only_after_homing(tmp_path: Path) -> None:
    (tmp_path / "X.BSC").write_text(GUIDE)
    with Store(tmp_path / "sysvar.db") as store:
        store.write_text(950_020, "X.BSC")
        store.write(950_010, 1)
        store.write(271, 7)  # homed, says the store; the card has just been switched on
        shop = MillSession.real(Controller(), store, lambda _text: None)
        assert shop.card.command("BSC X", program=0) == ["OFF"]
        assert store.read(271) == 0
