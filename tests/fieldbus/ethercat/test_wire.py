"""The bytes of EtherCAT, against examples of the standard and of real devices."""

from dataclasses import replace

import pytest

from openacr.errors import UserError
from openacr.fieldbus.ethercat.wire import coe, data_types, frames, mailbox, sdo_info, sii
from openacr.fieldbus.ethercat.wire.coe import Service
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.frames import Command, Datagram, WireError
from openacr.fieldbus.ethercat.wire.managers import Fmmu, SyncManager, SyncUse
from openacr.fieldbus.ethercat.wire.registers import AlCode, Register, al_text

BRD = bytes.fromhex(
    "ffffffffffff 020000000001 88a4 0e10"  # head: 14 bytes of datagrams, type 1
    "07 80 0000 3001 0200 0000 0000 0000"
)


def test_a_broadcast_read_of_the_state_is_this_frame() -> None:
    asked = Datagram(Command.BRD, 0, Register.AL_STATUS, bytes(2), index=0x80)
    assert frames.pack([asked]) == BRD.ljust(60, b"\0")
    assert frames.parse(frames.pack([asked])) == [asked]


def test_all_but_the_last_datagram_say_that_another_follows() -> None:
    asked = [
        frames.by_position(Command.APWR, 2, Register.STATION, b"\x01\x10"),
        frames.by_station(Command.FPRD, 0x1001, Register.AL_STATUS, bytes(2)),
        frames.by_logical(Command.LRW, 0x00010002, b"abc"),
    ]
    packed = frames.pack(asked)
    assert [packed[place + 7] & 0x80 for place in (16, 30, 44)] == [0x80, 0x80, 0]
    assert frames.parse(packed) == asked
    assert asked[0].position == 0xFFFE
    assert (asked[2].position, asked[2].offset, asked[2].address) == (2, 1, 0x00010002)


def test_counter_events_and_circulation_are_kept() -> None:
    one = Datagram(Command.FPRW, 5, 6, b"xy", index=9, counter=3, events=0x102, circulated=True)
    assert frames.parse(frames.pack([one])) == [one]


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda f: f[:12] + b"\x08\x00" + f[14:], "its type is not 0x88A4"),
        (lambda f: f[:15] + b"\x40" + f[16:], "type 4: only type 1"),
        (lambda f: f[:29], "its datagrams need 30"),
        (lambda f: f[:23] + b"\x80" + f[24:], "ends in datagram 2"),
        (lambda f: f[:22] + b"\x03" + f[23:], "ends in datagram 1"),
        (lambda f: f[:10], "no EtherCAT frame"),
    ],
)
def test_what_is_no_whole_frame_is_refused(change: object, text: str) -> None:
    assert callable(change)
    with pytest.raises(WireError, match=text):
        frames.parse(change(BRD))


def test_a_frame_holds_at_most_1514_bytes() -> None:
    longest = Datagram(Command.LRW, 0, 0, bytes(frames.LONGEST_DATA))
    assert len(frames.pack([longest])) == 1514
    with pytest.raises(WireError, match="at most 1486"):
        frames.pack([replace(longest, data=bytes(1487))])
    with pytest.raises(WireError, match="room for 1498"):
        frames.pack([longest, replace(longest, data=b"")])
    with pytest.raises(WireError, match="at least one"):
        frames.pack([])


def test_a_mail_has_its_length_protocol_and_counter() -> None:
    mail = mailbox.Mail(mailbox.MailType.COE, b"\x00\x20abc", counter=5)
    assert mail.pack() == bytes.fromhex("0500 0000 00 53 0020") + b"abc"
    assert mailbox.Mail.parse(mail.pack().ljust(128, b"\xff")) == mail
    with pytest.raises(WireError, match="a mail of 5 bytes in a mailbox of 10"):
        mailbox.Mail.parse(mail.pack()[:10])
    with pytest.raises(WireError, match="its header alone has 6"):
        mailbox.Mail.parse(b"12345")


def test_counters_of_mails_run_from_1_to_7() -> None:
    assert [mailbox.next_counter(n) for n in (0, 1, 6, 7)] == [1, 2, 7, 1]


def test_a_mail_of_an_error_holds_its_code() -> None:
    mail = mailbox.error_mail(mailbox.MailError.PROTOCOL, 3)
    assert mail.pack() == bytes.fromhex("0400 0000 00 30 0100 0200")
    assert mailbox.mail_error(mail.payload) == 2


