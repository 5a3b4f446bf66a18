"""Programs that come in over a serial line: pseudo-terminals stand for the line."""

from itertools import pairwise

import pytest
from tests.mill.sender import Sender
from tests.mill.shop import STEP_S, Shop

from openacr.errors import UserError
from openacr.mill.config.communications import Line
from openacr.mill.run.dripping import FULL, Drip
from openacr.mill.run.handshake import XOFF, XON
from openacr.mill.run.lifecycle import State

END = b"\x1a"


def dripping(sender: Sender, **cells: float) -> tuple[Shop, Drip]:
    shop = Shop(**cells)
    shop.store.write_text(750_000, sender.port)
    drip = Drip(Line.of(shop.store), shop.store)
    shop.runner.run(drip.entries)
    return shop, drip


def lines(first: int, last: int) -> str:
    return "".join(f"G1 X{n / 10:.1f}\n" for n in range(first, last + 1))


def x_of(shop: Shop) -> int:
    return shop.pulses()[0]


@pytest.mark.req("MILL-BEY-DRIP", "MILL-SYS-CTL-DRIPTHR")
@pytest.mark.parametrize("threshold", [40, 10])
def test_a_program_starts_when_enough_of_it_has_arrived(sender: Sender, threshold: int) -> None:
    shop, _ = dripping(sender, P250_116=threshold)
    sender.send("G90 F600\n" + lines(1, threshold))
    shop.pass_time(1.0)
    assert x_of(shop) == 0  # the last line is not known to be whole
    sender.send(lines(threshold + 1, threshold + 2))
    shop.pass_time(0.3)
    assert x_of(shop) > 5000
    sender.send(lines(threshold + 3, 100) + "M2\n")
    shop.until(State.IDLE)
    assert x_of(shop) == 100_000


@pytest.mark.req("MILL-BEY-DRIP-UNDERRUN")
def test_a_sender_who_stalls_stops_the_machine_on_its_path(sender: Sender) -> None:
    shop, _ = dripping(sender, P250_116=5)
    sender.send("G90 F600\n" + lines(1, 31))
    speeds = []
    for _ in range(200):
        shop.pass_time(STEP_S)
        speeds.append(float(shop.controller.axis(0).velocity_ups))
    assert x_of(shop) == 30_000  # all but the line that may go on
    assert shop.runner.state is State.RUN
    assert shop.runner.stream.is_starved
    assert max(abs(b - a) for a, b in pairwise(speeds)) < 100 * STEP_S * 1.1
    sender.send("G1 Y1\n" + lines(32, 60) + "M2\n")
    shop.until(State.IDLE)
    assert shop.pulses() == (60_000, 10_000, 0)
    assert not shop.runner.alarms.active


def test_lines_that_arrive_in_time_make_one_smooth_path(sender: Sender) -> None:
    shop, _ = dripping(sender, P250_116=20)
    sender.send("G90 F120\n" + lines(1, 40))
    shop.pass_time(0.5)
    slowest = 9.0
    for n in range(41, 161):
        sender.send(lines(n, n))
        shop.pass_time(0.04)
        slowest = min(slowest, float(shop.controller.axis(0).velocity_ups))
    assert slowest == pytest.approx(2.0, abs=1e-3)
    sender.send("M2\n")
    shop.until(State.IDLE)


@pytest.mark.req("MILL-BEY-DRIP-END")
@pytest.mark.parametrize("last", [b"M2\n", END, b"G1 Y2\n\x1a", b"M2"])
def test_m2_and_the_end_of_the_transmission_end_the_program(sender: Sender, last: bytes) -> None:
    shop, drip = dripping(sender, P400_101=40)
    sender.send(b"G90 F600\nM12\nG1 X1\nY1\n" + last)
    if last == b"M2":
        shop.pass_time(0.5)
        assert shop.runner.is_busy  # M25 could still come of it
        sender.send(END)
    shop.until(State.IDLE)
    assert shop.pulses() == (10_000, 20_000 if b"Y2" in last else 10_000, 0)
    drip.close()


@pytest.mark.req("MILL-BEY-DRIP")
def test_the_sender_is_held_back_and_let_go_on(sender: Sender) -> None:
    shop, drip = dripping(sender, P250_116=1)
    sender.send("G90 F60\nG4 F5\n")
    block = lines(1, 40)
    sent = 0
    while XOFF not in sender.listen() and sent < 4 * FULL:
        sender.send(block)
        sent += len(block)
        drip.poll()
        shop.pass_time(STEP_S)
    assert sender.listen()[:2] == XON + XOFF
    assert sent < 4 * FULL  # a loaded computer hands bytes over late
    assert drip.is_held_back
    shop.runner.abort()
    shop.until(State.IDLE)


def test_subroutines_loops_and_cycles_work_on_what_has_arrived(sender: Sender) -> None:
    shop, _ = dripping(sender)
    sender.send("G90 F600\nP200=0\nGOTO 30\nN10 G91 G1 X.5\nG90\nRET\nN30 GOSUB 10\n(more)\n")
    shop.pass_time(0.2)
    sender.send("P200=P200+1\nIF P200<4 THEN GOTO 30\nG81 X3 Y1 Z-1 R.1 F600\nG80\nM2\n")
    shop.until(State.IDLE)
    assert shop.pulses() == (30_000, 10_000, 0)
    assert shop.store.read(200) == 4


def test_a_jump_to_what_has_not_arrived_is_an_error(sender: Sender) -> None:
    shop, _ = dripping(sender)
    sender.send("G90 F600\nGOTO 30\nG1 X1\n")
    shop.until(State.ALARM)
    assert "E108" in shop.runner.alarms.active[0].text
    assert x_of(shop) == 0


# --- the line -----------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-COMM-RS232", "MILL-SYS-COMM-APPLY")
def test_the_next_transfer_uses_what_was_saved(sender: Sender) -> None:
    shop = Shop(P750_001=19200, P750_002=7, P750_003=1, P750_004=2, P750_005=0)
    shop.store.write_text(750_000, sender.port)
    with Line.of(shop.store).open() as port:
        found = (port.baudrate, port.bytesize, port.parity, port.stopbits, port.rtscts)
    assert found == (19200, 7, "E", 2, False)
    shop.store.write(750_001, 38400)
    shop.store.write(750_003, 2)
    assert Line.of(shop.store) == Line(sender.port, 38400, 7, "O", 2, 0)


@pytest.mark.req("MILL-SYS-COMM-APPLY")
def test_a_port_that_is_not_there_is_an_error() -> None:
    shop = Shop()
    with pytest.raises(UserError, match="no serial port is configured"):
        Line.of(shop.store).open()
    shop.store.write_text(750_000, "/dev/no-such-port")
    with pytest.raises(UserError, match="cannot open serial port /dev/no-such-port"):
        Drip(Line.of(shop.store), shop.store)
