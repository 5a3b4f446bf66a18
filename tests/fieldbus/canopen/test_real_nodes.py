"""The card's network with nodes on a bus of the computer: what it finds, exchanges, and misses."""

import pytest
from tests.fieldbus.canopen.can_rig import OnCan
from tests.network.rig import (
    DI,
    DO,
    FAILED,
    HW_OVERFLOW,
    NODE_FAILURE,
    OPERATIONAL,
    RESET,
    STATE,
    SW_OVERFLOW,
    fault,
    node,
)

from openacr.fieldbus.canopen.frames import Cob, Frame, Trouble
from openacr.fieldbus.canopen.io_node import Kind
from openacr.map.rows import bus_nodes, network_slaves

PANEL = node(3, digital_inputs=12, digital_outputs=12, analog_inputs=2, analog_outputs=2)
BIG = node(3, digital_inputs=200, digital_outputs=130, analog_inputs=18, analog_outputs=17)


@pytest.mark.parametrize("health", ["heartbeat", "guarding"])
def test_a_node_is_found_and_exchanges_all_its_signals(health: str) -> None:
    on = OnCan(node(3, digital_inputs=12, digital_outputs=12, analog_inputs=2, analog_outputs=2,
                    health=health, analog_values=[5.0, -10.0]))  # fmt: skip
    assert on.start(3) == 2
    card = on.card
    assert [card.p[33025 + n] for n in range(6)] == [2, 2, 2, 2, 1 + (health == "guarding"), 1]
    on.level(11, True)
    card.bit[DO[0] + 9], card.p[33280], card.p[33296] = True, 2.5, -10.0
    card.advance(seconds=0.1)
    assert [card.bit[DI[0] + n] for n in range(12)] == [False] * 11 + [True]
    assert on.output(9) and not on.output(8)
    assert [on.converted(n) for n in range(2)] == [8192, -32768]
    assert card.p[33288] == pytest.approx(5.0, abs=4e-4) and card.p[33304] == -10.0
    card.advance(seconds=5.0)
    assert (card.p[STATE], card.bit[NODE_FAILURE], card.bit[OPERATIONAL]) == (2, False, True)


def test_a_big_node_uses_more_process_data_than_the_first_four() -> None:
    on = OnCan(BIG)
    assert on.start(3, cycle_ms=50) == 2
    card = on.card
    on.level(199, True)
    card.bit[DO[0] + 129], card.p[33280 + 16 * 16] = True, 5.0
    on.far[0].memory.F[bus_nodes.measured[0] + 17] = 10.0
    card.advance(seconds=0.2)
    assert card.bit[DI[0] + 199] and on.output(129)
    assert on.converted(16) == 16384
    assert card.p[33288 + 16 * 17] == 10.0


def test_inputs_that_are_on_at_the_start_are_seen_without_a_change() -> None:
    on = OnCan(PANEL)
    on.level(4, True)
    on.wire.passed_on = lambda frame: [] if frame.id == Cob.INPUTS + 3 else [frame]
    assert on.start(3) == 2
    on.card.advance(seconds=0.1)
    assert on.card.bit[DI[0] + 4]


def test_without_leave_no_output_is_sent() -> None:
    on = OnCan(PANEL, is_real=False)
    assert on.start(3) == 2
    on.card.bit[DO[0]] = True
    on.level(0, True)
    on.card.advance(seconds=0.2)
    assert on.card.bit[DI[0]] and not on.output(0)
    assert not [frame for frame in on.wire.sent if frame.id in (0x203, 0x303)]


def test_real_and_modelled_nodes_are_on_one_network() -> None:
    on = OnCan(node(7, modelled=True, digital_inputs=8, digital_outputs=8) + PANEL, far=PANEL)
    assert on.start(3, 7) == 2
    card = on.card
    on.level(1, True)
    card.set_input(DI[0] + 2, True)  # node 0 of the file is slave 1 of the card
    card.bit[DO[0]], card.bit[DO[1] + 5] = True, True
    card.advance(seconds=0.1)
    assert card.bit[DI[0] + 1] and card.bit[DI[1] + 2]
    assert on.output(0) and not on.output(5)


# what goes wrong


@pytest.mark.parametrize(
    ("far", "table", "said"),
    [
        ("", "", "no answer in 0.5 s"),
        (PANEL, "vendor = 5\n", "has vendor 0xACC, machine.toml says 0x5"),
        (PANEL, "serial = 4\n", "has serial 0x3, machine.toml says 0x4"),
    ],
)
def test_a_missing_or_wrong_node_ends_the_start_with_state_5(
    far: str, table: str, said: str, caplog: pytest.LogCaptureFixture
) -> None:
    on = OnCan(PANEL + table, far=far)
    assert on.start(3) == 5
    assert on.card.bit[FAILED] and not on.card.bit[OPERATIONAL]
    assert f"node 3: object 0x1000:0: {said}" in caplog.text or f"node 3: it {said}" in caplog.text
    assert on.card.p[33030] == 0