# Bytes of SDOs as CiA 301 prints them, after the two bytes of the CoE head.
SDOS = [
    (coe.Upload(0x1018, 1), "0020 40 1810 01 00000000"),
    (coe.Upload(0x1C12, 0, complete=True), "0020 50 121c 00 00000000"),
    (coe.Download(0x6040, 0, b"\x0f\x00", 2), "0020 2b 4060 00 0f000000"),
    (coe.Download(0x6060, 0, b"\x08", 1), "0020 2f 6060 00 08000000"),
    (coe.Download(0x607A, 0, b"\x01\x02\x03\x04", 4), "0020 23 7a60 00 01020304"),
    (coe.Download(0x2000, 1, b"hello", 9, complete=True), "0020 31 0020 01 09000000 68656c6c6f"),
    (coe.UploadNext(True), "0020 70 00000000000000"),
    (coe.UploadNext(False), "0020 60 00000000000000"),
    (coe.DownloadNext(False, b"abc", True), "0020 09 616263 00000000"),
    (coe.DownloadNext(True, b"12345678", False), "0020 10 3132333435363738"),
    (coe.Aborted(0x6060, 2, coe.Abort.TIMEOUT), "0020 80 6060 02 00000405"),
]
REPLIES = [
    (coe.Uploaded(0x1018, 1, b"\x09\x00\x00\x00", 4), "0030 43 1810 01 09000000"),
    (coe.Uploaded(0x1000, 0, b"\x09", 1), "0030 4f 0010 00 09000000"),
    (coe.Uploaded(0x1008, 0, b"drive", 5), "0030 41 0810 00 05000000 6472697665"),
    (coe.Downloaded(0x6060, 0), "0030 60 6060 00 00000000"),
    (coe.Segment(True, b"1234567", False), "0030 10 31323334353637"),
    (coe.Segment(False, b"", True), "0030 0f 00000000000000"),
    (coe.DownloadedNext(True), "0030 30 00000000000000"),
]


@pytest.mark.parametrize(("request_", "text"), SDOS)
def test_a_request_of_a_master_has_these_bytes(request_: coe.Request, text: str) -> None:
    payload = request_.pack()
    assert payload == bytes.fromhex(text)
    service, body = coe.service_of(payload)
    assert (service, coe.parse_request(body)) == (Service.REQUEST, request_)


@pytest.mark.parametrize(("reply", "text"), REPLIES)
def test_a_reply_of_a_slave_has_these_bytes(reply: coe.Reply, text: str) -> None:
    assert not isinstance(reply, coe.Aborted)
    payload = reply.pack()
    assert payload == bytes.fromhex(text)
    service, body = coe.service_of(payload)
    assert (service, coe.parse_reply(body)) == (Service.RESPONSE, reply)


def test_what_is_no_sdo_is_refused() -> None:
    with pytest.raises(WireError, match="an SDO of 7 bytes"):
        coe.parse_request(bytes(7))
    with pytest.raises(WireError, match="command 0xA0 is not one of a master"):
        coe.parse_request(b"\xa0" + bytes(7))
    with pytest.raises(WireError, match="command 0xC0 is not one of a slave"):
        coe.parse_reply(b"\xc0" + bytes(7))


def test_an_emergency_has_its_code_register_and_five_bytes() -> None:
    one = coe.Emergency(0x8611, 0x21, b"abc\0\0")
    assert one.pack() == bytes.fromhex("0010 1186 21 6162630000")
    assert coe.Emergency.parse(coe.service_of(one.pack())[1]) == one


def test_codes_are_said_in_words() -> None:
    assert coe.abort_text(0x06090011) == "the subindex does not exist"
    assert coe.abort_text(0x12345678) == "abort code 0x12345678"
    assert al_text(0x1B) == "sync manager watchdog"
    assert al_text(0x8001) == "AL status code 0x8001"
    assert all(code.text for code in (*AlCode, *coe.Abort))


def test_information_says_how_many_fragments_follow() -> None:
    last = sdo_info.Information(2, b"ab")
    assert last.pack() == bytes.fromhex("0080 02 00 0000 6162")
    part = sdo_info.Information(2, b"ab", fragments=3)
    assert part.pack() == bytes.fromhex("0080 82 00 0300 6162")
    assert sdo_info.Information.parse(part.pack()[2:]) == part
    assert sdo_info.ask_entry(0x6041, 2) == bytes.fromhex("0080 05 00 0000 4160 02 00")
    assert sdo_info.ask_object(0x6041) == bytes.fromhex("0080 03 00 0000 4160")
    assert sdo_info.ask_list(sdo_info.ListKind.ALL) == bytes.fromhex("0080 01 00 0000 0100")


