"""A card that goes back in time is the card it was, to the bit."""

from pathlib import Path

import numpy as np
import pytest
from tests.controller.hosts import X_AND_Y, Host

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.engine.watches import Watch, parameter_place
from openacr.errors import UserError
from openacr.timeline import Bookmark, Bookmarks, Kind, Moment, Timeline
from openacr.timeline.bookmarks import MOST

MOVES = ("10 X10 Y5", "20 P0=P0+1", "30 X0 Y0", "40 GOTO 10")


def moving() -> Controller:
    """A card whose program 0 moves two axes to and fro and counts in P0."""
    card = Controller()
    host = Host(card)
    host.type("SYS", "DIM P(10)", *X_AND_Y, *MOVES)
    card.advance(100)
    host.type("RUN")
    return card


@pytest.fixture
def timeline() -> Timeline:
    """With a keyframe in each tenth of a second."""
    return Timeline(moving(), keyframe_every_s=0.1)


def test_each_moment_is_found_again_to_the_bit(timeline: Timeline) -> None:
    digests = {}
    for _ in range(40):
        timeline.advance(123)
        digests[timeline.now.tick] = timeline.card.digest()
    for tick in sorted(digests, key=lambda tick: tick % 1000):
        timeline.seek(tick)
        assert timeline.now == Moment(tick)
        assert timeline.card.digest() == digests[tick]
    assert len(timeline.branches) == 1


def test_a_keyframe_is_taken_when_it_is_due(timeline: Timeline) -> None:
    first = timeline.branch.first.tick
    timeline.advance(1000)
    every_tk = round(0.1 / timeline.card.period_s)
    ticks = [each.tick - first for each in timeline.branch.keyframes]
    assert ticks == list(range(0, 1001, every_tk))


def test_time_that_is_lived_through_again_takes_no_keyframe_but_where_they_were_thinned(
    timeline: Timeline,
) -> None:
    timeline.advance(1000)
    every_tk = round(0.1 / timeline.card.period_s)
    before = [each.tick for each in timeline.branch.keyframes]
    timeline.seek(before[1] + 30)
    timeline.advance(before[-1] - timeline.now.tick)
    assert [each.tick for each in timeline.branch.keyframes] == before
    gone = timeline.branch.keyframes.pop(2).tick
    timeline.seek(gone + 10)
    timeline.advance(every_tk)
    assert [each.tick for each in timeline.branch.keyframes] == [
        *before[:2], gone + 10, *before[3:],
    ]  # fmt: skip
    timeline.seek(timeline.branch.last)
    timeline.advance(every_tk)
    assert timeline.branch.keyframes[-1].tick == before[-1] + every_tk


def test_what_differs_from_an_image_makes_the_present_one_of_it() -> None:
    card = moving()
    first = card.image()
    place = parameter_place(card.memory, 0)
    assert place is not None
    card.watch([Watch(*place, bound=1.5), Watch(*place, mask=7)])
    card.record()
    for _ in range(2):
        card.advance(1001)
        places, values = card.differences(np.frombuffer(first, np.uint64))
        changed = bytearray(first)
        np.frombuffer(changed, np.uint64)[places] = values
        assert changed == card.image()
        assert len(places) == len(set(places.tolist())) > 10
        card.announce_lines(1, lambda _program, _line: True)
    assert card.within


def test_inputs_come_again_on_the_path_forward(timeline: Timeline) -> None:
    timeline.advance(700)
    begin = timeline.now
    timeline.card.set_input(5, True)
    timeline.advance(300)
    timeline.card.send("HALT PROG0\r")
    timeline.card.p[0] = 77
    timeline.advance(900)
    end, digest = timeline.now, timeline.card.digest()
    timeline.seek(begin.tick - 1)
    assert timeline.card.bit[5] is False
    assert timeline.is_past
    for ticks in (1, 299, 1, 900):
        timeline.advance(ticks)
    assert timeline.now == end
    assert timeline.card.p[0] == 77
    assert timeline.card.digest() == digest
    assert not timeline.is_past
    assert len(timeline.branches) == 1


def test_an_input_in_the_past_begins_a_branch_and_leaves_the_other(timeline: Timeline) -> None:
    timeline.advance(2000)
    timeline.card.p[0] = 500
    timeline.advance(1000)
    end, digest = timeline.now, timeline.card.digest()
    fork = Moment(timeline.branch.first.tick + 1500)
    timeline.seek(fork)
    timeline.card.p[0] = 900
    timeline.advance(100)
    assert (timeline.branch.number, timeline.branch.parent, timeline.branch.fork) == (1, 0, fork)
    assert timeline.branch.last == Moment(fork.tick + 100)
    assert timeline.card.p[0] >= 900
    other = timeline.card.digest()
    timeline.switch(0)
    assert (timeline.now, timeline.card.p[0] < 900) == (end, True)
    assert timeline.card.digest() == digest
    timeline.switch(1)
    assert timeline.card.digest() == other
    timeline.seek(fork.tick - 200)
    timeline.advance(300)
    assert timeline.card.digest() == other
    assert len(timeline.branches) == 2