def test_a_drive_is_no_io_node(caplog: pytest.LogCaptureFixture) -> None:
    on = OnCan(PANEL)
    on.far[0].nodes[0].objects.values[0x1000, 0] = (402).to_bytes(4, "little")
    assert on.start(3) == 5
    assert "it is no I/O node: device type 0x00000192" in caplog.text


def test_another_bit_rate_than_that_of_the_interface_is_said(
    caplog: pytest.LogCaptureFixture,
) -> None:
    on = OnCan(PANEL)
    assert on.start(3, bit_rate=500) == 5
    assert "CAN can0 has 125 kbit/s, P32769 is 500" in caplog.text
    assert on.start(3) == 2


def test_two_nodes_with_one_id_are_noticed(caplog: pytest.LogCaptureFixture) -> None:
    on = OnCan(PANEL)
    on.far.append(on.add(PANEL))
    assert on.start(3) == 5
    assert "more than one node answers for id 3" in caplog.text


@pytest.mark.parametrize(("times", "state"), [(3, 2), (4, 5)])
def test_a_repeated_or_late_answer_is_no_second_node(times: int, state: int) -> None:
    on = OnCan(PANEL)
    repeated = iter([True] * times)
    answers: list[Frame] = []

    def twice(frame: Frame) -> list[Frame]:
        if frame.id != Cob.SDO_ANSWER + 3:
            return [frame]
        answers.append(frame)
        return [frame, answers[0]] if len(answers) % 5 == 4 and next(repeated, False) else [frame]

    on.wire.passed_on = twice
    assert on.start(3) == state


def test_an_abort_of_another_object_ends_nothing() -> None:
    on = OnCan(PANEL)
    abort = Frame(Cob.SDO_ANSWER + 3, bytes.fromhex("8000200000000206"))
    answers = [0]

    def also(frame: Frame) -> list[Frame]:
        answers[0] += frame.id == abort.id
        return [abort, frame] if frame.id == abort.id and answers[0] in (1, 7) else [frame]

    on.wire.passed_on = also
    assert on.start(3) == 2


def test_a_node_that_answers_everything_slowly_is_given_up(
    caplog: pytest.LogCaptureFixture,
) -> None:
    on = OnCan(PANEL)
    late: list[tuple[float, Frame]] = []

    class Slow:
        def attend(self) -> None:
            while late and late[0][0] <= on.card.time_s:
                on.link.waiting.append(late.pop(0)[1])

    def slowly(frame: Frame) -> list[Frame]:
        if frame.id != Cob.SDO_ANSWER + 3:
            return [frame]
        late.append((on.card.time_s + 0.45, frame))
        return []

    on.wire.passed_on = slowly
    on.far.append(Slow())  # type: ignore[arg-type]
    begin_s = on.card.time_s
    assert on.start(3) == 5
    assert 10.0 < on.card.time_s - begin_s < 10.1
    assert "node 3: it has not answered everything in 10 s" in caplog.text


def test_a_node_is_set_up_whatever_it_was_set_to_before() -> None:
    on = OnCan(PANEL)
    values = on.far[0].nodes[0].objects.values
    delivered = dict(values)
    values[0x1A00, 1] = (0x60000208).to_bytes(4, "little")  # the second byte twice
    values[0x1801, 1] = (0x283 | 1 << 30 | 1 << 31).to_bytes(4, "little")
    values[0x1801, 2] = b"\xff"
    values[0x1400, 2] = b"\xff"
    assert on.start(3) == 2
    assert values[0x1A00, 1] == delivered[0x1A00, 1]
    assert values[0x1801, 1] == (0x283 | 1 << 30).to_bytes(4, "little")
    assert (values[0x1801, 2], values[0x1400, 2]) == (b"\1", b"\1")


def test_a_node_with_more_than_a_card_takes_is_state_4() -> None:
    on = OnCan(PANEL)
    on.far[0].nodes[0].objects._counts[Kind.DIGITAL_INPUTS] = 200
    assert on.start(3) == 4


def test_times_that_a_node_cannot_hold_are_the_longest() -> None:
    on = OnCan(PANEL)
    assert on.start(3, cycle_ms=20_000) == 2
    values = on.far[0].nodes[0].objects.values
    assert values[0x1017, 0] == b"\xff\xff"
    assert values[0x1016, 1] == (5 << 16 | 65535).to_bytes(4, "little")


