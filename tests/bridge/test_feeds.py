"""Feeds: the machine of a panel, and a card over its own protocol, lost and back again."""

from concurrent.futures import Future

import pytest
from tests.io.served import serving
from tests.panel.bench import Served
from tests.panel.bus_in_memory import BusInMemory
from tests.proxy import Proxy
from tests.waiting import LIMIT_S, until

from openacr.bridge.card_feed import CardFeed
from openacr.bridge.feed import STALE_S, Feed
from openacr.bridge.items import items_of, read_all
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import AxisName
from openacr.bridge.rows import Value
from openacr.bridge.settings import Length, OnCard
from openacr.bridge.station_feed import TOOLS_S, StationFeed
from openacr.client import Card, RefusedError
from openacr.errors import OpenacrError
from openacr.sysvar.tabs import AXIS, CELLS, CONTROL

FILE = parse_bridge(
    '[[value]]\nname = "gain"\nparameter = "axis0.proportional gain"\n'
    '[[value]]\nname = "lamp"\nflag = 130\n[prometheus]\n'
)
NUMBERS = [each.parameter_number for each in FILE.value]
GAIN, LAMP_WORD = NUMBERS
LAMP = 130


def values(feed: Feed) -> dict[str, Value]:
    items = items_of(feed.axes, FILE.value)
    return dict(zip((i.name for i in items), read_all(items, feed.newest()), strict=True))


def result(done: "Future[None]", panel: Served) -> None:
    panel.step(0.01)
    done.result(LIMIT_S)


# --- the machine of a panel -----------------------------------------------------------


