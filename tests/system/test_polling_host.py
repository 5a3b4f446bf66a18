"""A host that never leaves SYS: no echo, no prompt, jogs after Ctrl-Y, five queries per poll."""

from tests.controller.hosts import Host

from openacr.controller import Controller
from openacr.plant.describe.schema import exact_world

ENCODER, THEORY, FLAGS, LIMITS = 12290, 12294, 4120, 4600
CTRL_Y = "\x19"
JOG_ACTIVE = 1 << 24


class Poller(Host):
    """The start of the host, and its polls."""

    def __init__(self) -> None:
        super().__init__(Controller(world=exact_world()))
        assert self.send("ECHO 4\r") == "ECHO 4|"
        assert self.type("AXIS0 PPU 1000", "AXIS0 DRIVE ON", "AXIS0 JOG DEC 500.000000") == ""

    def poll(self) -> tuple[int, ...]:
        """Encoder, theory, limits and flags of axis 0: each answer is a number and CR LF."""
        found = []
        for number in (ENCODER, THEORY, LIMITS, FLAGS):
            answer = self.send(f"?P{number}\r")
            assert answer.endswith("|")
            found.append(int(answer[:-1]))
        return tuple(found)


def test_a_relative_and_an_absolute_jog_are_seen_from_start_to_end() -> None:
    host = Poller()
    assert host.send("AXIS0 PPU\r") == "1000|"
    assert host.poll()[:3] == (0, 0, 0)
    assert host.type("AXIS0 JOG ACC 500.000000", "AXIS0 JOG VEL 50.000000") == ""
    assert host.send(f"{CTRL_Y}:AXIS0 JOG INC -1.500000\r") == ""
    assert host.poll()[3] & JOG_ACTIVE
    assert host.card.until(792, False, timeout_s=5)
    host.card.advance(100)
    encoder, theory, limits, flags = host.poll()
    assert (encoder, theory, limits, flags & JOG_ACTIVE) == (-1500, -1500, 0, 0)
    assert host.send(f"{CTRL_Y}:AXIS0 JOG ABS 5.000000\r") == ""
    assert host.card.until(792, False, timeout_s=5)
    host.card.advance(100)
    assert host.poll()[:3] == (5000, 5000, 0)


def test_a_kill_is_lifted_in_the_line_that_jogs() -> None:
    host = Poller()
    host.type("AXIS0 JOG ACC 500.000000", "AXIS0 JOG VEL 50.000000", "SET BIT(8467)")
    refused = host.send("AXIS0 JOG INC 1.000000\r")
    assert refused == "Associated Slave Kill Motion Request Active|"
    assert host.poll()[:2] == (0, 0)
    assert host.send(f"{CTRL_Y}:AXIS0 JOG INC 1.000000\r") == ""
    assert host.card.until(792, False, timeout_s=5)
    host.card.advance(100)
    assert host.poll()[:2] == (1000, 1000)


def test_a_position_is_set_and_later_jogs_are_counted_from_it() -> None:
    host = Poller()
    host.type(
        "AXIS0 JOG ACC 500.000000", "AXIS0 JOG VEL 50.000000", "AXIS0 RES 2.5", "AXIS0 JOG REN"
    )
    assert host.poll()[:2] == (2500, 2500)
    assert host.send(f"{CTRL_Y}:AXIS0 JOG ABS 3.000000\r") == ""
    assert host.card.until(792, False, timeout_s=5)
    host.card.advance(100)
    assert host.poll()[:2] == (3000, 3000)


def test_a_name_of_an_axis_is_unknown_at_the_system_level_and_the_host_tries_again_at_prog0() -> (
    None
):
    host = Poller()
    assert host.send("X1.0\r") == "Unknown command|"
    assert host.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "ACC 500 VEL 50") == ""
    assert host.send("X1.0\r") == ""
    assert host.card.until(516, False, timeout_s=5)
    host.card.advance(100)
    assert host.poll()[:2] == (1000, 1000)