def test_an_input_that_changes_while_inputs_are_read_keeps_its_new_level() -> None:
    on = OnCan(PANEL)
    on.level(0, True)
    changed = [False]

    def change(frame: Frame) -> list[Frame]:
        if frame.id == Cob.SDO_ANSWER + 3 and frame.data[1:4] == b"\x00\x60\x01" and not changed[0]:
            changed[0] = True
            return [frame, Frame(Cob.INPUTS + 3, b"\0\2")]
        return [] if frame.id == Cob.INPUTS + 3 else [frame]

    on.wire.passed_on = change
    assert on.start(3) == 2
    on.card.advance(seconds=0.2)
    assert changed[0]
    assert [n for n in range(12) if on.card.bit[DI[0] + n]] == [9]


def test_a_slave_that_was_modelled_before_is_not_looked_for_in_rows() -> None:
    on = OnCan(node(7, modelled=True, digital_inputs=8) + PANEL, far=PANEL)
    assert on.start(7) == 2
    assert on.start(3) == 2
    assert on.card.memory.I[network_slaves.words[0]] == 0


def test_a_node_that_never_reports_health_is_dead_in_the_first_period(
    caplog: pytest.LogCaptureFixture,
) -> None:
    on = OnCan(PANEL)
    on.wire.passed_on = lambda frame: [] if frame.id == Cob.HEALTH + 3 else [frame]
    assert on.start(3) == 2
    assert on.card.until(NODE_FAILURE, timeout_s=0.21)
    assert "node 3: it reports no health" in caplog.text


def test_the_master_reports_health_only_while_it_serves_nodes() -> None:
    on = OnCan(PANEL, far="")
    assert on.start(3) == 5
    on.wire.sent.clear()
    on.card.advance(seconds=1.0)
    assert on.wire.sent == []


def test_one_frame_that_is_not_taken_is_counted_once() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.link.takes = False
    on.card.advance(seconds=0.02)
    on.link.takes = True
    on.card.advance(seconds=5.0)
    assert on.card.p[STATE] == 2


def test_a_controller_that_is_off_is_opened_anew_at_the_next_start() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.link.now = Trouble(errors=256)
    on.card.advance(seconds=0.05)
    assert on.card.p[STATE] == 10
    assert on.start(3) == 2
    assert on.link.now.errors == 0


@pytest.mark.parametrize("health", ["heartbeat", "guarding"])
@pytest.mark.parametrize("kind", ["silent", "lost"])
def test_a_node_that_is_pulled_is_dead_within_two_health_periods_and_comes_back(
    kind: str, health: str, caplog: pytest.LogCaptureFixture
) -> None:
    two = (
        f"{node(3, digital_inputs=8, digital_outputs=8, health=health)}{node(4, digital_inputs=8)}"
    )
    on = OnCan(two, far=two + fault(kind, node=3, at_s=2.0, until_s=4.0))
    assert on.start(3, 4, cycle_ms=20) == 2
    card = on.card
    card.bit[DO[0]] = True
    card.advance(seconds=2.0 - card.time_s)
    assert (card.p[STATE], card.bit[NODE_FAILURE]) == (2, False)
    assert card.until(NODE_FAILURE, timeout_s=0.4)
    assert (card.p[STATE], card.p[33030], card.p[33046]) == (7, 0, 1)
    assert "node 3: it reports no health" in caplog.text
    on.level(2, True, node=1)
    card.advance(seconds=0.1)
    assert card.bit[DI[1] + 2], "the other node continues"
    card.advance(seconds=4.1 - card.time_s)
    assert card.p[STATE] == 7, "only a start brings it back"
    assert on.start(3, 4) == 2
    card.advance(seconds=0.1)
    assert on.output(0) and not card.bit[NODE_FAILURE]


@pytest.mark.parametrize(
    ("command", "said"),
    [(0x81, "it has begun anew"), (0x80, "it is pre-operational"), (0x02, "it is stopped")],
)
def test_a_node_that_is_not_operational_is_dead(
    command: int, said: str, caplog: pytest.LogCaptureFixture
) -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.wire.carry(Frame(Cob.NMT, bytes((command, 3))))
    assert on.card.until(NODE_FAILURE, timeout_s=0.4)
    assert f"node 3: {said}: it is dead until the next start" in caplog.text


def test_the_master_is_seen_by_its_nodes_twice_in_a_health_period() -> None:
    on = OnCan(PANEL)
    assert on.start(3, cycle_ms=20) == 2
    assert on.far[0].nodes[0].objects.values[0x1016, 1] == (5 << 16 | 300).to_bytes(4, "little")
    on.wire.sent.clear()
    on.card.advance(seconds=1.0)
    assert on.wire.sent.count(Frame(0x705, b"\5")) == 10
    assert on.wire.sent.count(Frame(Cob.SYNC)) == 50


