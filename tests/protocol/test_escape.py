"""MODE 0 to 3: the worked examples of the manual and the round trip of every byte."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.channels import BinaryMode
from openacr.protocol.escape import decode, encode, encode_packet

PLAIN, PREFIXED, UNUSED, STRIPPED = map(BinaryMode, range(4))
EVERY_BYTE = bytes(range(256))


@pytest.mark.req("BIN-008", "BIN-010", "BIN-034")
@pytest.mark.parametrize("mode", [PLAIN, UNUSED])
def test_modes_0_and_2_change_nothing(mode: BinaryMode) -> None:
    assert encode(EVERY_BYTE, mode) == EVERY_BYTE
    assert decode(EVERY_BYTE, mode) == EVERY_BYTE


@pytest.mark.req("BIN-009", "BIN-014", "BIN-015", "BIN-016", "BIN-017", "BIN-018")
@pytest.mark.parametrize(
    ("plain", "sent"),
    [
        (b"\x01", b"#A"),
        (b"#", b"##"),
        (b"\x00", b"#@"),
        (b"\x11", b"#Q"),
        (b"\x13", b"#S"),
        (b"\x1f", b"#_"),
        (b"\x7f", b"#?"),
        (b"&\x80\xff", b"&\x80\xff"),
    ],
)
def test_mode_1_prefixes_control_characters(plain: bytes, sent: bytes) -> None:
    assert encode(plain, PREFIXED) == sent
    assert decode(sent, PREFIXED) == plain


@pytest.mark.req("BIN-018")
def test_mode_1_sends_every_other_byte_unchanged() -> None:
    changed = {*range(0x20), ord("#"), 0x7F}
    plain = [n for n in range(256) if n not in changed]
    assert len(plain) == 222
    for byte in plain:
        assert encode(bytes([byte]), PREFIXED) == bytes([byte])
        assert decode(bytes([byte]), PREFIXED) == bytes([byte])
    for byte in changed:
        assert encode(bytes([byte]), PREFIXED)[:1] == b"#"


@pytest.mark.req("BIN-011", "BIN-020", "BIN-021", "BIN-022", "BIN-023", "BIN-024")
@pytest.mark.parametrize(
    ("plain", "sent"),
    [
        (b"\xc2", b"&B"),
        (b"\x83", b"&#C"),
        (b"&", b"#&"),
        (b"#", b"##"),
        (b"\xa3", b"&##"),
        (b"\xa6", b"&#&"),
        (b"\xff", b"&#?"),
        (b"\x80", b"&#@"),
    ],
)
def test_mode_3_also_strips_the_high_bit(plain: bytes, sent: bytes) -> None:
    assert encode(plain, STRIPPED) == sent
    assert decode(sent, STRIPPED) == plain


@pytest.mark.req("BIN-019", "BIN-025")
def test_encoded_data_keep_clear_of_control_characters() -> None:
    controls = {*range(0x20), 0x7F}
    assert not controls & set(encode(EVERY_BYTE, PREFIXED))
    assert set(encode(EVERY_BYTE, STRIPPED)) <= set(range(0x20, 0x7F))


@pytest.mark.req("BIN-002", "BIN-026", "BIN-027")
def test_the_header_byte_is_never_converted() -> None:
    assert encode_packet(bytes.fromhex("0030022C"), PREFIXED) == bytes.fromhex("003023422C")
    assert encode_packet(bytes.fromhex("1C0802"), PREFIXED) == bytes.fromhex("1C23482342")
    assert encode_packet(bytes.fromhex("00880030"), STRIPPED) == bytes.fromhex("00262348234030")


@pytest.mark.req("BIN-028", "BIN-029", "BIN-030")
def test_only_the_toggle_range_is_toggled_on_reception() -> None:
    assert decode(b"#A#?##", PREFIXED) == b"\x01\x7f#"
    assert decode(b"#&#>#`#1", PREFIXED) == b"&>`1"


@pytest.mark.req("BIN-031", "BIN-032", "BIN-033")
def test_ampersand_sets_the_high_bit_in_mode_3_only() -> None:
    assert decode(b"&B&#Cx", STRIPPED) == b"\xc2\x83x"
    assert decode(b"&B", PREFIXED) == b"&B"


@pytest.mark.req("BIN-035")
@pytest.mark.parametrize("mode", list(map(BinaryMode, range(4))))
@given(data=st.binary(max_size=60))
def test_what_was_encoded_decodes_to_itself(mode: BinaryMode, data: bytes) -> None:
    assert decode(encode(EVERY_BYTE + data, mode), mode) == EVERY_BYTE + data
