"""Drive Talk: opening a line, addresses, requests, what goes wrong, and how long it takes."""

import pytest
from tests.network.talk import (
    ADDRESS_ERROR,
    COM2,
    TIMEOUT,
    VELOCITY,
    Bench,
    control,
    talking,
)

from openacr.map import flag
from openacr.map.rows import motors
from openacr.map.tables.drivetalk import CONFIGURATION, STATUS_ITEMS
from openacr.plant.bus.aries import SETTINGS

AUTO, GET, SEND, ERRORL, DATA = range(5)
TPE, STATUS_1 = 9, 28


@pytest.mark.req("ACR-DTALK-01")
def test_open_takes_the_port_and_close_gives_it_back() -> None:
    bench = Bench(talking(0, address=1))
    assert bench.type("DTALK X") == "Device not open"
    bench.open(0)
    bench.request(0, GET)
    assert bench.card.p[28674] == 2
    assert bench.type("PROG1", 'OPEN "COM2:" AS #1') == "Device in use"
    assert bench.type("PROG0", "CLOSE #1", "DTALK X") == "Device not open"
    assert bench.type("PROG1", 'OPEN "COM2:" AS #1', "CLOSE #1") == ""
    bench.card.p[28674] = 0
    bench.request(0, GET)
    assert bench.card.p[28674] == 0, "no drive carries it any more"


@pytest.mark.req("ACR-DTALK-01")
def test_close_waits_for_what_is_under_way() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.card.bit[control(0, GET)] = True
    bench.type("CLOSE #1")
    assert bench.card.p[28674] == 0
    bench.card.advance(seconds=0.5)
    assert bench.card.p[28679] == 0 and bench.card.p[28678] == 1.5
    assert bench.type("DTALK X") == "Device not open"


@pytest.mark.req("ACR-DTALK-02")
def test_drives_of_another_type_are_not_understood() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.card.p[28673] = 1
    bench.request(0, GET)
    assert (bench.card.p[28674], bench.troubles()) == (0, [ADDRESS_ERROR])
    assert bench.type("DTALK X") == "Not supported"


@pytest.mark.req("ACR-DTALK-03")
def test_switching_the_drive_off_and_on_mends_the_wrong_choice() -> None:
    bench = Bench(talking(0, address=1, connected_s=0.2, powered_s=0.1, lost_s=1.0, back_s=2.0))
    bench.card.advance(seconds=2.5)
    bench.open(0)
    bench.request(0, GET)
    assert bench.troubles() == []


@pytest.mark.req("ACR-DTALK-07")
@pytest.mark.parametrize("axis", range(8))
@pytest.mark.parametrize("index", [AUTO, GET, SEND, ERRORL, DATA])
def test_requests_clear_themselves_with_a_drive_and_without(axis: int, index: int) -> None:
    bench = Bench(talking(axis, address=axis + 1))
    bench.open(axis)
    bench.card.bit[control(axis, TPE)] = True
    assert bench.request(axis, index) < 0.5
    assert bench.troubles() == []
    other = (axis + 1) % 8
    bench.open(other)
    bench.card.bit[control(other, TPE)] = True
    assert 1.0 <= bench.request(other, index) < 1.1
    assert bench.troubles() == [TIMEOUT]


@pytest.mark.req("ACR-DTALK-08")
def test_the_configuration_is_empty_until_it_is_uploaded() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    configuration = range(28674, 28674 + len(CONFIGURATION))
    assert [bench.card.p[number] for number in configuration] == [0.0] * 6
    bench.request(0, GET)
    assert [bench.card.p[number] for number in configuration] == [
        2.0,
        4000.0,
        4000.0,
        12.0,
        1.5,
        0.0,
    ]
    velocity = Bench(talking(0, address=1), motor=VELOCITY)
    velocity.open(0)
    velocity.request(0, GET)
    assert [velocity.card.p[n] for n in configuration] == [4.0, 4000.0, 4000.0, 8.0, 0.0, 10.0]


def test_card_and_drive_know_the_same_settings() -> None:
    assert [word for word, _ in CONFIGURATION] == [setting.word for setting in SETTINGS]


@pytest.mark.req("ACR-DTALK-09")
def test_a_downloaded_configuration_changes_the_drive_and_its_motor() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.request(0, GET)
    bench.card.p[28676], bench.card.p[28678] = 250.0, 3.0  # SMPER, DMTSCL
    bench.request(0, SEND)
    bench.card.p[28676] = bench.card.p[28678] = 0.0
    bench.request(0, GET)
    assert (bench.card.p[28676], bench.card.p[28678]) == (250.0, 3.0)
    assert bench.troubles() == []
    speeds = []
    for made in (bench, Bench(talking(0, address=1))):
        made.type("AXIS0 OFF")
        made.card.p[6400] = 1.0  # a volt at the drive
        made.card.advance(seconds=0.1)
        speeds.append(made.card.memory.F[motors.velocity_cps[0]])
    assert speeds[0] == pytest.approx(2 * speeds[1]) != 0.0


