"""What is the same on both sides of a channel."""

import pytest

from openacr.basic.channels.channel_words import ECHO_BITS, MODE_BITS
from openacr.channels import CHANNELS, BinaryMode, StreamKind, startup_mode
from openacr.models import MODELS


@pytest.mark.parametrize(
    ("channel", "mode"),
    [("COM1", 1), ("COM2", 1), ("STREAM2", 0), ("DPCB", 0), ("FIFO", 0), ("STREAM1", 0)],
)
def test_only_serial_channels_start_with_control_prefixing(channel: str, mode: int) -> None:
    assert startup_mode(channel) == mode
    assert isinstance(startup_mode(channel), BinaryMode)


def test_channels_are_those_of_a_model_and_of_one_kind_each() -> None:
    names = [name for of_kind in CHANNELS.values() for name in of_kind]
    assert len(names) == len(set(names))
    assert set(names) <= set(MODELS["ACR8020"].streams)
    assert StreamKind.PACKETS not in CHANNELS


def test_every_mode_bit_has_a_place_in_the_words_of_a_channel() -> None:
    assert (ECHO_BITS, MODE_BITS) == (0b111, 0b11)
