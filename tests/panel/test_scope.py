"""The scope: its samples are those of the kernel, its triggers are found to the sample."""

import io
import math
import re
import sys
from collections.abc import Iterator
from itertools import pairwise

import httpx
import numpy as np
import pytest
from pyarrow import parquet
from tests.panel.bench import HandStation, Served

from openacr.client import ConnectionLostError
from openacr.client.names import named
from openacr.errors import UserError
from openacr.panel.control.engineer.card_sampler import CardSampler
from openacr.panel.control.engineer.sampling import Polled
from openacr.panel.control.engineer.scope import Block, Samples, Scope, Trigger
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role

CHANNELS = ("P12288", "P12290", "P6916", "BIT516", "BIT548", "P4096", "P12295", "P8192")


def test_eight_channels_hold_what_the_card_shows_in_each_tick(hand: HandStation) -> None:
    station, controller = hand.station, hand.installation.controller
    assert controller is not None
    channels = [named(each) for each in CHANNELS]
    for every in (1, 3):
        hand.do("scope.arm", channels=CHANNELS, period_ms=every * 0.5)
        hand.do("jog.increment", axis="X", direction=1, distance=5.0, tick=hand.tick)
        hand.run(0.1)
        own = station.captures.of(1)
        own.sampling.collect(own.scope)
        own.scope.take()
        begun = own.scope.capture.next if own.scope.capture else 0
        seen = []
        for _ in range(400):
            controller.advance(1)
            seen.append([_shown(controller, each) for each in CHANNELS])
        own.sampling.collect(own.scope)
        found = own.scope.take()
        assert found is not None
        first, block, period_s = found
        assert (first, period_s, len(channels)) == (begun, every * 0.0005, 8)
        rows = block.T.tolist()
        assert any(rows == seen[k::every] for k in range(every))
        assert len(set(block[1])) > 20  # it moves
        hand.do("scope.stop")
        hand.until(lambda: not hand.is_busy)


def _shown(controller: object, name: str) -> float:
    card: object = controller
    number = int(name.lstrip("PBIT"))
    return float(card.bit[number] if name.startswith("BIT") else card.p[number])  # type: ignore[attr-defined]


def test_nothing_is_recorded_after_the_end_of_a_capture(hand: HandStation) -> None:
    controller = hand.installation.controller
    assert controller is not None
    hand.do("scope.arm", channels=[12290], period_ms=1)
    hand.run(0.1)
    hand.do("scope.stop")
    hand.run(0.1)
    assert len(controller.take_trace().time_s) == 0
    assert hand.station.captures.of(1).scope.take() is None


# --- trigger --------------------------------------------------------------------------

PERIOD = 240  # samples of the sine
WAVE = np.sin(2.0 * math.pi * np.arange(2000) / PERIOD)


def feed(scope: Scope, values: Block, size: int) -> None:
    """Add a channel in blocks of a size, beside one that triggers nothing."""
    both = np.array([np.zeros_like(values), values])
    for first in range(0, len(values), size):
        scope.add(both[:, first : first + size])


def armed(trigger: Trigger, samples: int = 100) -> Scope:
    scope = Scope()
    scope.arm([named("P1"), named("P2")], 0.001, samples, trigger)
    return scope


def first_crossing(level: float, slope: int, earliest: int) -> int:
    """The first sample at or past the level after one that is not: sample by sample."""
    slopes = (slope,) if slope else (1, -1)
    return next(
        k
        for k, (a, b) in enumerate(pairwise(WAVE), 1)
        if k >= earliest and any((a - level) * s < 0.0 <= (b - level) * s for s in slopes)
    )


