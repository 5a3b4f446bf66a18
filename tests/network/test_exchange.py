"""Data between the card and its nodes: digital on change, the rest once a cycle."""

import pytest
from tests.network.rig import (
    DI,
    DO,
    HW_OVERFLOW,
    PANEL,
    SW_OVERFLOW,
    converted,
    fault,
    node,
    output,
    running,
)

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.rows import network_master
from openacr.plant.bus import terminals

SYNC = network_master.sync_tk
MESSAGE_S = 0.001  # 125 bits at 125 kbit/s


def wait_for_sync(made: Controller) -> None:
    """Live until the next synchronisation is over."""
    made.advance(int(made.memory.F[SYNC]) - made.tick)


@pytest.mark.req("ACR-CAN-17")
def test_a_digital_input_travels_at_once_and_only_when_it_changes() -> None:
    made = running(cycle_ms=500)
    wait_for_sync(made)
    made.set_input(DI[0] + 3, True)
    before = made.tick
    assert made.until(DI[0] + 3, timeout_s=0.1)
    assert MESSAGE_S <= (made.tick - before) * made.period_s <= MESSAGE_S + 0.001
    made.p[4456] = 0
    made.advance(seconds=2.0)
    assert made.p[4456] == 0, "what has not changed is not sent again"
    made.set_input(DI[0], True)
    made.advance(seconds=0.01)
    assert made.p[4456] == 0b1001


@pytest.mark.req("ACR-CAN-17")
def test_an_input_that_changes_while_it_is_on_its_way_is_sent_again() -> None:
    made = running()
    made.set_input(DI[0], True)
    made.advance(1)
    made.set_input(DI[0], False)
    levels = []
    for _ in range(10):
        made.advance(1)
        levels.append(made.bit[DI[0]])
    assert levels.count(True) > 0 and not levels[-1]


@pytest.mark.req("ACR-CAN-17")
def test_outputs_are_put_out_with_the_synchronisation() -> None:
    made = running(cycle_ms=100)
    wait_for_sync(made)
    made.bit[DO[0] + 1] = True
    made.p[33280] = 5.0
    made.advance(seconds=0.099)
    assert (output(made, 0, 1), converted(made, 0, 0)) == (False, 0)
    made.advance(seconds=0.002)
    assert (output(made, 0, 1), converted(made, 0, 0)) == (True, 16384)


@pytest.mark.req("ACR-CAN-17")
def test_analog_inputs_are_latched_by_the_synchronisation_in_each_cycle() -> None:
    made = running(cycle_ms=100)
    made.set_analog(33288, 4.0)
    wait_for_sync(made)
    made.set_analog(33288, 6.0)
    made.advance(seconds=0.05)
    assert made.p[33288] == pytest.approx(4.0, abs=0.001)
    made.p[33288] = 0.0
    made.advance(seconds=0.1)
    assert made.p[33288] == pytest.approx(6.0, abs=0.001)


@pytest.mark.req("ACR-CANIO-02", "ACR-CANIO-01")
@pytest.mark.parametrize("slave", range(4))
def test_each_node_has_its_own_blocks(slave: int) -> None:
    """Inputs of node n begin at P4456 + 32 n, outputs sixteen words later."""
    full = {"digital_inputs": 512, "digital_outputs": 512, "coupler": "PIO-337"}
    empty = "".join(node(10 + n) for n in range(4) if n != slave)
    ids = [10 + n for n in range(4)]
    made = running(empty + node(10 + slave, **full), *ids)
    place = 3  # of the full node in the world
    for terminal in (0, 31, 32, 511):
        word, bit = 4456 + 32 * slave + terminal // 32, terminal % 32
        made.set_input(DI[place] + terminal, True)
        made.advance(seconds=0.01)
        assert made.memory.I[word] >> bit & 1, f"input {terminal}"
        assert made.bit[DI[slave] + terminal]
        made.bit[32 * (4472 + 32 * slave - 4096) + terminal] = True
        made.advance(seconds=0.06)
        assert output(made, place, terminal), f"output {terminal}"
        assert made.bit[DO[slave] + terminal]


@pytest.mark.req("ACR-CANIO-04")
@pytest.mark.parametrize("slave", range(4))
@pytest.mark.parametrize("channel", [0, 1, 7, 31])
def test_each_analog_channel_has_its_block_of_sixteen(slave: int, channel: int) -> None:
    empty = "".join(node(10 + n) for n in range(4) if n != slave)
    full = node(10 + slave, analog_inputs=32, analog_outputs=32)
    made = running(empty + full, *(10 + n for n in range(4)), cycle_ms=100)
    block = 33280 + 512 * slave + 16 * channel
    made.p[block], made.p[block + 2], made.p[block + 3] = 2.0, 1000.0, 0.5
    made.p[block + 10], made.p[block + 11] = 20.0, -1.0
    made.set_analog(33288 + 512 * 3 + 16 * channel, 5.0)
    made.advance(seconds=0.25)
    assert converted(made, 3, channel) == 2500
    assert made.p[block + 8] == pytest.approx(9.0, abs=0.001)
    assert sum(map(abs, (converted(made, 3, other) for other in range(32)))) == 2500


