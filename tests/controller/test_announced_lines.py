"""Lines that are announced before they begin: a card that stops within a tick."""

from pathlib import Path

import pytest
from tests.controller.hosts import Host

from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.player import Player
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.errors import StoreError
from openacr.journal.entries import Entered, JournalEntry


def counting(*programs: int) -> Controller:
    """Programs that count without end: P(10 n) by two statements of line 10, P(10 n + 1) in 20."""
    card = Controller()
    host = Host(card)
    host.type("SYS", "DIM P(200)", *(f"DIM PROG{n}(2000)" for n in programs if n >= 8))
    for n in programs:
        first = 10 * n
        lines = (f"10 P{first}=P{first}+1 : P{first}=P{first}+1", f"20 P{first + 1}=P{first + 1}+1")
        host.type(f"PROG{n}", *lines, "30 GOTO 10")
    for n in programs:
        host.type(f"PROG{n}", "RUN")
    card.advance(100)
    return card


def counts(card: Controller, program: int = 0) -> tuple[float, float]:
    return card.p[10 * program], card.p[10 * program + 1]


def always(program: int, line: int) -> bool:
    return True


class Seen(list[tuple[int, int]]):
    """Notes programs and lines that are announced, and stops before one line, or all (0)."""

    def __init__(self, stops_at: int | None = None) -> None:
        super().__init__()
        self.stops_at = stops_at

    def __call__(self, program: int, line: int) -> bool:
        self.append((program, line))
        return self.stops_at in (0, line)


def test_a_card_stops_before_each_line_and_goes_on_with_it() -> None:
    card = counting(0)
    seen = Seen(0)
    card.announce_lines(1, seen)
    while not seen or seen[-1] != (0, 10):
        card.advance(1000)
    twos, ones = counts(card)
    done = len(seen)
    card.advance(1000)
    assert (seen[done:], counts(card)) == ([(0, 20)], (twos + 2, ones))
    card.advance(1000)
    assert (seen[done:], counts(card)) == ([(0, 20), (0, 30)], (twos + 2, ones + 1))
    card.advance(1000)
    assert (seen[done:], counts(card)) == ([(0, 20), (0, 30), (0, 10)], (twos + 2, ones + 1))


def test_announced_lines_change_nothing_of_what_a_card_does() -> None:
    plain, watched = counting(0, 9), counting(0, 9)
    plain.advance(3000)
    end_tk = watched.lived_tk + 3000
    watched.announce_lines(0xFFFF, always)
    stops = 0
    while watched.lived_tk < end_tk or watched.within:
        watched.advance(end_tk - watched.lived_tk)
        stops += watched.within != 0
    assert stops > 3000
    assert (watched.tick, counts(watched)) == (plain.tick, counts(plain))
    assert watched.digest() == plain.digest()


def test_programs_outside_of_the_mask_are_not_announced() -> None:
    card = counting(0, 1, 15)
    seen = Seen()
    card.announce_lines(1 << 1 | 1 << 15, seen)
    card.advance(500)
    assert {program for program, _ in seen} == {1, 15}


def test_statements_are_counted_anew_in_each_tick_over_all_programs() -> None:
    card = counting(0, 1)
    card.announce_lines(0xFFFF, always)
    places: dict[int, list[int]] = {}
    for _ in range(100):
        card.advance(1000)
        assert card.within == card.next_statement
        places.setdefault(card.lived_tk, []).append(card.within)
    whole = list(places.values())[1:-1]
    assert all(found[0] == 1 for found in whole)
    assert all(found == sorted(set(found)) and found[-1] <= 10 for found in whole)
    assert any({2, 3} & set(found) for found in whole)


def test_without_a_stop_within_a_tick_a_card_is_between_ticks() -> None:
    card = counting(0)
    seen = Seen()
    card.announce_lines(1, seen)
    card.advance(20)
    assert seen
    assert card.within == 0
    card.announce_lines(1, always)
    card.advance(100)
    assert card.within
    before = card.lived_tk
    card.announce_lines()
    card.advance()
    assert (card.within, card.lived_tk) == (0, before)


def test_a_stop_within_a_tick_ends_until_before_its_flag_has_come() -> None:
    card = counting(0)
    card.announce_lines(1, always)
    assert not card.until(130, timeout_s=1.0)
    assert card.within


def test_lines_that_run_unannounced_do_not_hide_the_next_one() -> None:
    card = counting(0)
    for ticks in range(3, 12):
        card.announce_lines(1, always)
        card.advance(100)
        card.announce_lines()
        card.advance(ticks)
        before = counts(card)
        card.announce_lines(1, always)
        card.advance(100)
        assert (bool(card.within), counts(card)) == (True, before)


def test_a_program_that_starts_again_has_its_first_line_announced_again() -> None:
    card = counting(0)
    seen = Seen(10)
    card.announce_lines(1, seen)
    while not card.within:
        card.advance(100)
    card.send("HALT PROG0\rRUN PROG0\r")
    seen.clear()
    card.advance(100)
    assert seen == [(0, 10)]


def test_within_a_tick_there_is_no_snapshot() -> None:
    card = counting(0)
    card.announce_lines(1, always)
    card.advance(100)
    with pytest.raises(StoreError, match="complete the tick first"):
        card.snapshot()
    card.announce_lines()
    card.advance()
    card.snapshot()


def test_after_a_return_to_a_snapshot_lines_are_announced_from_there() -> None:
    card = counting(0)
    kept = card.snapshot()
    seen = Seen(0)
    card.announce_lines(1, seen)
    card.advance(100)
    first = list(seen)
    card.restore(kept)
    assert card.within == 0
    seen.clear()
    card.advance(100)
    assert seen == first


def test_what_enters_within_a_tick_is_replayed_there(tmp_path: Path) -> None:
    card = counting(0)
    path = tmp_path / "a.journal"
    card.recorder = Recorder(card, path)
    card.announce_lines(1, lambda program, line: line == 20)
    for value in (100.0, 200.0):
        card.advance(1000)
        card.p[1] = value
        card.p[0] = value
        card.advance(0)  # the rest of the tick
    card.p[0] = card.p[0] + 0.5  # after it
    card.announce_lines()
    card.advance(3000)
    card.close()
    journal = read_journal(path)
    places = [each for each in journal.entries if each.what is Entered.WITHIN]
    assert [bool(each.number) for each in places] == [True, True, False]
    again = Replay(journal)
    again.run()
    assert again.difference is None
    assert again.equal >= 2
    assert counts(again.card) == counts(card)


def test_an_entry_before_a_line_that_does_not_come_is_damage() -> None:
    card = counting(0)
    tick = card.lived_tk + 5
    with pytest.raises(StoreError, match=rf"no line begins at statement 900 of tick {tick}"):
        Player(card).play(JournalEntry(tick, Entered.WITHIN, 900))