@pytest.mark.parametrize("size", [1, 7, 100, 2000])
@pytest.mark.parametrize("before", [0.0, 0.1, 0.9])
@pytest.mark.parametrize(
    ("level", "slope"), [(0.3, 1), (0.3, -1), (0.3, 0), (-0.5, -1), (-0.5, 0), (1.0, 1)]
)
def test_a_single_capture_triggers_at_the_sample_and_ends_with_its_sweep(
    size: int, before: float, slope: int, level: float
) -> None:
    scope = armed(Trigger(1, level, slope, "single", before))
    feed(scope, WAVE, size)
    capture, found = scope.capture, scope.take()
    assert capture is not None and found is not None
    at = first_crossing(level, slope, round(100 * before))
    assert (capture.triggered_at, capture.is_over) == (at, True)
    end = at - round(100 * before) + 100
    assert (found[0], found[1].shape) == (0, (2, end))
    assert np.array_equal(found[1][1], WAVE[:end])


@pytest.mark.parametrize("size", [1, 33, 2000])
@pytest.mark.parametrize("mode", ["auto", "normal"])
def test_sweeps_follow_each_other_without_overlapping(size: int, mode: str) -> None:
    scope = armed(Trigger(1, 0.49, 1, mode, 0.2), samples=300)
    found: list[int] = []
    both = np.array([np.zeros_like(WAVE), WAVE])
    for first in range(0, len(WAVE), size):
        scope.add(both[:, first : first + size])
        assert scope.capture is not None
        at = scope.capture.triggered_at
        if at is not None and at not in found:
            found.append(at)
    # 20 is too early for a sweep; that of 260 is over at 500, which is the next trigger.
    expected = [20 + PERIOD * k for k in range(1, 9)]
    assert scope.capture is not None
    assert scope.capture.triggered_at == expected[-1]
    assert not scope.capture.is_over
    assert size > PERIOD or found == expected


def test_the_latest_whole_sweep_is_named_beside_the_one_under_way() -> None:
    scope = armed(Trigger(1, 0.49, 1, "normal", 0.2), samples=300)
    capture = scope.capture
    assert capture is not None
    seen = []
    for value in WAVE:
        feed(scope, np.array([value]), 1)
        seen.append((capture.triggered_at, capture.swept_at))
    assert seen[259:261] == [(None, None), (260, None)]  # waits, then a sweep is under way
    assert seen[498:500] == [(260, None), (260, 260)]  # from sample 200 to 499
    assert seen[500] == (500, 260)  # the next one
    assert (seen[739], seen[740]) == ((500, 500), (740, 500))


def test_a_sweep_that_a_gap_cuts_is_never_whole() -> None:
    scope = armed(Trigger(1, 0.3, 1, "normal", 0.0), samples=4)
    feed(scope, np.array([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0]), 8)
    capture = scope.capture
    assert capture is not None
    assert (capture.triggered_at, capture.swept_at) == (6, 1)
    scope.break_off()
    assert (capture.triggered_at, capture.swept_at) == (1, 1)


def test_a_capture_of_a_linked_card_is_replaced_or_ended_by_another_client_only_if_it_takes_it(
    hand: HandStation,
) -> None:
    hand.station.captures.is_shared = True
    others = [Person(n, Role.SERVICE, f"10.0.0.{n}", name) for n, name in ((2, "Ann"), (3, ""))]
    for each in others:
        hand.station.join(each)
    ann, third = others
    mine = hand.do("scope.arm", channels=[12290])
    assert hand.events("scope")[-1]["owner"] == "service 1"
    for answer in (hand.send("scope.arm", who=ann, channels=[1]), hand.send("scope.stop", who=ann)):
        assert answer["error"] == {
            "code": "taken",
            "text": "the scope samples for service 1 (127.0.0.1): wait until it stops, or take it",
        }
    scope = hand.station.captures.of(1).scope
    assert (hand.events("scope")[-1]["first"], scope.running is None) == (mine["first"], False)
    hand.do("scope.arm", channels=[12290])  # one's own
    assert hand.send("scope.arm", who=ann, channels=[1], take=True)["ok"]
    assert hand.events("scope")[-1]["owner"] == "Ann"
    assert "for Ann (10.0.0.2)" in hand.refused("scope.stop")["text"]
    profile = "ACC 500\nDEC 500\nSTP 500\nJRK 0\nF500\nRES X\nX15"
    assert hand.refused("scope.index", profile=profile, channels=[1])["code"] == "taken"
    assert not hand.is_busy
    hand.station.leave(ann.client)  # what a client that has gone has begun is free
    assert hand.send("scope.stop", who=third)["ok"]
    assert scope.running is None
    hand.do("scope.arm", channels=[12290])
    assert scope.running is not None
    hand.do("scope.stop")
    assert hand.send("scope.arm", who=third, channels=[1])["ok"]  # one that is over, too


