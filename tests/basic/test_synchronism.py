"""SYNC: moves of several masters begin and end together."""

from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level

MOVING = (516, 548)  # In Motion of masters 0 and 1
MANUAL, LOADED = 2065, 2067


def bench(*lines: str) -> Bench:
    """Master 0 with X, master 1 with Y, in pulses."""
    made = Bench("X")
    made.attach(1, (1, "Y"))
    profile = ("ACC 1000 DEC 1000 STP 1000 VEL 500", "MBUF ON")
    made.at(Level.PROG, 1).all("PPU Y1", *profile)
    return made.at(Level.PROG, 0).all("PPU X1", *profile, "SYNC ON MASTER0 MASTER1", *lines)


def begin(made: Bench, x: str, y: str) -> None:
    """Give a move to either master."""
    made.at(Level.PROG, 1).all(y)
    made.at(Level.PROG, 0).all(x)


def course(made: Bench, limit: int = 20000) -> list[tuple[bool, bool]]:
    """Whether X and Y have moved in each tick, until nothing does any more."""
    found = []
    place = (made.psp(0), made.psp(1))
    for _ in range(limit):
        made.ticks(1)
        now = (made.psp(0), made.psp(1))
        found.append((now[0] != place[0], now[1] != place[1]))
        place = now
        if not any(made.bit(flag) for flag in MOVING):
            return found
    raise AssertionError("still moving")


def test_chains_of_moves_begin_together_again() -> None:
    made = bench()
    made.at(Level.PROG, 1).all("Y100", "Y200", "Y300")
    made.at(Level.PROG, 0).all("X500", "X510", "X2000")
    moved = course(made)
    assert all(x == y for x, y in moved)
    assert (made.psp(0), made.psp(1)) == (2000, 300)


def test_a_move_alone_waits() -> None:
    made = bench()
    made.all("X100")
    assert made.at(Level.PROG, 0).ticks(2000).psp(0) == 0
    made.all("SYNC OFF MASTER1")
    made.until_clear(516)
    assert made.psp(0) == 100


def test_mdi_waits_for_a_cycle_start_of_any_master() -> None:
    made = bench("SYNC MDI")
    assert made.bit(MANUAL)
    assert made.bit(MANUAL + 32)
    begin(made, "X100", "Y1000")
    made.ticks(500)
    assert made.bit(LOADED)
    assert (made.psp(0), made.psp(1)) == (0, 0)
    made.all("SET 553")  # cycle start of master 1
    assert all(x == y for x, y in course(made))
    assert (made.psp(0), made.psp(1)) == (100, 1000)
    made.all("SYNC PROG")
    assert not made.bit(MANUAL)


def test_a_kill_of_one_drops_what_waits_in_all() -> None:
    made = bench("SYNC MDI")
    begin(made, "X100", "Y1000")
    made.ticks(2).all("SET 522").ticks(2)
    assert not any(made.bit(flag) for flag in MOVING)
    made.all("CLR 522", "SYNC PROG").ticks(100)
    assert (made.psp(0), made.psp(1)) == (0, 0)
    begin(made, "X5", "Y5")
    course(made)
    assert (made.psp(0), made.psp(1)) == (5, 5)


def test_report_and_refusals() -> None:
    made = bench()
    assert made.type("SYNC") == "MASTER0 MASTER1"
    assert made.type("SYNC ON MASTER12") == "Invalid argument"
    assert made.type("SYNC ON X") == "Syntax error"
    made.all("SYNC OFF MASTER0")
    assert made.type("SYNC") == "MASTER1"
    made.all("SYNC OFF")
    assert made.type("SYNC") == "OFF"