def test_an_input_at_the_last_moment_does_not_begin_a_branch(timeline: Timeline) -> None:
    timeline.advance(500)
    end = timeline.now
    timeline.seek(end.tick - 300)
    timeline.seek(end)
    timeline.card.p[0] = 3
    assert len(timeline.branches) == 1


def test_an_input_before_another_of_the_same_last_tick_begins_one(timeline: Timeline) -> None:
    timeline.advance(500)
    timeline.card.p[0] = 3
    timeline.seek(timeline.now.tick - 1)
    timeline.advance(0)
    timeline.card.p[1] = 4
    assert len(timeline.branches) == 2


def test_connections_are_those_of_the_moment(timeline: Timeline) -> None:
    timeline.advance(100)
    before = timeline.now
    host = Host(timeline.card, StreamKind.SERIAL)
    host.send("PROG0\r?P0\r")
    timeline.advance(100)
    end, digest = timeline.now, timeline.card.digest()
    timeline.seek(before.tick - 1)
    assert not timeline.card.has_stream(host.stream)
    timeline.seek(end)
    assert timeline.card.has_stream(host.stream)
    assert timeline.card.digest() == digest
    assert host.heard() == ""


def test_what_is_printed_on_the_path_to_a_moment_is_not_heard(timeline: Timeline) -> None:
    heard: list[str] = []
    timeline.card.send('HALT PROG0\rPROG1\r10 PRINT "tick"\r20 DWL 0.01\r30 GOTO 10\rRUN\r')
    timeline.card.listen(lambda program, text: heard.append(text))
    timeline.advance(1000)
    assert heard
    heard.clear()
    timeline.seek(timeline.now.tick - 555)
    assert heard == []
    timeline.advance(100)
    assert heard


def test_a_restart_of_the_card_is_part_of_its_time(timeline: Timeline) -> None:
    timeline.advance(300)
    timeline.card.send("REBOOT\r")
    timeline.advance(300)
    end, digest = timeline.now, timeline.card.digest()
    timeline.seek(end.tick - 450)
    assert timeline.card.tick == timeline.card.lived_tk
    timeline.advance(450)
    assert (timeline.now, timeline.card.digest()) == (end, digest)
    assert timeline.card.tick == 300


def test_a_moment_outside_of_the_branch_is_refused(timeline: Timeline) -> None:
    timeline.advance(200)
    first, last = timeline.branch.first.tick, timeline.branch.last.tick
    digest = timeline.card.digest()
    for tick in (first - 1, last + 1):
        with pytest.raises(
            UserError, match=f"tick {tick} is not on branch 0, .* {first} to {last}"
        ):
            timeline.seek(tick)
    assert timeline.card.digest() == digest
    with pytest.raises(UserError, match="there is no branch 1; known: 0"):
        timeline.switch(1)
    with pytest.raises(UserError, match="branch -1"):
        timeline.switch(-1)


def test_a_card_with_a_journal_has_no_timeline(tmp_path: Path) -> None:
    card = moving()
    card.recorder = Recorder(card, tmp_path / "a.journal")
    with pytest.raises(UserError, match="writes a journal already"):
        Timeline(card)
    card.close()


# moments within a tick


def before_lines(timeline: Timeline, line: int) -> list[Moment]:
    """Advance for 600 ticks, with all stops before a line."""
    found = []
    end_tk = timeline.now.tick + 600
    timeline.card.announce_lines(1, lambda program, present: present == line)
    while timeline.now.tick < end_tk or timeline.card.within:
        if timeline.advance(end_tk - timeline.now.tick):
            found.append(timeline.now)
    timeline.card.announce_lines()
    return found


def test_a_moment_before_a_line_is_found_again(timeline: Timeline) -> None:
    timeline.card.send("HALT PROG0\rPROG1\r10 P1=P1+1\r20 P2=P2+1\r30 GOTO 10\rRUN\r")
    counted = {}
    end_tk = timeline.now.tick + 300
    timeline.card.announce_lines(2, lambda program, line: line == 20)
    while timeline.advance(end_tk - timeline.now.tick):
        counted[timeline.now] = (timeline.card.p[1], timeline.card.p[2])
    assert timeline.card.within == 0
    timeline.card.announce_lines()
    assert len(counted) > 100
    assert all(moment.within for moment in counted)
    for moment in reversed(counted):
        timeline.seek(moment)
        assert timeline.now == moment
        one, two = counted[moment]
        assert (timeline.card.p[1], timeline.card.p[2]) == (one, two) == (one, one - 1)