SAMPLED = {
    1: (("P12288", "BIT516"), 1.5),
    2: (("P12290", "P6916", "P12288"), 1.0),
    3: (("P6916",), 0.0),
}  # channels and period in ms by client


def others_of(hand: HandStation, count: int) -> dict[int, Person]:
    """Clients beside that of the test, from number 2 on."""
    found = {n: Person(n, Role.SERVICE, f"10.0.0.{n}") for n in range(2, count + 2)}
    for each in found.values():
        hand.station.join(each)
    return found


def test_clients_of_a_virtual_card_sample_channels_of_their_own_at_once(hand: HandStation) -> None:
    station, controller = hand.station, hand.installation.controller
    assert controller is not None
    people = {1: hand.me, **others_of(hand, 2)}
    taken: dict[int | None, list[Samples]] = {1: [], 2: [], 3: []}
    station.on_samples = lambda to, each: taken[to].append(each)
    seen: dict[int, tuple[float, ...]] = {}
    names = sorted({name for channels, _ in SAMPLED.values() for name in channels})
    begun: dict[int, int] = {}

    def live(ticks: int) -> None:
        for _ in range(ticks):
            controller.advance(1)
            seen[controller.lived_tk] = tuple(_shown(controller, each) for each in names)
        for to, samples in station.captures.samples():
            station.on_samples(to, samples)

    hand.do("jog.increment", axis="X", direction=1, distance=5.0, tick=hand.tick)
    hand.run(0.1)
    for client, (channels, period_ms) in SAMPLED.items():  # the others begin between two samples
        who = people[client]
        answer = hand.send("scope.arm", who=who, channels=channels, period_ms=period_ms)
        begun[client] = answer["result"]["tick"]
        live(100)
    assert hand.send("scope.stop", who=people[3])["ok"]
    live(101)
    assert hand.send("scope.stop", who=people[2])["ok"]
    live(50)
    for client, (channels, period_ms) in SAMPLED.items():
        blocks = [block for _, block, _ in taken[client]]
        firsts = [first for first, _, _ in taken[client]]
        sizes = [block.shape[1] for block in blocks]
        assert firsts == [sum(sizes[:n]) for n in range(len(sizes))]
        every = max(1, round(period_ms / 0.5))
        last = {1: 451, 2: 301, 3: 100}[client]  # ticks that it was there
        ticks = [begun[client] + every * n for n in range(sum(sizes))]
        assert len(ticks) == -(-last // every)
        places = [names.index(each) for each in channels]
        expected = [[seen[tick][place] for tick in ticks] for place in places]
        assert np.concatenate(blocks, axis=1).tolist() == expected
        assert station.captures.data(client)["running"] is (client == 1)
    assert len({row[names.index("P12290")] for row in seen.values()}) > 20  # it moves
    hand.do("scope.stop")
    live(10)
    assert len(controller.take_trace().time_s) == 0
    hand.until(lambda: not hand.is_busy)


def test_states_of_captures_go_to_their_clients(hand: HandStation) -> None:
    (other,) = others_of(hand, 1).values()
    hand.do("scope.arm", channels=[1])
    assert hand.send("scope.stop", who=other)["ok"]  # that of the other one alone
    own = [each for each in hand.events("scope") if each["running"]]
    assert [(each["to"], each["channels"]) for each in own] == [(1, ["P1"])]
    assert hand.station.captures.data(other.client) == {"running": False}


def test_a_client_that_comes_back_goes_on_with_its_capture(hand: HandStation) -> None:
    other, again = others_of(hand, 2).values()
    mine = hand.do("scope.arm", channels=[1])["number"]
    theirs = hand.send("scope.arm", who=other, channels=[2])["result"]["number"]
    assert mine != theirs
    for number in (mine, theirs, 99):  # the first two have their clients
        error = hand.send("scope.resume", who=again, number=number)["error"]["text"]
        assert error == f"capture {number} is not there any more: START begins another one"
    hand.station.leave(other.client)
    hand.run(0.1)
    found = hand.send("scope.resume", who=again, number=theirs)["result"]
    assert (found["running"], found["channels"], found["first"]) == (True, ["P2"], 0)
    taken: list[int | None] = []
    hand.station.on_samples = lambda to, _each: taken.append(to)
    hand.run(0.1)
    assert set(taken) == {1, again.client}
    assert hand.events("scope")[-1]["to"] == again.client


def test_a_capture_waits_a_minute_for_its_client(hand: HandStation) -> None:
    (other,) = others_of(hand, 1).values()
    assert hand.send("scope.arm", who=other, channels=[2])["ok"]
    scope = hand.station.captures.of(other.client).scope
    hand.station.leave(other.client)
    hand.run(0.01)
    hand.now_s += 59.9
    hand.run(0.01)
    assert scope.running is not None
    hand.run(0.2)
    assert scope.running is None


def test_a_fifth_capture_ends_one_without_a_client_or_is_refused(hand: HandStation) -> None:
    others = list(others_of(hand, 6).values())
    for each in others[:4]:
        assert hand.send("scope.arm", who=each, channels=[1])["ok"]
    assert hand.refused("scope.arm", channels=[2])["text"] == (
        "the scope samples for 4 clients already: one of them has to stop"
    )
    assert hand.send("scope.arm", who=others[3], channels=[2])["ok"]  # its own is replaced
    hand.station.leave(others[1].client)
    hand.do("scope.arm", channels=[2])
    running = [hand.station.captures.data(each.client)["running"] for each in others[:4]]
    assert running == [True, False, True, True]
    assert hand.send("scope.stop", who=others[0])["ok"]
    assert hand.send("scope.arm", who=others[4], channels=[1])["ok"]


def test_a_value_that_begins_at_the_level_does_not_trigger() -> None:
    scope = armed(Trigger(1, 1.0, 1, "normal", 0.0), samples=10)
    feed(scope, np.array([1.0, 2.0, 1.0, 0.5, 1.0, 2.0]), 2)
    assert scope.capture is not None
    assert scope.capture.triggered_at == 4


def test_a_single_capture_is_over_with_the_last_sample_of_its_sweep() -> None:
    scope = armed(Trigger(1, 0.5, 1, "single", 0.0), samples=10)
    feed(scope, np.array([0.0, *[1.0] * 9]), 10)
    assert scope.running is not None
    feed(scope, np.array([1.0]), 1)
    assert scope.running is None


def test_samples_are_numbered_on_through_captures() -> None:
    scope = armed(Trigger(1, 0.3, 1, "single", 0.0))
    feed(scope, WAVE, 100)
    ended = scope.capture
    assert ended is not None
    again = scope.arm([named("P1"), named("P2")], 0.001, 100, Trigger(1, 0.3, 1, "normal", 0.5))
    assert again.first == ended.next + 1
    feed(scope, WAVE, 100)
    assert again.triggered_at == again.first + first_crossing(0.3, 1, 1700)
    found = scope.take()
    assert found is not None
    assert (found[0], found[1].shape[1]) == (again.first, len(WAVE))


def test_without_a_trigger_every_sample_is_kept() -> None:
    scope = Scope()
    scope.arm([named("P1"), named("P2")], 0.001, 10, None)
    feed(scope, WAVE, 64)
    found = scope.take()
    assert found is not None
    assert np.array_equal(found[1][1], WAVE)
    assert scope.running is not None
    scope.stop()
    feed(scope, WAVE, 64)
    assert scope.take() is None


# --- a card at the end of a link ------------------------------------------------------


def test_a_card_over_a_link_is_polled_flags_by_their_words(hand: HandStation) -> None:
    session, scope, polled = hand.station.link.machine, Scope(), Polled()
    session.card.write(5, 2.5)
    session.card.write_bit(1920, True)
    channels = [named("P5"), named("BIT1920"), named("BIT1921")]
    scope.arm(channels, polled.period_s(0.02), 10, None)
    polled.begin(scope)
    for now_s in (10.0, 10.019, 10.021, 10.03, 10.045):
        polled.step(session, scope, now_s)
    found = scope.take()
    assert found is not None
    assert found[1].tolist() == [[2.5] * 3, [1.0] * 3, [0.0] * 3]


def test_a_refusal_of_a_polled_card_ends_the_capture_and_is_said(hand: HandStation) -> None:
    station = hand.station
    station.captures.of(1).sampling = Polled()
    capture = station.captures.of(1).scope.arm([named("P4000")], 0.01, 10, None)
    hand.run(0.1)
    assert capture.is_over
    assert len([text for text in hand.said if text.startswith("the scope has ended: ")]) == 1


# --- the sampler of a card ------------------------------------------------------------

PROGRAM = 5


@pytest.fixture
def arrays(hand: HandStation) -> HandStation:
    """A card whose PROG5 has arrays for three channels of 300 samples."""
    for line in ("DIM LA(3)", "DIM LA0(300)", "DIM LA2(300)", "DIM SA(2)", "DIM SA1(310)"):
        hand.station.link.machine.card.command(line, program=PROGRAM)
    return hand


def recorded(hand: HandStation, sampler: CardSampler, scope: Scope, count: int) -> list[Samples]:
    """Records of the sampler, in the time of the card."""
    found: list[Samples] = []
    while len(found) < count:
        hand.run(0.01)
        sampler.step(hand.station.link.machine, scope, hand.now_s)
        while (samples := scope.take()) is not None:
            found.append(samples)
    return found


def test_a_record_of_the_sampler_is_what_the_card_went_through_tick_by_tick(
    arrays: HandStation,
) -> None:
    hand, scope = arrays, Scope()
    sampler = CardSampler(hand.station.link.machine, PROGRAM)
    period_s = sampler.period_s(0.0)
    assert (period_s, sampler.period_s(0.0004), sampler.period_s(0.0026)) == (0.0005, 0.0005, 0.003)
    channels = [named("P12290"), named("P12319"), named("BIT1921")]
    hand.station.link.machine.card.write_bit(1921, True)
    hand.do("scope.arm", channels=["P12290"], period_ms=0)  # every tick, to compare
    hand.do("jog.increment", axis="X", direction=1, distance=5.0, tick=hand.tick)
    hand.run(0.1)
    sent: list[Samples] = []
    hand.station.on_samples = lambda _to, each: sent.append(each)
    scope.arm(channels, period_s, 250, None)
    sampler.begin(scope)
    (first, block, _), (then, _, _) = recorded(hand, sampler, scope, 2)
    assert (first, then, block.shape) == (0, 250, (3, 250))  # sweep after sweep
    ticks = np.concatenate([each[1][0] for each in sent]).tolist()
    places = [k for k in range(len(ticks)) if ticks[k : k + 250] == block[0].tolist()]
    assert len(places) == 1
    assert len(set(block[0])) > 20
    assert block[2].tolist() == [1.0] * 250
    sampler.end()
    assert not hand.station.link.machine.card.read_bit(104)


def test_a_trigger_is_found_within_a_record_and_not_across_two(arrays: HandStation) -> None:
    hand, scope = arrays, Scope()
    card, sampler = hand.station.link.machine.card, CardSampler(hand.station.link.machine, PROGRAM)
    card.write_bit(1920, False)
    capture = scope.arm([named("BIT1920")], 0.001, 100, Trigger(0, 0.5, 1, "single", 0.5))
    sampler.begin(scope)
    recorded(hand, sampler, scope, 1)
    card.write_bit(1920, True)  # too early in the second record for half a sweep before it
    recorded(hand, sampler, scope, 1)
    assert (capture.triggered_at, capture.since, capture.is_over) == (None, 602, False)
    hand.run(0.05)
    card.write_bit(1920, False)
    hand.run(0.05)
    card.write_bit(1920, True)
    ((first, block, _),) = recorded(hand, sampler, scope, 1)
    at = capture.triggered_at
    assert at is not None and capture.is_over
    assert (first, block.shape[1]) == (602, at - 602 + 50)
    assert block[0, at - 602 - 1 : at - 602 + 1].tolist() == [0.0, 1.0]


def test_arrays_that_are_missing_or_short_are_refused_with_what_to_do(
    arrays: HandStation,
) -> None:
    scope = Scope()
    for program, samples, why in (
        (PROGRAM, 301, "LA0 of PROG5 holds 300 samples, a sweep has 301: dimension it (DIM LA(8),"),
        (6, 10, "LA0 of PROG6 holds 0 samples, a sweep has 10: dimension it"),
    ):
        scope.arm([named("P12290"), named("P12319")], 0.0005, samples, None)
        with pytest.raises(UserError, match=re.escape(why)):
            CardSampler(arrays.station.link.machine, program).begin(scope)
    lines = arrays.station.link.machine.card.command("SAMP")
    assert lines == ["SAMP PERIOD 0"]  # nothing was set up


def armed_sampler(hand: HandStation, scope: Scope, trigger: Trigger | None = None) -> CardSampler:
    """The sampler with a record of 300 samples of BIT1920 under way."""
    scope.arm([named("BIT1920")], 0.001, 300, trigger)
    sampler = CardSampler(hand.station.link.machine, PROGRAM)
    sampler.begin(scope)
    return sampler


@pytest.mark.parametrize("mode", ["single", "normal"])
@pytest.mark.parametrize(("slope", "level"), [(1, 1.0), (1, 0.5), (-1, 0.0), (-1, 0.5)])
def test_the_card_waits_by_itself_for_an_edge_of_a_flag_where_the_sweep_begins(
    arrays: HandStation, slope: int, level: float, mode: str
) -> None:
    hand, scope, state = arrays, Scope(), slope > 0
    card = hand.station.link.machine.card
    card.write_bit(1920, state)  # the state is there already: that is no edge
    sampler = armed_sampler(hand, scope, Trigger(0, level, slope, mode, 0.0))
    assert card.command("SAMP")[0] == f"SAMP TRG {'' if state else '-'}BIT1920"
    for _ in range(10):
        hand.run(0.1)
        sampler.step(hand.station.link.machine, scope, hand.now_s)
    assert (scope.take(), card.read_bit(104)) == (None, False)
    card.write_bit(1920, not state)
    hand.run(0.1)
    sampler.step(hand.station.link.machine, scope, hand.now_s)
    assert card.read_bit(104)
    hand.run(2.0)  # longer than a record: nothing is stored before the edge
    card.write_bit(1920, state)
    card.write_bit(1921, True)
    ((first, block, _),) = recorded(hand, sampler, scope, 1)
    capture = scope.capture
    assert capture is not None
    assert (first, block.tolist()) == (0, [[float(state)] * 300])
    assert (capture.triggered_at, capture.is_over) == (0, mode == "single")


@pytest.mark.parametrize(
    ("channel", "trigger"),
    [
        ("P12290", Trigger(0, 0.5, 1, "single", 0.0)),
        ("BIT1920", Trigger(0, 0.5, 0, "single", 0.0)),
        ("BIT1920", Trigger(0, 0.5, 1, "auto", 0.0)),
        ("BIT1920", Trigger(0, 0.5, 1, "single", 0.01)),
        ("BIT1920", Trigger(0, 0.0, 1, "single", 0.0)),
        ("BIT1920", Trigger(0, 1.1, 1, "single", 0.0)),
        ("BIT1920", Trigger(0, 1.0, -1, "single", 0.0)),
        ("BIT1920", Trigger(0, -0.1, -1, "single", 0.0)),
        ("BIT1920", None),
    ],
)
def test_what_the_card_cannot_wait_for_is_searched_in_its_records(
    arrays: HandStation, channel: str, trigger: Trigger | None
) -> None:
    scope, card = Scope(), arrays.station.link.machine.card
    scope.arm([named(channel)], 0.001, 300, trigger)
    CardSampler(arrays.station.link.machine, PROGRAM).begin(scope)
    assert (card.command("SAMP")[0], card.read_bit(104)) == ("SAMP PERIOD 0.001", True)


@pytest.mark.parametrize("is_sent", [False, True])
def test_a_record_during_which_the_link_was_lost_is_begun_anew(
    arrays: HandStation, monkeypatch: pytest.MonkeyPatch, is_sent: bool
) -> None:
    hand, scope = arrays, Scope()
    sampler, card = armed_sampler(hand, scope), hand.station.link.machine.card
    hand.run(0.4)
    sampler.step(hand.station.link.machine, scope, hand.now_s)
    assert not card.read_bit(104)
    read_array, command = card.read_array, card.command

    def lost(*_words: object) -> list[float]:
        raise ConnectionLostError("the line is cut")

    def half_lost(line: str, **more: int) -> list[str]:
        if is_sent and line.startswith("SET 104"):
            command(line, **more)
        raise ConnectionLostError("the line is cut")

    monkeypatch.setattr(card, "read_array", lost)
    monkeypatch.setattr(card, "command", half_lost if is_sent else command)
    with pytest.raises(ConnectionLostError):
        sampler.step(hand.station.link.machine, scope, hand.now_s)
    monkeypatch.setattr(card, "read_array", read_array)
    monkeypatch.setattr(card, "command", command)
    card.write_bit(1920, True)
    ((first, block, _),) = recorded(hand, sampler, scope, 1)
    assert (first, block.tolist()) == (0, [[1.0] * 300])


def test_a_sampler_in_use_is_left_to_the_host_that_uses_it(arrays: HandStation) -> None:
    card, scope = arrays.station.link.machine.card, Scope()
    for line in ("SAMP 0 SRC P6916", "SAMP 0 BASE LA2", "SET 104"):
        card.command(line, program=PROGRAM)
    before = card.command("SAMP")
    with pytest.raises(UserError) as refused:
        armed_sampler(arrays, scope)
    assert str(refused.value) == "the sampler of the card is in use: SAMP CLEAR frees it"
    assert (card.command("SAMP"), card.read_bit(104)) == (before, True)


TAKEN = "another host has taken the sampler of the card"
ENDED = r"the sampler of the card has ended at sample \d+ of 300: did another host clear BIT104 or"


@pytest.mark.parametrize("is_full", [False, True])
@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (["SAMP 0 SRC P6916", "SET 104"], TAKEN),
        (["SAMP CLEAR"], TAKEN),
        (["CLR 104", "P6912=299"], ENDED),
    ],
)
def test_what_another_host_does_with_the_sampler_is_no_record_of_the_scope(
    arrays: HandStation, lines: list[str], why: str, is_full: bool
) -> None:
    hand, scope = arrays, Scope()
    sampler, card = armed_sampler(hand, scope), hand.station.link.machine.card
    hand.run(0.4 if is_full else 0.1)
    if is_full:
        sampler.step(hand.station.link.machine, scope, hand.now_s)
        hand.run(0.03)
        sampler.step(hand.station.link.machine, scope, hand.now_s)  # some elements have been read
    for line in lines:
        card.command(line, program=PROGRAM)
    with pytest.raises(UserError, match=why):
        recorded(hand, sampler, scope, 1)
    assert scope.take() is None


