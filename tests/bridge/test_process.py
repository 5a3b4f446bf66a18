"""The process of a bridge: fed, heard, killed, hung, and gone with its panel."""

import asyncio
import io
import logging
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import httpx
import pytest
from tests.bridge.bench import RUNNING, VALUES, GivenFeed, show_line
from tests.bridge.mqtt import Metric, RunningBroker, Subscriber, named, node_file
from tests.panel.bench import Served
from tests.waiting import LIMIT_S, until
from tests.workers.orphans import left_by

from openacr.bridge import child, life, messages
from openacr.bridge.child import Pipe
from openacr.bridge.feed import STALE_S, Feed
from openacr.bridge.life import Life, apart
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import AxisName, Moment
from openacr.bridge.pipe_feed import PipeFeed
from openacr.bridge.process import BridgeProcess
from openacr.cli.panel import _bridge
from openacr.errors import OpenacrError, UserError

# The library of the broker leaves sockets and streams to the collector.
METRICS = 'name = "mill"\nrate_hz = 50\n[prometheus]\nport = 0\n' + VALUES


@contextmanager
def running(text: str, feed: Feed, said: list[str]) -> Iterator[BridgeProcess]:
    bridge = BridgeProcess(parse_bridge(text), Path(), feed, said.append)
    bridge.start()
    try:
        yield bridge
    finally:
        bridge.stop()


def scraped(bridge: BridgeProcess) -> str:
    """The metrics; nothing while their process starts again."""
    try:
        return httpx.get(bridge.places[0].split(" ", 1)[1], timeout=LIMIT_S).text
    except httpx.TransportError:
        return ""


def lines_of(host: Subscriber) -> list[int]:
    """The executed lines that were published: the birth may come before the first values."""
    births = [named(each)["line"] for each in host.of("NBIRTH")]
    return births + [metric.long_value for data in host.of("NDATA") for metric in data.metrics]


def pids(caplog: pytest.LogCaptureFixture) -> list[int]:
    """The processes that were started."""
    found = (re.fullmatch(r"the bridge runs as process (\d+)", each) for each in caplog.messages)
    return [int(match[1]) for match in found if match is not None]


def test_values_go_to_the_process_and_its_writes_come_back_with_what_refuses_them(
    caplog: pytest.LogCaptureFixture, broker: RunningBroker, host: Subscriber
) -> None:
    caplog.set_level(logging.INFO)
    feed = GivenFeed()
    with running(node_file(broker.port), feed, []) as bridge:
        assert bridge.places == [f"sparkplug mqtt://127.0.0.1:{broker.port}"]
        assert "bridge" not in [thread.name for thread in threading.enumerate()]
        assert feed.watched == [12290, 4096]
        until(lambda: 12 in lines_of(host))
        host.command(Metric(name="user/pulses", datatype=10, double_value=7.0))
        host.command(Metric(name="user/gate", datatype=11, boolean_value=False))
        until(lambda: sorted(feed.written) == [(2, 0.0, True), (12290, 7.0, False)])
        feed.refusal = "the card does not answer"
        host.command(Metric(name="user/pulses", datatype=10, double_value=8.0))
        said = "sparkplug: a command is refused: user.pulses: the card does not answer"
        until(lambda: said in caplog.messages)
        show_line(feed, 13)
        until(lambda: 13 in lines_of(host))
    assert host.await_first("NDEATH")
    assert "user.pulses was set to 7 by Sparkplug" in caplog.messages


def test_a_process_that_is_killed_is_started_again_and_it_is_said(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.INFO)
    feed, said = GivenFeed(), list[str]()
    with running(METRICS, feed, said) as bridge:
        until(lambda: 'openacr_line{machine="mill"} 12.0' in scraped(bridge))
        os.kill(pids(caplog)[0], signal.SIGKILL)
        until(lambda: len(said) >= 2)
        show_line(feed, 13)
        until(lambda: 'openacr_line{machine="mill"} 13.0' in scraped(bridge))
        assert said == [
            "the process of the bridge has ended (status -9); it is started again in 1 s",
            f"the bridge publishes again: {bridge.places[0]}",
        ]
    assert set(said) <= set(caplog.messages)
    for pid in pids(caplog):
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


def test_a_machine_with_other_axes_has_them_in_a_process_that_is_started_again(
    broker: RunningBroker, host: Subscriber
) -> None:
    feed, said = GivenFeed(), list[str]()
    with running(node_file(broker.port), feed, said):
        assert "C/actual" in named(host.await_first("NBIRTH"))
        feed.axes = (AxisName("X"), AxisName("A", is_rotary=True))
        assert host.await_first("NDEATH")
        until(lambda: len(said) == 2)
        until(lambda: len(host.of("NBIRTH")) == 2)
        found = named(host.of("NBIRTH")[1])
        assert (found["X/actual"], found["A/actual"], "C/actual" in found) == (1.5, -2.0, False)
    assert said == [
        "the axes of the machine have changed; it is started again in 1 s",
        f"the bridge publishes again: sparkplug mqtt://127.0.0.1:{broker.port}",
    ]