def test_a_panel_gives_its_snapshot_its_facts_and_chosen_values(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    assert feed.axes == (AxisName("X"), AxisName("Y"), AxisName("Z"))
    feed.start(NUMBERS, 10.0)

    def is_loaded() -> bool:  # the sample is read in a thread of its own
        quiet_panel.step(0.3)
        return bool(values(feed)["program"])

    until(is_loaded)
    found = values(feed)
    assert (found["available"], found["execution"], found["mode"]) == (True, "READY", "AUTOMATIC")
    assert (found["program"], found["line"], found["feed_override"]) == ("plate.nc", 0, 100.0)
    snapshot = quiet_panel.station.snapshot
    assert found["X.actual"] == snapshot.actual[0]
    assert found["user.gain"] == pytest.approx(0.0024414, rel=1e-3)
    assert found["user.lamp"] is False


def test_the_bus_of_a_panel_is_that_of_its_card(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    assert feed.newest().bus is None
    quiet_panel.station.installation.bus = bus = BusInMemory()
    found = feed.newest().bus
    assert found is not None
    assert found["counters"]["sent"] == bus.rig.machine.cycles
    bus.is_known = False
    assert feed.newest().bus is None


def test_a_machine_that_is_set_up_again_has_its_new_axes_and_units(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    store = quiet_panel.station.installation.store
    assert (len(feed.axes), feed.newest().mm_per_unit) == (3, 1.0)
    store.write(AXIS.configured[1], 0.0)
    with store.transaction():
        store.write_text(AXIS.name[2], "C")
        store.write_text(AXIS.name[5], "Z")
    store.write(CONTROL.default_units, 0.0)
    assert (len(feed.axes), feed.newest().mm_per_unit) == (3, 1.0)  # those of the session
    quiet_panel.call(lambda station: station.renew(station.now_s))
    assert feed.axes == (AxisName("X"), AxisName("C", is_rotary=True))
    assert feed.newest().mm_per_unit == 25.4
    quiet_panel.call(lambda station: station.close())
    assert feed.axes == (AxisName("X"), AxisName("C", is_rotary=True))


def test_a_chosen_value_follows_and_is_written_by_the_rules_of_the_client(
    quiet_panel: Served,
) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    feed.start(NUMBERS, 10.0)
    result(feed.write(LAMP, 1.0, is_flag=True), quiet_panel)
    result(feed.write(GAIN, 0.5, is_flag=False), quiet_panel)
    quiet_panel.step(0.5)
    found = values(feed)
    assert (found["user.lamp"], found["user.gain"]) == (True, 0.5)
    result(feed.write(LAMP, 0.0, is_flag=True), quiet_panel)
    quiet_panel.step(0.5)
    assert values(feed)["user.lamp"] is False
    with pytest.raises(OpenacrError):
        result(feed.write(99999, 1.0, is_flag=False), quiet_panel)


def test_the_tool_table_is_read_again_a_second_later(quiet_panel: Served) -> None:
    control = quiet_panel.panel.control
    clock_s = quiet_panel.station.snapshot.read_s
    control._clock = lambda: clock_s
    feed = StationFeed(control)
    store = quiet_panel.station.installation.store
    store.write(CELLS.h_length[7], 30.0)
    assert feed.newest().tools is None
    quiet_panel.step(0.01)
    assert [tool.number for tool in feed.newest().tools or ()] == [7]
    store.write(CELLS.d_radius[2], 4.0)
    clock_s += TOOLS_S - 0.1
    feed.newest()
    quiet_panel.step(0.01)
    assert [tool.number for tool in feed.newest().tools or ()] == [7]
    clock_s += 0.1
    feed.newest()
    quiet_panel.step(0.01)
    assert [tool.number for tool in feed.newest().tools or ()] == [2, 7]


def test_a_bridge_that_has_ended_watches_nothing(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    feed.start(NUMBERS, 10.0)
    quiet_panel.step(0.3)
    feed.stop()
    result(feed.write(GAIN, 0.25, is_flag=False), quiet_panel)
    quiet_panel.step(0.5)
    assert values(feed)["user.gain"] != 0.25


def test_a_browser_is_not_sent_what_a_bridge_watches(quiet_panel: Served) -> None:
    sent: list[object] = []
    feed = StationFeed(quiet_panel.panel.control)
    quiet_panel.station.watches.report = lambda *words: sent.append(words)
    feed.start(NUMBERS, 10.0)
    quiet_panel.step(0.3)
    assert sent == []
    assert values(feed)["user.gain"] is not None


def test_a_reading_that_is_too_old_counts_as_lost(quiet_panel: Served) -> None:
    control = quiet_panel.panel.control
    feed = StationFeed(control)
    quiet_panel.step(0.1)
    read_s = quiet_panel.station.snapshot.read_s
    control._clock = lambda: read_s + STALE_S
    assert values(feed)["available"] is True
    control._clock = lambda: read_s + STALE_S + 0.1
    assert feed.newest().lost == "the last reading is 2.1 s old"
    assert values(feed)["line"] is None


def test_a_machine_that_is_lost_says_why(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    quiet_panel.step(0.1)
    quiet_panel.call(lambda station: station.lose("the card does not answer", 1e9))
    assert feed.newest().lost == "the card does not answer"


# --- a card ---------------------------------------------------------------------------


def test_a_card_gives_positions_in_millimetres_speed_and_chosen_values(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("openacr.bridge.card_feed.SILENCE_S", LIMIT_S)
    with serving() as served, Card.open(f"127.0.0.1:{served.ascii_port}") as card:
        card.command("ATTACH MASTER0", program=0)
        card.command('ATTACH SLAVE0 AXIS0 "X"', program=0)
        card.command("PPU X1000", program=0)
        card.command("ACC10000 DEC10000 STP10000 VEL1000 F60000", program=0)
        card.command("X2.5", program=0)
        feed = CardFeed(f"127.0.0.1:{served.ascii_port}", OnCard(axes=("X", "A"), unit=Length.INCH))
        assert feed.axes == (AxisName("X"), AxisName("A", is_rotary=True))
        feed.start(NUMBERS, 50.0)
        try:
            until(lambda: values(feed)["X.actual"] == 63.5)
            found = values(feed)
            assert (found["available"], found["moving"], found["path_speed"]) == (True, False, 0.0)
            assert (found["X.commanded"], found["A.actual"]) == (63.5, 0.0)
            assert (found["execution"], found["program"], found["alarms"]) == (None, None, None)
            feed.write(LAMP, 1.0, is_flag=True).result(LIMIT_S)
            assert card.bit[LAMP]
            until(lambda: values(feed)["user.lamp"] is True)
            feed.write(GAIN, 0.5, is_flag=False).result(LIMIT_S)
            until(lambda: values(feed)["user.gain"] == 0.5)
            with pytest.raises(RefusedError):
                feed.write(99999, 1.0, is_flag=False).result(LIMIT_S)
            until(lambda: values(feed)["available"] is True)
        finally:
            feed.stop()


def test_a_card_that_is_cut_off_is_lost_and_found_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("openacr.bridge.card_feed.RETRY_S", 0.1)
    with serving() as served, Proxy(f"127.0.0.1:{served.ascii_port}") as line:
        feed = CardFeed(line.address, OnCard())
        feed.start([], 50.0)
        try:
            until(lambda: values(feed)["available"] is True)
            line.cut()
            until(lambda: values(feed)["available"] is False)
            assert values(feed)["X.actual"] is None
            line.mend()
            until(lambda: values(feed)["X.actual"] == 0.0)
        finally:
            feed.stop()


def test_a_card_that_was_never_there_is_said_and_what_is_written_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("openacr.bridge.card_feed.RETRY_S", 0.1)
    feed = CardFeed("127.0.0.1:1", OnCard())
    feed.start([], 10.0)
    try:
        until(lambda: "refused" in feed.newest().lost)
        with pytest.raises(OpenacrError, match=r"127\.0\.0\.1:1"):
            feed.write(GAIN, 1.0, is_flag=False).result(LIMIT_S)
    finally:
        feed.stop()


def test_a_thousand_values_wait_to_be_written_and_no_more() -> None:
    feed = CardFeed("127.0.0.1:1", OnCard())
    waiting = [feed.write(GAIN, float(k), is_flag=False) for k in range(1001)]
    with pytest.raises(OpenacrError, match="too many values wait to be written"):
        waiting.pop().result(0)
    assert not any(each.done() for each in waiting)
    feed.stop()
    with pytest.raises(OpenacrError, match="the bridge ends"):
        waiting[-1].result(0)


def test_a_card_that_acromill_has_not_set_up_has_no_values(quiet_panel: Served) -> None:
    feed = StationFeed(quiet_panel.panel.control)
    quiet_panel.step(0.1)
    assert values(feed)["available"] is True
    quiet_panel.station.hand_over("PROG0 is an ordinary program of the card now")
    quiet_panel.step(0.1)
    assert feed.newest().lost == "PROG0 is an ordinary program of the card now"
    assert values(feed)["line"] is None