def test_the_end_of_a_capture_disarms_no_other_host(arrays: HandStation) -> None:
    hand, scope = arrays, Scope()
    sampler, card = armed_sampler(hand, scope), hand.station.link.machine.card
    card.command("SAMP 0 SRC P6916")
    sampler.end()
    assert card.read_bit(104)


def test_a_gap_parts_the_samples_that_are_taken() -> None:
    scope = armed(Trigger(1, 0.3, 1, "normal", 0.0), samples=10)
    feed(scope, np.array([0.0, 0.0]), 1)
    scope.break_off()
    feed(scope, np.array([1.0, 0.0, 1.0]), 2)
    parts = [scope.take(), scope.take(), scope.take()]
    assert [part and (part[0], part[1].shape[1]) for part in parts] == [(0, 2), (3, 3), None]
    assert scope.capture is not None
    assert scope.capture.triggered_at == 5  # not 3: nothing is known of the sample before it


# --- Parquet --------------------------------------------------------------------------


def post(url: str, data: bytes, **query: object) -> httpx.Response:
    return httpx.post(f"{url}/api/scope/parquet", content=data, params={**query}, timeout=60.0)  # type: ignore[dict-item]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    panel = Served(tmp_path_factory.mktemp("panel"), by_hand=True)
    yield panel
    panel.close()