def test_descriptions_of_objects_are_read_as_written() -> None:
    one = sdo_info.ObjectDescription(0x6041, 6, 0, sdo_info.ObjectCode.VARIABLE, "Statusword")
    assert sdo_info.ObjectDescription.parse(one.pack()) == one
    entry = sdo_info.EntryDescription(0x6041, 0, 6, 16, 0x87, "Statusword")
    assert sdo_info.EntryDescription.parse(entry.pack()) == entry


def test_a_sync_manager_has_eight_bytes() -> None:
    one = SyncManager(0x1100, 6, 0x64, 0x08, 1, 2)
    assert one.pack() == bytes.fromhex("0011 0600 64 08 01 02")
    assert SyncManager.parse(b"\0" * 8 + one.pack(), 8) == one


def test_an_fmmu_has_sixteen_bytes() -> None:
    one = Fmmu(0x00010000, 2, 0x1100, 2, first_bit=3, last_bit=5, bit=1)
    assert one.pack() == bytes.fromhex("00000100 0200 03 05 0011 01 02 01 000000")
    assert Fmmu.parse(one.pack()) == one
    assert not one.is_bytes
    assert replace(one, first_bit=0, last_bit=7, bit=0).is_bytes


def test_data_types_refuse_what_they_cannot_hold() -> None:
    assert data_types.encode(DataType.INTEGER16, -2) == b"\xfe\xff"
    assert data_types.decode(DataType.INTEGER16, b"\xfe\xff\x01") == -2
    assert data_types.encode(DataType.UNSIGNED8, 255) == b"\xff"
    for value in (-1, 256, 1.5):
        with pytest.raises(UserError, match="whole numbers from 0 to 255"):
            data_types.encode(DataType.UNSIGNED8, value)
    with pytest.raises(UserError, match="needs 4 bytes, there are 3"):
        data_types.decode(DataType.UNSIGNED32, b"abc")
    assert data_types.decode(DataType.VISIBLE_STRING, b"ab\0c") == "ab"
    assert data_types.decode(DataType.BOOLEAN, b"\1") == 1
    assert [DataType.BOOLEAN.bits, DataType.INTEGER64.bits, DataType.VISIBLE_STRING.bits] == [
        1,
        64,
        0,
    ]


DRIVE = sii.Description(
    sii.Identity(0x1234, 0x402, 0x10000, 77),
    alias=5,
    mailboxes=sii.Mailboxes(0x1000, 128, 0x1080, 128, mailbox.Protocol.COE),
    name="drive",
    order="D-1",
    group="drives",
    coe_details=0x23,
    fmmu=(1, 2, 3, 0),
    sync=(
        sii.DefaultSync(0x1000, 128, 0x26, SyncUse.MAILBOX_OUT),
        sii.DefaultSync(0x1100, 6, 0x64, SyncUse.OUTPUTS),
    ),
    receive=(sii.Pdo(0x1600, (sii.Entry(0x6040, 0, 16, "Controlword", 6),), 2, "out", True),),
    transmit=(sii.Pdo(0x1A00, (sii.Entry(0x6041, 0, 16, "Statusword", 6),), 3, "in"),),
)


def test_an_eeprom_is_read_as_it_was_written() -> None:
    data = sii.build(DRIVE)
    assert len(data) == 2048
    assert sii.parse(data) == DRIVE
    assert sii.parse(data).sync_of(SyncUse.OUTPUTS) == 1
    assert data[0x7C:0x80] == bytes.fromhex("0f00 0100")  # 16 kbit, version 1


def test_the_checksum_is_that_of_an_eeprom_of_a_real_controller() -> None:
    # The first bytes of the XMC4800 that KickCAT's simulation comes with.
    assert sii.checksum(bytes.fromhex("8003 006e ff00 ff00 0000 0000 0000")) == 0x22


def test_a_damaged_eeprom_is_refused() -> None:
    data = bytearray(sii.build(DRIVE))
    with pytest.raises(WireError, match="cut off"):
        sii.parse(bytes(data[:150]))
    data[9] ^= 1
    with pytest.raises(WireError, match="checksum"):
        sii.parse(bytes(data))
    with pytest.raises(WireError, match="head alone has 128"):
        sii.parse(bytes(100))
    with pytest.raises(WireError, match="the EEPROM 256"):
        sii.build(DRIVE, 256)