@pytest.mark.req("ACR-DTALK-10")
def test_selected_errors_are_logged_as_text_in_the_drive() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.type("PGAIN X0", "DTALK X")
    bench.say("SMPER100")
    bench.escape()
    push(bench)
    assert log(bench) == "*NO ERRORS", "nothing was selected"
    bench.card.bit[8960 + 1] = True
    bench.request(0, ERRORL)
    assert bench.card.bit[8961]
    push(bench)
    found = log(bench)
    assert found.startswith("*0:00:0") and found.endswith("POSITION ERROR")
    assert bench.type("DTALK X") == ""
    assert bench.say("ERRORL") == "*0100_0000_0000_0000_0000_0000_0000_0000"


def push(bench: Bench) -> None:
    """Push the axis out of its position error band and back."""
    bench.card.drag(0, 500.0)
    bench.card.advance(seconds=0.2)
    bench.card.drag(0, -500.0)
    bench.card.advance(seconds=0.2)


def log(bench: Bench) -> str:
    """The log of the first drive."""
    bench.type("DTALK X")
    said = bench.say("TERRLG", 0.4).removeprefix("TERRLG|")
    bench.escape()
    return said


def test_flags_of_the_error_log_end_with_the_sixteenth_axis() -> None:
    assert flag(8960).section == flag(9471).section == "Drive Talk Error-Log Flags"
    assert flag(9472).section != flag(9471).section


@pytest.mark.req("ACR-DTALK-11")
@pytest.mark.parametrize("index", range(8, 26))
def test_each_status_item_is_fetched_when_it_is_selected(index: int) -> None:
    bench = Bench(talking(0, address=1, drive_temp_c=41.5, motor_temp_c=52.0, bus_v=310.0), axes=1)
    bench.open(0)
    bench.card.drag(0, 33.0)
    bench.card.advance(seconds=1.2)
    items = [28692 + place for place in range(len(STATUS_ITEMS))]
    for number in items:
        bench.card.p[number] = -77
    bench.request(0, DATA)
    assert {bench.card.p[number] for number in items} == {-77}, "nothing is selected"
    bench.card.bit[control(0, index)] = True
    bench.request(0, DATA)
    changed = [number for number in items if bench.card.p[number] != -77]
    assert changed == [28692 + index - 8]
    assert bench.card.bit[control(0, index)], "the selection stays for the next time"


@pytest.mark.req("ACR-DTALK-11")
def test_status_items_tell_what_the_motor_does() -> None:
    bench = Bench(
        talking(0, address=1, drive_temp_c=41.5, motor_temp_c=52.0, bus_v=310.0),
        axes=1, motor=VELOCITY,
    )  # fmt: skip
    bench.open(0)
    bench.type("PPU X4000", "ACC 50 DEC 50 STP 50 VEL 5", "X1000")
    bench.card.advance(seconds=1.0)
    for index in range(8, 26):
        bench.card.bit[control(0, index)] = True
    bench.request(0, DATA)
    found = {word: bench.card.p[28692 + place] for place, (word, _) in enumerate(STATUS_ITEMS)}
    assert found["TVEL"] == pytest.approx(5.0, rel=0.01)
    assert found["TVELC"] == pytest.approx(10.0 * found["TANI"], rel=0.02)
    assert (found["TDTEMP"], found["TMTEMP"], found["TDBUS"]) == (41.5, 52.0, 310.0)
    assert (found["TDHRS"], found["TDMIN"], found["TDSEC"]) == (0, 0, 1)
    assert (found["TADDR"], found["DRIVE"], found["TDIMAX"]) == (1, 1, 8)


@pytest.mark.req("ACR-DTALK-11")
def test_positions_are_in_counts() -> None:
    bench = Bench(talking(0, address=1), axes=1)
    bench.open(0)
    bench.type("PGAIN X0", "AXIS0 RES 100")
    bench.card.drag(0, -33.0)
    for index in (8, 9, 10):
        bench.card.bit[control(0, index)] = True
    bench.request(0, DATA)
    assert [bench.card.p[28692 + place] for place in range(3)] == [100, 33, -33]