@pytest.mark.parametrize("errors", [96, 256])
def test_what_the_controller_reports_is_a_warning_or_the_end(errors: int) -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    card = on.card
    on.link.now = Trouble(errors=errors)
    card.advance(seconds=0.05)
    assert (card.p[STATE], card.bit[OPERATIONAL]) == (6 if errors == 96 else 10, False)
    on.link.now = Trouble()
    card.advance(seconds=1.0)
    assert card.p[STATE] == (2 if errors == 96 else 10)
    assert on.start(3) == 2


def test_frames_that_the_bus_does_not_take_lead_to_a_warning_and_bus_off() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.link.takes = False
    seen = []
    for _ in range(2000):
        on.card.advance(1)
        if on.card.p[STATE] not in seen:
            seen.append(int(on.card.p[STATE]))
    assert seen in ([2, 6, 10], [2, 6, 7, 10])
    on.link.takes = True
    assert on.start(3) == 2


def test_an_interface_that_is_gone_is_tried_again_at_each_start(
    caplog: pytest.LogCaptureFixture,
) -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.link.now = Trouble(failure="No such device")
    on.link.takes, on.link.reopening = False, "no such device"
    on.card.advance(seconds=0.05)
    assert on.card.p[STATE] == 10
    assert caplog.text.count("CAN can0: No such device") == 1
    assert on.start(3) == 8 and on.card.bit[FAILED]
    on.link.reopening = ""
    assert on.start(3) == 2


@pytest.mark.parametrize(
    ("trouble", "flag"),
    [(Trouble(lost=3), SW_OVERFLOW), (Trouble(is_overrun=True), HW_OVERFLOW)],
)
def test_lost_frames_set_their_flag(trouble: Trouble, flag: int) -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    assert not on.card.bit[SW_OVERFLOW] and not on.card.bit[HW_OVERFLOW]
    on.link.now = trouble
    on.card.advance(seconds=0.02)
    assert [bit for bit in (SW_OVERFLOW, HW_OVERFLOW) if on.card.bit[bit]] == [flag]
    assert on.card.p[STATE] == 2


def test_frames_of_others_and_wrong_ones_change_nothing() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    before = [on.card.p[number] for number in range(33024, 33031)]
    for identifier in range(0x800):
        if identifier not in (Cob.NMT, 0x183, 0x283, 0x703, 0x203, 0x303, 0x603):
            on.wire.carry(Frame(identifier, bytes(8)))
    for identifier in (0x183, 0x283, 0x703, 0x583, 0x83):
        on.wire.carry(Frame(identifier))
        on.wire.carry(Frame(identifier, is_remote=True))
    on.card.advance(seconds=1.0)
    assert [on.card.p[number] for number in range(33024, 33031)] == before
    assert on.card.p[STATE] == 2


def test_a_running_network_listens_to_its_nodes_alone_and_a_start_to_all() -> None:
    on = OnCan(PANEL + node(4, digital_inputs=8))
    assert on.start(3, 4) == 2
    assert on.link.heard == {0x83, 0x583, 0x703, 0x183, 0x283, 0x84, 0x584, 0x704, 0x184}
    assert on.start(4) == 2
    assert on.link.heard == {0x84, 0x584, 0x704, 0x184}
    on.card.bit[RESET] = True
    on.card.advance(seconds=0.1)
    assert on.link.heard is None


def test_a_card_that_is_restarted_starts_its_nodes_anew() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.card.send("SYS\rREBOOT\r")
    on.card.advance(seconds=0.3)
    assert on.card.p[STATE] == 1
    assert on.start(3) == 2
    on.level(1, True)
    on.card.advance(seconds=0.1)
    assert on.card.bit[DI[0] + 1]


def test_an_emergency_is_said_once(caplog: pytest.LogCaptureFixture) -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    for _ in range(5):
        on.wire.carry(Frame(0x83, bytes.fromhex("3081110000000000")))
    on.card.advance(seconds=0.1)
    assert caplog.text.count("node 3: it reports emergency 0x8130") == 1
    on.wire.carry(Frame(0x83, bytes(8)))  # its end
    on.wire.carry(Frame(0x83, bytes.fromhex("3081110000000000")))
    on.card.advance(seconds=0.1)
    assert caplog.text.count("it reports emergency") == 2


def test_at_the_end_the_nodes_begin_anew_with_their_outputs_off() -> None:
    on = OnCan(PANEL)
    assert on.start(3) == 2
    on.card.bit[DO[0]] = True
    on.card.advance(seconds=0.1)
    assert on.output(0)
    on.nodes.close()
    on.attend(0)
    assert not on.output(0)
