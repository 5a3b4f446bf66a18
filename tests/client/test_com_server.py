"""Hosts written for ComACRServer move to the client by its names."""

import pytest

from openacr.client.com_server import IP, OFFLINE, USB, ComACRServer
from openacr.client.errors import ClientError
from openacr.controller import Controller

SETUP = (
    "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"',
    "PPU X1000 Y1000", "ACC 100 DEC 100 STP 100 VEL 10", "DRIVE ON X Y",
)  # fmt: skip


@pytest.fixture
def channel() -> ComACRServer:
    channel = ComACRServer()
    channel.bstrIP = Controller()
    channel.Connect(IP)
    channel.Write("".join(f"{line}\r" for line in ("DIM P(100)", *SETUP)))
    channel.Read()
    return channel


def test_a_connection_is_made_tested_and_ended() -> None:
    channel = ComACRServer()
    assert channel.isOffline
    assert not channel.TestConnect()
    with pytest.raises(ClientError, match=r"Connect\(3\)"):
        channel.SetFlag(128, True)
    with pytest.raises(ClientError, match="transport 4: known are 0 offline, 2 serial and 3 IP"):
        channel.Connect(USB)
    channel.bstrIP = Controller()
    channel.Connect(IP, 0)
    assert not channel.isOffline
    assert channel.TestConnect()
    channel.Connect(OFFLINE)
    assert channel.isOffline


def test_flags_parameters_and_variables_are_set_and_read(channel: ComACRServer) -> None:
    channel.SetFlag(128, True)
    channel.SetFlag(129, True)
    channel.SetFlag(129, False)
    channel.SetParmLong(4096, 5)
    channel.SetParmLongMask(4096, 1, 8)
    channel.SetParmFloat(12348, 2.5, True)
    channel.SetGlobal(0, 7, 1.25)
    channel.SetFOV(0b101, 0.5)
    channel.SetROV(0b10, 0.25)
    assert [channel.card.bit[flag] for flag in (128, 129)] == [True, False]
    assert channel.GetACRCustom("P4096, p12348,P7") == [12, 2.5, 1.25]
    assert channel.card.master(2).read("feedrate override") == 0.5
    assert channel.card.master(1).read("rapid feedrate override") == 0.25
    assert channel.card.master(1).read("feedrate override") == 1.0
    with pytest.raises(ClientError, match="33 parameters, at most 32"):
        channel.GetACRCustom(",".join(["P0"] * 33))


def test_moves_are_absolute_or_relative_and_stop(channel: ComACRServer) -> None:
    channel.Move(0b11, [2.0, 1.0])
    channel.card.pause(2.0)
    assert channel.GetACRCustom("P12288,P12544") == [2000, 1000]
    channel.bMoveAbsolute, channel.fMoveVEL = False, 1.0
    channel.Move(0b10, [5.0])
    channel.card.pause(1.0)
    (place,) = channel.GetACRCustom("P12544")
    assert 1800 < place < 2100, "at VEL 1"
    channel.Stop()
    channel.card.pause(1.0)
    assert not channel.card.bit[516]
    (place,) = channel.GetACRCustom("P12544")
    assert place < 2300
    with pytest.raises(ValueError, match="zip"):
        channel.Move(0b11, [1.0])


def test_text_is_answered_with_its_echo_and_errors(channel: ComACRServer) -> None:
    channel.Write("?P0\r?P1\r\n")
    assert channel.Read() == "?P0\r\n0\r\n?P1\r\n0\r\n"
    assert channel.Read() == ""
    channel.Write("XYZZY\r")
    assert channel.Read() == "XYZZY\r\nUnknown command\r\n"