@pytest.mark.parametrize("axis", [0, 7])
def test_a_drive_tells_that_the_card_has_switched_it_off_and_on(axis: int) -> None:
    bench = Bench(talking(axis, address=axis + 1))
    bench.open(axis)
    bench.card.bit[control(axis, STATUS_1)] = True
    shown = []
    for word in ("ON", "OFF", "ON"):
        bench.type(f"DRIVE {word} AXIS{axis}")
        bench.card.advance(seconds=0.1)
        bench.request(axis, DATA)
        shown.append(bench.card.bit[9472 + 32 * axis])
    assert shown == [True, False, True]


@pytest.mark.req("ACR-DTALK-16")
def test_data_comes_slower_with_more_axes_and_faster_with_more_baud() -> None:
    took_s = {}
    for baud in (9600, 38400):
        for axes in (1, 2, 4):
            bench = Bench(*(talking(axis, address=axis + 1, baud=baud) for axis in range(4)))
            bench.open(*range(axes), device=f"COM2:{baud},N,8,1")
            for axis in range(axes):
                for index in range(8, 26):
                    bench.card.bit[control(axis, index)] = True
                bench.card.bit[control(axis, DATA)] = True
            begin = bench.card.tick
            for axis in range(axes):
                assert bench.card.until(control(axis, DATA), is_=False)
            took_s[baud, axes] = (bench.card.tick - begin) * bench.card.period_s
            assert bench.troubles() == []
    for baud in (9600, 38400):  # the slow scan, in which requests are noticed, is always there
        third_and_fourth_s = took_s[baud, 4] - took_s[baud, 2]
        assert third_and_fourth_s == pytest.approx(2 * (took_s[baud, 2] - took_s[baud, 1]), rel=0.1)
    assert took_s[9600, 4] > 2.5 * took_s[38400, 4]


@pytest.mark.req("ACR-DTALK-22")
def test_the_flag_of_the_stream_addresses_all_axes_of_its_device() -> None:
    drives = (talking(0), talking(1), talking(4), talking(7, port="COM1"), talking(5))
    bench = Bench(*drives)
    bench.open(0, 1, 4)
    bench.open(7, device="COM1:", number=2)
    bench.card.bit[COM2] = True
    assert bench.card.until(COM2, is_=False, timeout_s=2.0)
    assert [bench.address(axis) for axis in range(8)] == [1, 2, 0, 0, 5, 0, 0, 0]
    bench.card.bit[11072] = True
    assert bench.card.until(11072, is_=False, timeout_s=2.0)
    assert bench.address(7) == 8
    assert not any(bench.card.bit[control(axis, AUTO)] for axis in range(8))


@pytest.mark.req("ACR-DTALK-22")
@pytest.mark.parametrize("axis", [0, 1, 4])
def test_the_flag_of_an_axis_addresses_its_drive_alone(axis: int) -> None:
    bench = Bench(*(talking(one) for one in (0, 1, 4)))
    bench.open(0, 1, 4)
    bench.card.bit[10496 + 32 * axis] = True
    assert bench.card.until(10496 + 32 * axis, is_=False, timeout_s=2.0)
    wanted = {one: one + 1 if one == axis else 0 for one in (0, 1, 4)}
    assert {one: bench.address(one) for one in (0, 1, 4)} == wanted


def test_the_stream_flag_of_a_closed_port_clears_at_once() -> None:
    bench = Bench(talking(0))
    bench.card.bit[COM2] = True
    assert bench.card.until(COM2, is_=False, timeout_s=0.1)
    assert bench.address(0) == 0


@pytest.mark.parametrize("device", ["COM2:19200,N,8,1", "COM2:9600,E,8,1", "COM2:9600,N,7,1"])
def test_line_and_drive_have_to_agree_about_the_characters(device: str) -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0, device=device)
    bench.request(0, GET)
    assert bench.troubles() == [TIMEOUT]


def test_what_the_line_was_opened_with_may_be_left_out() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0, device="COM2:")
    bench.request(0, GET)
    assert bench.troubles() == []


def test_a_snapshot_in_the_middle_of_an_exchange_goes_on() -> None:
    bench = Bench(talking(0, address=1))
    bench.open(0)
    bench.card.bit[control(0, GET)] = True
    bench.card.advance(seconds=0.06)
    snapshot, digests = bench.card.snapshot(), []
    for _ in range(2):
        bench.card.restore(snapshot)
        bench.card.advance(seconds=1.0)
        digests.append(bench.card.digest())
        assert bench.card.p[28678] == 1.5
    assert digests[0] == digests[1]


def test_drives_keep_addresses_and_settings_when_the_card_restarts() -> None:
    bench = Bench(talking(0))
    bench.open(0)
    bench.request(0, AUTO)
    bench.type("REBOOT", "ECHO 4", "PROG0")
    assert bench.address(0) == 1
    bench.open(0)
    bench.request(0, GET)
    assert (bench.card.p[28674], bench.troubles()) == (2, [])
