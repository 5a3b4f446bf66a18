"""MODE 0 to 3: the round trip of every byte."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.channels import BinaryMode
from openacr.protocol.escape import decode, encode

EVERY_BYTE = bytes(range(256))


@pytest.mark.req("BIN-035")
@pytest.mark.parametrize("mode", list(map(BinaryMode, range(4))))
@given(data=st.binary(max_size=60))
def test_what_was_encoded_decodes_to_itself(mode: BinaryMode, data: bytes) -> None:
    assert decode(encode(EVERY_BYTE + data, mode), mode) == EVERY_BYTE + data
