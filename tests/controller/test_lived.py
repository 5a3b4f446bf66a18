"""The time of a card: ticks since power-up, and those that it has run in total."""

from openacr.controller import Controller


def test_restarts_do_not_reset_the_ticks_that_a_card_has_run() -> None:
    card = Controller()
    seen = []
    for ticks in (10, 20, 30):
        card.advance(ticks)
        seen.append((card.tick, card.lived_tk))
        card.send("SYS\rREBOOT\r")
        seen.append((card.tick, card.lived_tk))
    assert seen == [(10, 10), (0, 10), (20, 30), (0, 30), (30, 60), (0, 60)]
    card.advance(4)
    assert (card.time_s, card.clock.lived_s) == (4 * card.period_s, 64 * card.period_s)


def test_a_snapshot_keeps_the_ticks_before_restarts() -> None:
    card = Controller()
    card.advance(7)
    card.send("SYS\rREBOOT\r")
    card.advance(5)
    snapshot = card.snapshot()
    card.send("SYS\rREBOOT\r")
    card.restore(snapshot)
    assert (card.tick, card.lived_tk) == (5, 12)


def test_a_time_is_the_nearest_number_of_ticks_and_one_at_least() -> None:
    clock = Controller().clock
    period_s = clock.period_s
    assert [clock.ticks(n * period_s) for n in (0.0, 0.4, 1.4, 1.6, 1000.0)] == [1, 1, 1, 2, 1000]