def test_a_record_becomes_a_parquet_file_with_its_time(served: Served) -> None:
    columns = np.array([[1.5, math.nan, -2.0], [0.1, 1e300, 3.0]])
    answer = post(served.url, columns.tobytes(), names='["CH1 [mm]", "M"]', period_s=0.0005)
    assert answer.headers["content-type"] == "application/vnd.apache.parquet"
    table = parquet.read_table(io.BytesIO(answer.content))
    assert table.to_pydict() == {
        "time_s": [0.0, 0.0005, 0.001], "CH1 [mm]": [1.5, None, -2.0], "M": [0.1, 1e300, 3.0],
    }  # fmt: skip
    assert [str(kind) for kind in table.schema.types] == ["double"] * 3
    answer = post(served.url, bytes(16), names='["a"]', period_s=0.5, begin_s=-0.5)
    table = parquet.read_table(io.BytesIO(answer.content))
    assert table.column("time_s").to_pylist() == [-0.5, 0.0]


@pytest.mark.parametrize(
    ("names", "size", "why"),
    [
        ('["a", "b"]', 24, "24 bytes are no 2 columns of equal length"),
        ("a", 8, "names: a JSON list of texts is needed"),
        ("[1]", 8, "names: a JSON list of texts is needed"),
        ("[]", 8, "names: 1 to 9 different ones, none time_s"),
        ('["a", "a"]', 16, "names: 1 to 9 different ones, none time_s"),
        ('["time_s"]', 8, "names: 1 to 9 different ones, none time_s"),
    ],
)
def test_what_is_no_record_is_refused(served: Served, names: str, size: int, why: str) -> None:
    answer = post(served.url, bytes(size), names=names, period_s=0.001)
    assert (answer.status_code, answer.json()["error"]["text"]) == (400, why)


def test_without_pyarrow_the_refusal_names_what_to_install(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    answer = post(served.url, bytes(8), names='["a"]', period_s=0.001)
    assert answer.status_code == 422
    text = "Parquet needs pyarrow: pip install 'openacr[sweep]'"
    assert answer.json()["error"]["text"] == text