@pytest.mark.req("ACR-CANIO-05")
@pytest.mark.parametrize("bits", [8, 10, 12, 14, 16])
def test_full_scale_is_that_of_sixteen_bits_for_any_resolution(bits: int) -> None:
    world = node(1, analog_inputs=3, analog_bits=bits, analog_values=[10.0, -10.0, 2.5])
    made = running(world)
    assert terminals.convert_inputs(made.memory, 0)[:2] == [32767, -32768]
    counts = terminals.convert_inputs(made.memory, 0)[2]
    assert counts % 2 ** (16 - bits) == 0
    assert 0 <= 8192 - counts < max(2 ** (16 - bits), 2)
    made.advance(seconds=0.06)
    assert [made.p[33288], made.p[33304]] == [10.0, -10.0]


@pytest.mark.req("ACR-CANIO-05")
def test_a_device_without_negative_values_uses_the_upper_half() -> None:
    world = node(
        1, analog_inputs=3, analog_outputs=1, input_range=[0.0, 10.0],
        output_range=[0.0, 10.0], analog_values=[-3.0, 0.0, 12.0],
    )  # fmt: skip
    made = running(world)
    assert terminals.convert_inputs(made.memory, 0) == [0, 0, 32767]
    made.p[33280] = -5.0
    made.advance(seconds=0.06)
    assert converted(made, 0, 0) == 0


@pytest.mark.req("ACR-CANIO-06")
def test_an_output_is_its_volts_times_the_gain_in_counts() -> None:
    made = running()
    made.p[33280], made.p[33296] = 7.5, -2.5
    made.advance(seconds=0.06)
    assert [converted(made, 0, 0), converted(made, 0, 1)] == [24576, -8192]


@pytest.mark.req("ACR-CANIO-05", "ACR-CANIO-06")
def test_an_output_stays_within_sixteen_bits() -> None:
    made = running()
    made.p[33280], made.p[33296] = 12.0, -12.0
    made.advance(seconds=0.06)
    assert [converted(made, 0, 0), converted(made, 0, 1)] == [32767, -32768]
    assert terminals.output_value(made.memory, 0, 1) == -10.0


@pytest.mark.req("ACR-CAN-21")
@pytest.mark.parametrize(
    ("kind", "flag"), [("software overflow", SW_OVERFLOW), ("hardware overflow", HW_OVERFLOW)]
)
def test_an_overflow_is_shown_and_loses_what_arrived(kind: str, flag: int) -> None:
    made = running(PANEL + fault(kind, at_s=1.0, until_s=1.5))
    made.advance(seconds=1.0 - made.time_s + 0.01)
    made.set_input(DI[0], True)
    made.advance(seconds=0.1)
    assert made.bit[flag] and not made.bit[DI[0]]
    made.advance(seconds=0.5)
    made.set_input(DI[0] + 1, True)
    made.advance(seconds=0.1)
    assert made.p[4456] == 0b11 and made.bit[flag]
    made.bit[11265] = True
    made.advance(seconds=0.4)
    assert not made.bit[flag], "the next start clears it"


def test_nodes_the_machine_does_not_have_are_reported() -> None:
    made = running()
    for flag in (DI[0] + 12, DI[1], DI[3] + 511):
        with pytest.raises(UserError, match=f"input {flag}: no CANopen node"):
            made.set_input(flag, True)
    made.bit[DO[1]] = True
    made.advance(seconds=0.1)
    assert not output(made, 0, 0)


def signal(**keys: object) -> str:
    """A signal in the words of machine.toml."""
    return "\n".join(
        ["[[canopen.signal]]", *(f"{key} = {value}" for key, value in keys.items()), ""]
    )


def test_an_analog_output_can_be_wired_to_an_analog_input() -> None:
    made = running(PANEL + signal(input=33304, output=33280, scale=-0.5, offset=1.0))
    made.p[33280] = 6.0
    made.advance(seconds=0.2)
    assert made.p[33304] == pytest.approx(-2.0, abs=0.001)
    assert made.p[33288] == 0.0


@pytest.mark.parametrize("direction", ["up", "down"])
def test_a_distance_sensor_measures_an_axis(direction: str) -> None:
    motor = (
        "[[axis]]\nnumber = 2\nencoder_lines = 1000\nunits_per_rev = 10.0\ninitial = 50.0\n"
        f'encoder_direction = "{direction}"\n'
        'drive = {mode = "ideal", revs_per_s_per_volt = 25.0}\n'
    )
    sensor = signal(input=33288, axis=2, scale=0.05, offset=0.5)  # 0.05 V per mm
    made = running(node(1, analog_inputs=1) + sensor + motor)
    made.advance(seconds=0.2)
    assert made.p[33288] == pytest.approx(3.0, abs=0.002)
    made.send("AXIS2 OFF\rENC2 MULT 4\r")
    made.drag(2, 4000.0 if direction == "up" else -4000.0)  # a revolution
    made.advance(seconds=0.2)
    assert made.p[33288] == pytest.approx(3.5, abs=0.002)