def test_a_process_that_takes_no_values_is_killed_and_started_again(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(life, "HUNG_S", 2.0)
    caplog.set_level(logging.INFO)
    feed, said = GivenFeed(), list[str]()
    with running(METRICS, feed, said) as bridge:
        show_line(feed, 13)  # what is sent before the start has the time of a start to be taken
        until(lambda: 'openacr_line{machine="mill"} 13.0' in scraped(bridge))
        with suppress(ProcessLookupError):  # a loaded machine has stopped it already
            os.kill(pids(caplog)[0], signal.SIGSTOP)
        until(lambda: said)
    assert said[0] == (
        "the process of the bridge takes no values; it is started again in 1 s"
    )  # fmt: skip
    with pytest.raises(ProcessLookupError):
        os.kill(pids(caplog)[0], 0)


@pytest.mark.skipif(sys.platform == "win32", reason="processes are looked up in /proc")
def test_the_process_ends_with_a_panel_that_is_killed() -> None:
    children = left_by(
        f"""
        import logging, sys, time
        from pathlib import Path
        from openacr.bridge.load import parse_bridge
        from openacr.bridge.process import BridgeProcess
        from tests.bridge.bench import GivenFeed
        logging.basicConfig(stream=sys.stderr)
        log = logging.getLogger("openacr.bridge.life")
        log.setLevel(logging.INFO)
        seen = []
        log.addFilter(lambda record: seen.append(record.args[0]) or False)
        BridgeProcess(parse_bridge({METRICS!r}), Path(), GivenFeed()).start()
        print(*seen, flush=True)
        time.sleep(60)
        """
    )
    assert len(children) == 1


def test_a_panel_asks_the_process_for_its_end() -> None:
    async def ended() -> str:
        over = asyncio.Event()
        life = Life(parse_bridge(METRICS), Path(), GivenFeed())
        return await life.run(over, lambda _places: over.set())

    assert asyncio.run(ended()) == "the process of the bridge has ended (status 0)"


@pytest.mark.parametrize(
    ("farewell", "stopped"), [([], 0), ([messages.End()], 1), ([messages.End()] * 2, 1)]
)
def test_systems_end_properly_only_when_the_panel_asks_for_it(
    monkeypatch: pytest.MonkeyPatch, farewell: list[messages.ToProcess], stopped: int
) -> None:
    """A broker publishes the will of a node whose connection is lost; a slow end helps no host."""
    bridge = Mock(places=())
    monkeypatch.setattr(child, "bridge_of", lambda *_words: bridge)
    begin = messages.Begin(parse_bridge(METRICS), ".", (), logging.WARNING)
    sent = [begin, messages.Reading(RUNNING), *farewell]
    answers = io.BytesIO()
    asked = child.serve(Pipe(io.BytesIO(b"".join(map(messages.framed, sent))), answers))
    assert (asked, bridge.stop.call_count) == (stopped == 1, stopped)
    assert messages.framed(messages.Taken()) in answers.getvalue()


def test_readings_that_cannot_be_sent_are_said_and_tried_again() -> None:
    feed, said = GivenFeed(), list[str]()
    good = feed.moment
    with running(METRICS, feed, said) as bridge:
        feed.moment = replace(good, facts={"state": {"mode": object()}})
        until(lambda: said)
        feed.moment = good
        until(lambda: 'openacr_line{machine="mill"} 12.0' in scraped(bridge))
    assert said[0].startswith("a reading cannot be sent: TypeError: ")


def test_what_cannot_begin_is_said_and_no_process_is_left(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        bridge = BridgeProcess(
            parse_bridge(METRICS.replace("port = 0", f"port = {port}")), Path(), GivenFeed()
        )
        with pytest.raises(UserError, match=rf"port {port} on 127\.0\.0\.1 is in use"):
            bridge.start()
    with pytest.raises(ProcessLookupError):
        os.kill(pids(caplog)[0], 0)
    with pytest.raises(UserError, match="nowhere: cannot be read"):
        BridgeProcess(
            parse_bridge('[prometheus]\npassword_file = "nowhere"\n'), Path(), GivenFeed()
        )


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (messages.Write(1, 12291, 1.0, False), "the bridge file does not allow to write 12291"),
        (messages.Write(1, 2, 1.0, False), "the bridge file does not allow to write 2"),
        (messages.Write(1, 12290, 1.0, True), "the bridge file does not allow to write 12290"),
        (messages.Write(1, 3, 1.0, True), "the bridge file does not allow to write 3"),
        (messages.Write(1, 12290, 1001.0, False), "pulses: 1001 is not in -1000..1000"),
        (messages.Write(1, 2, 0.5, True), "gate is a flag: 0.5 is neither 0 nor 1"),
    ],
)
def test_the_panel_itself_refuses_what_the_file_does_not_allow(
    asked: messages.Write, said: str
) -> None:
    feed = GivenFeed()
    seen = '[[value]]\nname = "seen"\nflag = 3\n'
    with pytest.raises(UserError) as caught:
        Life(parse_bridge(METRICS + seen), Path(), feed)._permitted(asked)
    assert (str(caught.value), feed.written) == (said, [])


