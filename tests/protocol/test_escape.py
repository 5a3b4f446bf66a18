"""MODE 0 to 3: the round trip of every byte."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.channels import BinaryMode
from openacr.protocol.escape import Decoder, encode

EVERY_BYTE = bytes(range(256))


@pytest.mark.req("BIN-035")
@pytest.mark.parametrize("mode", list(map(BinaryMode, range(4))))
@given(data=st.binary(max_size=60))
def test_what_was_encoded_decodes_to_itself(mode: BinaryMode, data: bytes) -> None:
    decoder = Decoder(mode)
    fed = [decoder.feed(byte) for byte in encode(EVERY_BYTE + data, mode)]
    assert bytes(byte for byte in fed if byte is not None) == EVERY_BYTE + data