def test_a_moment_within_the_tick_of_a_keyframe_is_before_it() -> None:
    timeline = Timeline(moving(), keyframe_every_s=0.0005)
    timeline.card.announce_lines(1, lambda program, line: True)
    timeline.advance(3000)
    place = timeline.now
    assert place.within
    timeline.card.announce_lines()
    timeline.advance(10)
    assert place.tick in [each.tick for each in timeline.branch.keyframes]
    timeline.seek(place)
    assert timeline.now == place


def counting(timeline: Timeline) -> None:
    timeline.card.send("HALT PROG0\rPROG1\r10 P1=P1+1\r20 P2=P1\r30 GOTO 10\rRUN\r")


def test_an_input_within_a_tick_comes_again_within_it(timeline: Timeline) -> None:
    counting(timeline)
    timeline.advance(200)
    before = timeline.now
    timeline.card.announce_lines(2, lambda program, line: line == 20)
    assert timeline.advance(100)
    place = timeline.now
    timeline.card.p[1] = 1000
    timeline.card.announce_lines()
    timeline.advance(0)
    timeline.card.p[3] = timeline.card.p[2]
    timeline.advance(300)
    end, digest = timeline.now, timeline.card.digest()
    assert timeline.card.p[3] >= 1000
    for step in (1, 7, 400):
        timeline.seek(before)
        while timeline.now.tick + step < end.tick:
            timeline.advance(step)
        timeline.advance(end.tick - timeline.now.tick)
        assert (timeline.now, timeline.card.digest()) == (end, digest)
    timeline.seek(place)
    assert timeline.card.p[1] == 1000
    timeline.seek(end)
    assert timeline.card.digest() == digest
    assert len(timeline.branches) == 1


def test_lines_are_announced_on_the_path_to_an_input_within_a_tick(timeline: Timeline) -> None:
    counting(timeline)
    timeline.advance(50)
    before = timeline.now
    stops = []
    timeline.card.announce_lines(2, lambda program, line: True)
    for n in range(9):
        assert timeline.advance(100)
        stops.append(timeline.now)
        if n % 4 == 2:
            timeline.card.p[4] = n
    timeline.seek(before)
    again = []
    for _ in range(9):
        assert timeline.advance(100)
        again.append(timeline.now)
    assert again == stops
    assert len(timeline.branches) == 1


def test_a_branch_can_begin_within_a_tick(timeline: Timeline) -> None:
    counting(timeline)
    timeline.card.announce_lines(2, lambda program, line: line == 20)
    timeline.advance(500)
    place = timeline.now
    timeline.card.announce_lines()
    timeline.advance(500)
    timeline.seek(place)
    timeline.card.p[1] = 5000
    timeline.advance(0)
    assert timeline.branch.fork == place
    assert timeline.card.p[2] >= 5000
    digest = timeline.card.digest()
    timeline.advance(100)
    timeline.seek(place.tick)
    assert timeline.card.digest() == digest


# back to an event


def test_going_back_finds_the_last_event_before_the_present(timeline: Timeline) -> None:
    place = parameter_place(timeline.card.memory, 0)
    assert place is not None
    end_tk = timeline.now.tick + 6000
    changes, present = {}, timeline.card.p[0]
    while timeline.now.tick < end_tk:
        timeline.advance(1)
        if timeline.card.p[0] != present:
            present = timeline.card.p[0]
            changes[timeline.now.tick] = present
    assert len(changes) > 2
    timeline.advance(10)
    for tick, value in reversed(changes.items()):
        timeline.card.watch([Watch(place[0], place[1], bound=value - 0.5)])
        assert timeline.seek_stop()
        assert (timeline.now, timeline.card.p[0]) == (Moment(tick), value)
    assert not timeline.seek_stop()
    assert timeline.now == timeline.branch.first


def test_going_back_stops_before_lines(timeline: Timeline) -> None:
    found = before_lines(timeline, 20) + before_lines(timeline, 20) + before_lines(timeline, 20)
    assert found
    timeline.card.announce_lines(1, lambda program, line: line == 20)
    for moment in reversed(found):
        assert timeline.seek_stop()
        assert timeline.now == moment
    assert not timeline.seek_stop()
    assert timeline.now == timeline.branch.first


# bounds


def test_the_history_keeps_within_its_bytes() -> None:
    card = moving()
    timeline = Timeline(card, keyframe_every_s=0.02, most_bytes=200_000)
    for _ in range(100):
        timeline.advance(200)
        card.p[5] = timeline.now.tick
    assert timeline.size_bytes <= 200_000
    first, end = timeline.branch.first, timeline.now
    digest = card.digest()
    timeline.seek(first)
    timeline.advance(end.tick - first.tick)
    assert card.digest() == digest