def test_a_process_is_not_read_while_too_many_of_its_writes_are_under_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(life, "MOST_WRITES", 3)
    begun = list[Future[None]]()

    def write(*_asked: object, is_flag: bool) -> Future[None]:
        begun.append(Future())
        return begun[-1]

    async def read_on() -> list[int]:
        feed = Mock(write=write)
        one = Life(parse_bridge(METRICS), Path(), feed)
        process = Mock(stdin=None, stdout=asyncio.StreamReader())
        for number in range(5):
            process.stdout.feed_data(messages.framed(messages.Write(number, 2, 1.0, True)))
        process.stdout.feed_eof()
        reading = asyncio.create_task(one._listen(process, lambda _places: None))
        counts = []
        for done in range(3):
            for _turn in range(100):
                await asyncio.sleep(0)
            counts.append(len(begun))
            begun[done].set_result(None)
        await reading
        return counts

    assert asyncio.run(read_on()) == [3, 4, 5]


def test_the_screens_show_what_becomes_of_the_process(quiet_panel: Served, tmp_path: Path) -> None:
    path = tmp_path / "bridge.toml"
    path.write_text(METRICS)
    _bridge(quiet_panel.panel, path)._tell("the bridge publishes again: here")
    quiet_panel.step(0.01)
    assert quiet_panel.station.screens.said[-1]["text"] == "the bridge publishes again: here"


def test_on_windows_the_process_has_no_window_and_is_no_part_of_ctrl_c(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert apart() == {"start_new_session": True}
    monkeypatch.setattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0x200, raising=False)
    monkeypatch.setattr(subprocess, "CREATE_NO_WINDOW", 0x8000000, raising=False)
    monkeypatch.setattr(life, "WINDOWS", True)
    assert apart() == {"creationflags": 0x8000200}


# --- messages -------------------------------------------------------------------------


def test_a_moment_and_a_file_arrive_as_they_were_sent() -> None:
    sent: list[messages.ToProcess] = [
        messages.Begin(parse_bridge(METRICS), "/shop", GivenFeed().axes, 20),
        messages.Reading(RUNNING),
        messages.Reading(Moment(lost="gone")),
        messages.Written(3, "no"),
    ]
    pipe = Pipe(io.BytesIO(b"".join(messages.framed(each) for each in sent)), io.BytesIO())
    begin, reading, *rest = (pipe.next() for _ in sent)
    assert begin == sent[0]
    assert isinstance(reading, messages.Reading)
    assert reading.moment.run is not None and RUNNING.run is not None
    expected = replace(RUNNING, run=replace(RUNNING.run, left_s=0.0))
    assert replace(reading.moment, run=replace(reading.moment.run, left_s=0.0)) == expected
    assert rest == sent[2:]
    assert pipe.next() is None


@pytest.mark.parametrize(
    "data",
    [b"", b"\1\0\0", b"\2\0\0\0\x90", b"\1\0\0\0\xc1", messages.HEAD.pack((1 << 26) + 1) + b"\x90"],
)
def test_a_pipe_that_is_cut_or_damaged_has_ended(data: bytes) -> None:
    assert Pipe(io.BytesIO(data), io.BytesIO()).next() is None


def test_a_panel_that_has_gone_is_no_failure_of_sending() -> None:
    closed = io.BytesIO()
    closed.close()
    Pipe(io.BytesIO(), closed).send(messages.Taken())


# --- the feed of the process ----------------------------------------------------------


@pytest.mark.parametrize(("rate_hz", "stale_s"), [(50.0, STALE_S), (1.0, 2.0), (0.1, 20.0)])
def test_values_of_a_panel_that_sends_no_more_are_not_published(
    rate_hz: float, stale_s: float
) -> None:
    now_s = 100.0
    feed = PipeFeed((AxisName("X"),), lambda _asked: None, lambda: now_s)
    feed.start([], rate_hz)
    assert feed.newest().lost == "the panel sends no values yet"
    feed.take(RUNNING)
    now_s += stale_s
    assert feed.newest() is RUNNING
    now_s += 0.1
    assert feed.newest() == Moment(
        lost=f"the last values of the panel are {stale_s + 0.1:.1f} s old"
    )


def test_writes_end_with_their_own_answers_and_with_the_bridge() -> None:
    asked: list[messages.Write] = []
    feed = PipeFeed((), asked.append)
    one, two, three = (feed.write(12290, float(k), is_flag=False) for k in range(3))
    assert asked == [messages.Write(k + 1, 12290, float(k), False) for k in range(3)]
    feed.finish(messages.Written(2, "no"))
    feed.finish(messages.Written(99, ""))
    with pytest.raises(OpenacrError, match="no"):
        two.result(0)
    assert not one.done()
    feed.finish(messages.Written(1, ""))
    assert one.result(0) is None
    three.cancel()
    last = feed.write(2, 1.0, is_flag=True)
    feed.stop()
    with pytest.raises(OpenacrError, match="the bridge ends"):
        last.result(0)
