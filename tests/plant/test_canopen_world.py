"""CANopen nodes in machine.toml: what is refused, and wires to and from their terminals."""

import pytest
from tests.network.rig import DI, DO, card, fault, node, output, start

from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import is_real, real_world


def signal(**keys: object) -> str:
    return "\n".join(
        ["[[canopen.signal]]", *(f"{key} = {value}" for key, value in keys.items()), ""]
    )


def refusal(text: str) -> str:
    with pytest.raises(SourceError) as refused:
        parse_world(text)
    return f"{refused.value}"


@pytest.mark.req("ACR-CAN-01")
@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("".join(node(1 + n) for n in range(5)), "5 nodes are more than 4"),
        (node(1, digital_inputs=513), "a whole number from 0 to 512"),
        (node(1, digital_outputs=513), "a whole number from 0 to 512"),
        (node(1, analog_inputs=33), "a whole number from 0 to 32"),
        (node(1, analog_outputs=33), "a whole number from 0 to 32"),
    ],
)
def test_more_than_the_card_can_have_is_refused(text: str, says: str) -> None:
    assert says in refusal(f"[canopen]\n{text}")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (node(0), "a whole number from 1 to 127"),
        (node(1) + node(1), "two nodes have the id 1"),
        (node(1, bit_rate=300), "bit_rate is 300"),
        (node(1, coupler="PIO-400"), '"PIO-337", "PIO-347"'),
        (node(1, input_range=[-5.0, 10.0]), "it is [0, x] or [-x, x]"),
        (node(1, analog_values=[1.0]), "node 1 has 0 analog inputs"),
        (fault("lost"), "lacks its node"),
        (fault("noise", node=1), "has a node"),
        (node(1) + fault("lost", node=2), "there is no node 2"),
        (node(1) + fault("lost", node=1, at_s=3.0, until_s=2.0), "the fault ends at 2 s"),
        (signal(input=33288, output=33280), "P33288 shows no analog input"),
        (node(1, analog_inputs=1) + signal(input=33288), "one of axis and output"),
        (node(1, analog_inputs=1) + signal(input=33288, axis=0, output=33280), "one of axis and"),
        (node(1, analog_inputs=1) + signal(input=33288, axis=0), "there is no axis 0"),
        (node(1, analog_inputs=1) + signal(input=33288, output=33280), "commands no analog output"),
        (node(1) + "colour = 3\n", "unknown key 'colour'"),
        ("[[wire]]\ninput = 11520\noutput = 32\n", "11520, which is not an input"),
        (node(1, digital_inputs=2) + "[[wire]]\ninput = 11522\noutput = 32\n", "11520 to 11521"),
        (node(1, digital_outputs=2) + "[[wire]]\ninput = 0\noutput = 12034\n", "12032 to 12033"),
    ],
)  # fmt: skip
def test_contradictions_are_refused_with_their_place(text: str, says: str) -> None:
    assert says in refusal(f"[canopen]\n{text}")


def test_a_card_without_canopen_has_no_nodes() -> None:
    text = '[card]\nmodel = "ACR8020"\n[canopen]\n'
    assert "the ACR8020 has no CANopen controller" in refusal(text)


def test_wires_lead_to_inputs_of_nodes_and_from_their_outputs() -> None:
    made = card(
        node(1, digital_inputs=8, digital_outputs=8)
        + "[[wire]]\ninput = 11523\noutput = 40\n"  # an output of the card to the node
        + "[[wire]]\ninput = 5\noutput = 12034\ndelay_s = 0.1\n"  # and one of the node back
        + "[inputs]\non = [11527]\n"
    )
    assert start(made) == 2
    assert made.bit[DI[0] + 7]
    made.bit[40] = True
    made.advance(seconds=0.01)
    assert made.bit[DI[0] + 3]
    made.bit[DO[0] + 2] = True
    made.advance(seconds=0.06)
    assert output(made, 0, 2) and not made.bit[5]
    made.advance(seconds=0.1)
    assert made.bit[5]


def test_a_switch_of_an_axis_can_be_wired_to_a_node() -> None:
    made = card(
        node(1, digital_inputs=4)
        + "[[axis]]\nnumber = 0\nencoder_lines = 1000\nunits_per_rev = 10.0\n"
        + 'drive = {mode = "ideal", revs_per_s_per_volt = 25.0}\n'
        + "home = {between = [5.0, 6.0], input = 11521}\n"
    )
    assert start(made) == 2
    made.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rENC0 MULT 4\rPPU X400\r')
    made.send("AXIS0 PGAIN 0.002441\rACC 100 DEC 100 STP 100 VEL 10\rDRIVE ON X\rX5.5\r")
    assert made.until(11521, timeout_s=3.0)
    assert made.axis(0).actual_u == pytest.approx(5.0, abs=0.1)


def test_an_analog_value_needs_an_input() -> None:
    made = card()
    for parameter in (33288 + 32, 33287, 33800, 12288):
        with pytest.raises(UserError, match="shows no analog input"):
            made.set_analog(parameter, 1.0)
    assert isinstance(made, Controller)


# nodes on a bus of the computer

BUS = '[canopen]\ninterface = "socketcan"\nchannel = "can0"\nbit_rate = 500\n'


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('[canopen]\nchannel = "can0"\n', "has the channel can0 of no interface"),
        ("[canopen]\n" + node(1, modelled=True), "node 1 is modelled, as all nodes are"),
        ("[canopen]\n" + node(1, product=3), "product of node 1 is not checked: it is modelled"),
        (BUS + node(1, modelled=True, serial=3), "serial of node 1 is not checked"),
        (BUS + node(1, bit_rate=125), "node 1 has 125 kbit/s, the bus 500"),
        (BUS.replace("500", "300"), "bit_rate is 300"),
    ],
)
def test_contradictions_of_real_nodes_are_refused(text: str, says: str) -> None:
    assert says in refusal(text)


def test_where_the_bus_is_open_only_modelled_nodes_are_left_and_they_keep_their_places() -> None:
    nodes = node(3, bit_rate=500, digital_inputs=8, analog_inputs=1, analog_outputs=1) + node(
        4, modelled=True, bit_rate=500, digital_inputs=8, analog_inputs=1, analog_outputs=1
    )
    faults = fault("lost", node=3) + fault("lost", node=4, at_s=9.0) + fault("noise")
    signals = "".join(
        signal(input=first, output=last)
        for first, last in ((33288, 33280), (33800, 33280), (33288, 33792), (33800, 33792))
    )
    wires = "".join(
        f"[[wire]]\ninput = {number}\noutput = 32\n" for number in (DI[0] + 2, DI[1] + 3)
    )
    world = parse_world(BUS + nodes + faults + signals + wires)
    real = real_world(world)
    assert is_real(world) and real.canopen is not None
    assert [each.id for each in real.canopen.node] == [0, 4]
    assert [each.node for each in real.canopen.fault] == [4]
    assert [(each.input, each.output) for each in real.canopen.signal] == [(33800, 33792)]
    assert [wire.input for wire in real.wire] == [DI[1] + 3]
    made = Controller("ACR9000", world=real)
    made.set_input(DI[1], True)
    with pytest.raises(UserError, match="no CANopen node of the machine has it"):
        made.set_input(DI[0], True)


def test_without_an_interface_nothing_is_real() -> None:
    world = parse_world("[canopen]\n" + node(3, digital_inputs=8))
    assert not is_real(world) and real_world(world).canopen == world.canopen