def test_inputs_alone_make_a_long_history_begin_later() -> None:
    card = moving()
    timeline = Timeline(card, keyframe_every_s=0.05, most_bytes=300_000)
    first = timeline.branch.first
    for _ in range(100):
        timeline.advance(100)
        card.send(" " * 10_000 + "\r")
    timeline.advance(200)
    assert timeline.size_bytes <= 300_000
    assert timeline.branch.first.tick > first.tick
    end, digest = timeline.now, card.digest()
    timeline.seek(timeline.branch.first)
    timeline.seek(end)
    assert card.digest() == digest
    timeline.seek(end.tick - 150)
    card.set_input(3, True)
    timeline.advance(100)
    digest, other = card.digest(), timeline.now
    timeline.seek(timeline.branch.first)
    timeline.seek(other)
    assert (timeline.branch.number, card.digest()) == (1, digest)


# journals


def test_a_branch_is_saved_as_a_journal_that_replays_to_equal_states(
    timeline: Timeline, tmp_path: Path
) -> None:
    counting(timeline)
    timeline.advance(500)
    timeline.card.announce_lines(2, lambda program, line: line == 20)
    timeline.advance(2000)
    timeline.card.p[1] = 70
    timeline.card.announce_lines()
    timeline.advance(5000)
    timeline.seek(timeline.now.tick - 3000)
    timeline.card.set_input(3, True)
    timeline.advance(4000)
    parts: list[float] = []
    timeline.save(tmp_path / "a.journal", seen=parts.append)
    journal = read_journal(tmp_path / "a.journal")
    assert journal.is_whole
    again = Replay(journal)
    again.run()
    assert (again.difference, again.equal >= 3) == (None, True)
    assert again.card.digest() == timeline.card.digest()
    assert parts == sorted(parts)
    assert parts[-1] == 1.0


def test_a_course_gives_the_samples_and_values_that_the_card_had(timeline: Timeline) -> None:
    first, parameters = timeline.now.tick, [0, 12288]
    lived: list[list[float]] = []
    for _ in range(20):
        lived.append([float(timeline.card.p[each]) for each in parameters])
        timeline.card.set_input(3, len(lived) % 2 == 0)
        timeline.advance(50)
    course = timeline.course(0, first, first + 19 * 50)
    assert course.last == Moment(first + 19 * 50)
    channels = course.samples(parameters, first, 50, 20)
    assert [list(each) for each in zip(*channels, strict=True)] == lived
    assert timeline.course(0, first + 501).first_tk <= first + 501
    assert course.values([*parameters, 999_999], first + 100) == [*lived[2], None]
    with pytest.raises(UserError, match=f"tick {first - 1} is not known"):
        course.samples([0], first - 1, 1, 1)
    with pytest.raises(UserError, match=f"tick {first - 1} is not on branch 0"):
        timeline.course(0, first - 1)


def test_a_dropped_branch_is_gone_and_its_number_is_not_given_again(timeline: Timeline) -> None:
    begun: list[tuple[int, int]] = []
    timeline.on_fork = lambda before, branch: begun.append((before.number, branch.number))
    timeline.advance(500)
    for _ in range(2):
        timeline.seek(timeline.branch.first)
        timeline.fork()
        timeline.advance(100)
    with pytest.raises(UserError, match="branch 2 is the present one: change to another one first"):
        timeline.drop(2)
    timeline.drop(1)
    timeline.seek(timeline.branch.first)
    timeline.card.p[0] = 1
    assert [each.number for each in timeline.branches] == [0, 2, 3]
    assert begun == [(0, 1), (1, 2), (2, 3)]
    with pytest.raises(UserError, match="there is no branch 1; known: 0, 2, 3"):
        timeline.switch(1)
    timeline.switch(2)
    assert timeline.branch.number == 2


def test_of_too_many_bookmarks_the_oldest_that_no_hand_has_set_goes_first() -> None:
    bookmarks = Bookmarks()
    assert bookmarks.add(0, Bookmark(1, Kind.HAND, "mine"))
    for tick in range(2, MOST + 3):
        assert bookmarks.add(0, Bookmark(tick, Kind.END, "PROG0 has ended"))
    assert not bookmarks.add(0, Bookmark(MOST, Kind.END, "PROG0 has ended"))
    ticks = [each.tick for each in bookmarks.of(0)]
    assert ticks == [1, *range(4, MOST + 3)]
    bookmarks.fork(0, 1, 5)
    assert [each.tick for each in bookmarks.of(1)] == [1, 4, 5]
    bookmarks.remove(1, 4)
    assert [each.tick for each in bookmarks.of(1)] == [1, 5]
    bookmarks.forget(0)
    assert bookmarks.of(0) == []
    assert [each.tick for each in bookmarks.of(1)] == [1, 5]
