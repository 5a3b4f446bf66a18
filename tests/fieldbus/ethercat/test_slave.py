"""What any emulated slave does: registers, states, mails, process data, clocks."""

import pytest
from tests.fieldbus.ethercat.rig import IN, MS, OUT, Bus

from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.emulated.terminals import Analog, Digital
from openacr.fieldbus.ethercat.wire import coe, frames, sdo_info, sii
from openacr.fieldbus.ethercat.wire.coe import Abort
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.frames import Command
from openacr.fieldbus.ethercat.wire.managers import READS, WRITES, Fmmu, SyncManager
from openacr.fieldbus.ethercat.wire.registers import ERROR, AlCode, Register, State

DIGITAL, ANALOG = 1, 2


@pytest.fixture
def bus() -> Bus:
    return Bus(segment_of(drives_world(1), digital=1, analog=1))


def test_a_broadcast_counts_the_slaves_and_positions_count_up(bus: Bus) -> None:
    asked = frames.by_station(Command.BRD, 0, Register.TYPE, b"\0")
    (back,) = bus.send(asked)
    assert (back.counter, back.position, back.data) == (3, 3, b"\x11")
    (back,) = bus.send(frames.by_position(Command.APRD, 1, Register.AL_STATUS, bytes(2)))
    assert (back.counter, back.position, back.data) == (1, 2, b"\x01\0")
    (back,) = bus.send(frames.by_position(Command.APRD, 3, Register.AL_STATUS, bytes(2)))
    assert (back.counter, back.data) == (0, b"\0\0")


def test_a_slave_answers_to_its_station_address(bus: Bus) -> None:
    bus.write(1, Register.STATION, b"\x02\x10")
    (back,) = bus.send(frames.by_station(Command.FPRD, 0x1002, Register.STATION, bytes(2)))
    assert (back.counter, back.data) == (1, b"\x02\x10")
    (back,) = bus.send(frames.by_station(Command.FPRD, 0x1003, Register.STATION, bytes(2)))
    assert back.counter == 0


def test_an_alias_is_loaded_from_the_eeprom_and_answers_once_it_is_used(bus: Bus) -> None:
    for control in (Register.EEPROM_CONTROL,):
        words = (0x0201).to_bytes(2, "little") + (4).to_bytes(4, "little") + b"\x21\x03"
        bus.write(1, control, words)
    asked = frames.by_station(Command.FPRD, 0x321, Register.TYPE, b"\0")
    bus.segment.power(1, False)
    bus.segment.power(1, True)
    assert bus.send(asked)[0].counter == 0
    bus.write(1, Register.DL_CONTROL + 3, b"\x01")
    assert bus.send(asked)[0].counter == 1
    assert bus.number(1, Register.ALIAS) == 0x321


def test_what_reads_and_writes_counts_three_and_a_write_of_many_reads_one(bus: Bus) -> None:
    (back,) = bus.send(frames.by_position(Command.APRW, 0, Register.STATION, b"\x05\0"))
    assert (back.counter, back.data) == (3, b"\0\0")
    assert bus.number(0, Register.STATION) == 5
    (back,) = bus.send(frames.by_position(Command.ARMW, 0, Register.STATION, bytes(2)))
    assert (back.counter, back.data) == (3, b"\x05\0")
    assert [bus.number(n, Register.STATION) for n in range(3)] == [5, 5, 5]


def test_registers_of_the_slave_cannot_be_written(bus: Bus) -> None:
    for register in (Register.TYPE, Register.AL_STATUS, Register.DL_STATUS, Register.ALIAS):
        before = bus.read(0, register, 2)
        bus.write(0, register, b"\xaa\xaa")
        assert bus.read(0, register, 2) == before


def test_memory_ends_where_it_ends(bus: Bus) -> None:
    for register, counter in ((0x2FFE, 1), (0x2FFF, 0)):
        (back,) = bus.send(frames.by_position(Command.APRD, 0, register, bytes(2)))
        assert back.counter == counter


def test_links_show_the_line(bus: Bus) -> None:
    assert [bus.number(n, Register.DL_STATUS) & 0x0FF0 for n in range(3)] == [0xA30, 0xA30, 0x610]


def test_the_eeprom_is_read_by_its_registers(bus: Bus) -> None:
    data = b""
    for word in range(0, 1024, 4):
        bus.write(0, Register.EEPROM_CONTROL, b"\x00\x01" + word.to_bytes(4, "little"))
        assert bus.number(0, Register.EEPROM_CONTROL) == 0x00C0
        data += bus.read(0, Register.EEPROM_DATA, 8)
    said = sii.parse(data)
    assert said == bus.segment.slaves[0].description
    assert (said.name, said.mailboxes.out_start, said.sync[2].size) == ("drive", OUT, 16)


def test_the_eeprom_refuses_writes_without_the_bit_that_enables_them(bus: Bus) -> None:
    bus.write(0, Register.EEPROM_CONTROL, bytes.fromhex("0002 08000000 1122"))
    assert bus.number(0, Register.EEPROM_CONTROL) == 0x40C0
    bus.write(0, Register.EEPROM_CONTROL, bytes.fromhex("0102 08000000 1122"))
    bus.write(0, Register.EEPROM_CONTROL, bytes.fromhex("0001 08000000"))
    assert bus.read(0, Register.EEPROM_DATA, 4) == bytes.fromhex("11220000")
    bus.write(0, Register.EEPROM_CONTROL, bytes.fromhex("0102 00040000 1122"))
    assert bus.number(0, Register.EEPROM_CONTROL) == 0x20C0


# -- states ----------------------------------------------------------------------------------


def test_preop_needs_the_mailboxes_of_the_eeprom(bus: Bus) -> None:
    assert bus.ask(0, State.PREOP) == (State.INIT | ERROR, AlCode.MAILBOX)
    for change in ((OUT + 1, 256, 0x26), (OUT, 255, 0x26), (OUT, 257, 0x26), (OUT, 256, 0x22)):
        bus.mailboxes(0)
        bus.write(0, Register.SYNC, SyncManager(*change).pack())
        assert bus.ask(0, State.PREOP | ERROR) == (State.INIT | ERROR, AlCode.MAILBOX)
    bus.mailboxes(0)
    bus.write(0, Register.SYNC + 8, SyncManager(IN, 256, 0x22, activate=0).pack())
    assert bus.ask(0, State.PREOP | ERROR) == (State.INIT | ERROR, AlCode.MAILBOX)
    bus.mailboxes(0)
    assert bus.ask(0, State.PREOP | ERROR) == (State.PREOP, 0)


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        (State.SAFEOP, AlCode.INVALID_CHANGE),
        (State.OP, AlCode.INVALID_CHANGE),
        (State.BOOT, AlCode.NO_BOOT),
        (5, AlCode.UNKNOWN_STATE),
        (0, AlCode.UNKNOWN_STATE),
    ],
)
def test_a_wrong_state_is_refused_with_its_code(bus: Bus, asked: int, code: AlCode) -> None:
    assert bus.ask(0, asked) == (State.INIT | ERROR, code)


def test_after_an_error_nothing_goes_up_until_it_is_acknowledged(bus: Bus) -> None:
    bus.ask(0, State.BOOT)
    bus.mailboxes(0)
    assert bus.ask(0, State.PREOP) == (State.INIT | ERROR, AlCode.NO_BOOT)
    assert bus.ask(0, State.INIT | ERROR) == (State.INIT, 0)
    assert bus.ask(0, State.PREOP) == (State.PREOP, 0)


@pytest.mark.parametrize(
    ("outputs", "inputs", "code"),
    [
        (15, 34, AlCode.OUTPUT_SIZE),
        (17, 34, AlCode.OUTPUT_SIZE),
        (0, 34, AlCode.OUTPUT_SIZE),
        (16, 33, AlCode.INPUT_SIZE),
        (16, 0, AlCode.INPUT_SIZE),
    ],
)
def test_safeop_needs_sync_managers_of_the_mapped_length(
    bus: Bus, outputs: int, inputs: int, code: AlCode
) -> None:
    bus.preop(0)
    bus.map(0, outputs, inputs)
    assert bus.ask(0, State.SAFEOP) == (State.PREOP | ERROR, code)


def test_process_data_cannot_be_in_the_mailboxes(bus: Bus) -> None:
    bus.preop(0)
    bus.map(0, 16, 34)
    bus.write(0, Register.SYNC + 16, SyncManager(IN + 255, 16, 0x64).pack())
    assert bus.ask(0, State.SAFEOP) == (State.PREOP | ERROR, AlCode.OUTPUT_SIZE)


def test_op_waits_a_second_for_outputs(bus: Bus) -> None:
    bus.preop(0)
    bus.map(0, 16, 34)
    bus.ask(0, State.SAFEOP)
    assert bus.ask(0, State.OP) == (State.SAFEOP, 0)
    bus.now += 990 * MS
    assert bus.number(0, Register.AL_STATUS) == State.SAFEOP
    bus.now += 10 * MS
    assert bus.number(0, Register.AL_STATUS) == State.SAFEOP | ERROR
    assert bus.number(0, Register.AL_CODE) == AlCode.NO_OUTPUTS


def test_down_again_every_state_is_left(bus: Bus) -> None:
    bus.op(DIGITAL, 1, 1)
    assert bus.ask(DIGITAL, State.INIT) == (State.INIT, 0)
    assert bus.cycle() == 0


# -- watchdog --------------------------------------------------------------------------------


def test_without_outputs_for_100_ms_a_slave_leaves_op_and_switches_its_outputs_off(
    bus: Bus,
) -> None:
    terminal = bus.segment.slaves[DIGITAL]
    assert isinstance(terminal, Digital)
    bus.op(DIGITAL, 1, 1)
    bus.outputs[DIGITAL] = b"\x81"
    assert bus.cycle() == 3
    assert terminal.outputs == [True, *[False] * 6, True]
    bus.now += 98 * MS
    assert bus.number(DIGITAL, Register.AL_STATUS) == State.OP
    bus.now += MS
    assert bus.number(DIGITAL, Register.AL_STATUS) == State.SAFEOP | ERROR
    assert bus.number(DIGITAL, Register.AL_CODE) == AlCode.WATCHDOG
    assert bus.number(DIGITAL, Register.WATCHDOG_STATUS) == 0
    assert bus.number(DIGITAL, Register.WATCHDOG_COUNT, 1) == 1
    assert terminal.outputs == [False] * 8
    assert bus.cycle() == 1  # inputs alone, until the error is acknowledged
    assert bus.acknowledge(DIGITAL, State.SAFEOP) == (State.SAFEOP, 0)
    assert bus.cycle() == 3
    assert bus.ask(DIGITAL, State.OP) == (State.OP, 0)
    bus.cycle()
    assert terminal.outputs[0]


def test_a_watchdog_of_0_never_expires(bus: Bus) -> None:
    bus.op(DIGITAL, 1, 1)
    bus.write(DIGITAL, Register.SYNC_WATCHDOG, bytes(2))
    bus.now += 5000 * MS
    assert bus.number(DIGITAL, Register.AL_STATUS) == State.OP


# -- process data ----------------------------------------------------------------------------


def test_terminals_exchange_bits_and_voltages(bus: Bus) -> None:
    digital, analog = bus.segment.slaves[1:]
    assert isinstance(digital, Digital)
    assert isinstance(analog, Analog)
    bus.op(DIGITAL, 1, 1)
    bus.op(ANALOG, 8, 8)
    digital.set_input(0, True)
    digital.set_input(6, True)
    analog.set_input(1, -10.0)
    analog.set_input(3, 25.0)
    bus.outputs[ANALOG] = (16384).to_bytes(2, "little") + bytes(4) + b"\x01\x80"
    assert bus.cycle() == 6
    bus.cycle()
    assert bus.inputs[DIGITAL] == b"\x41"
    assert bus.inputs[ANALOG] == bytes.fromhex("0000 0180 0000 ff7f")
    assert analog.outputs == pytest.approx([5.00015, 0.0, 0.0, -10.0], abs=1e-4)


def test_fmmus_map_single_bits(bus: Bus) -> None:
    terminal = bus.segment.slaves[DIGITAL]
    assert isinstance(terminal, Digital)
    bus.op(DIGITAL, 1, 1)
    # Bits 2 to 4 of the outputs from bit 6 of logical byte 0x20 on, input 5 into bit 7 of 0x30.
    outs = Fmmu(0x20, 2, 0x1200, WRITES, first_bit=6, last_bit=0, bit=2)
    ins = Fmmu(0x30, 1, 0x1600, READS, first_bit=7, last_bit=7, bit=5)
    bus.write(DIGITAL, Register.FMMU, outs.pack() + ins.pack())
    terminal.set_input(5, True)
    (back,) = bus.send(frames.by_logical(Command.LWR, 0x20, b"\x80\x01"))
    assert back.counter == 1
    assert terminal.outputs == [False, False, False, True, True, False, False, False]
    (back,) = bus.send(frames.by_logical(Command.LRD, 0x30, b"\x7f"))
    assert (back.counter, back.data) == (1, b"\xff")
    terminal.set_input(5, False)
    (back,) = bus.send(frames.by_logical(Command.LRD, 0x30, b"\xff"))
    assert back.data == b"\x7f"
    (back,) = bus.send(frames.by_logical(Command.LRW, 0x20, bytes(17)))
    assert back.counter == 3


def test_a_mailbox_that_is_full_can_be_mapped_into_the_process_data(bus: Bus) -> None:
    bus.preop(0)
    bus.write(0, Register.FMMU, Fmmu(0x50, 1, 0x080D, READS, 0, 0, 3).pack())
    asked = frames.by_logical(Command.LRD, 0x50, b"\0")
    assert bus.send(asked)[0].data == b"\0"
    bus.mail(0, coe.Upload(0x1000, 0).pack())
    assert bus.send(asked)[0].data == b"\1"


# -- mails -----------------------------------------------------------------------------------


def test_a_full_mailbox_takes_no_mail_and_an_empty_one_gives_none(bus: Bus) -> None:
    bus.preop(0)
    (back,) = bus.send(frames.by_position(Command.APRD, 0, IN, bytes(256)))
    assert back.counter == 0
    bus.mail(0, coe.Upload(0x1000, 0).pack())
    assert bus.number(0, Register.SYNC + 13, 1) == 0x08
    bus.collect(0)
    assert bus.number(0, Register.SYNC + 13, 1) == 0
    (back,) = bus.send(frames.by_position(Command.APRD, 0, IN, bytes(256)))
    assert back.counter == 0


def test_a_lost_answer_is_repeated_on_demand(bus: Bus) -> None:
    bus.preop(0)
    bus.mail(0, coe.Upload(0x1018, 1).pack())
    first = bus.collect(0)
    bus.write(0, Register.SYNC + 14, b"\x03")
    assert bus.number(0, Register.SYNC + 15, 1) & 2
    assert bus.collect(0) == first


def test_a_repeated_request_is_answered_once(bus: Bus) -> None:
    bus.preop(0)
    bus.mail(0, coe.Upload(0x1018, 1).pack())
    bus.collect(0)
    bus.counter -= 1
    bus.mail(0, coe.Upload(0x1018, 1).pack())
    assert bus.number(0, Register.SYNC + 13, 1) == 0


def test_other_protocols_are_refused_by_mail(bus: Bus) -> None:
    bus.preop(0)
    bus.write(0, OUT, bytes.fromhex("0200 0000 00 12 0000").ljust(256, b"\0"))
    mail = bus.collect(0)
    assert (mail.kind, mail.payload) == (0, bytes.fromhex("0100 0200"))


def test_objects_are_read_expedited_whole_and_in_segments(bus: Bus) -> None:
    bus.preop(0)
    assert bus.upload(0, 0x1018, 2) == (0x402).to_bytes(4, "little")
    assert bus.upload(0, 0x1008) == b"drive"
    whole = bus.upload(0, 0x1018, complete=True)
    assert whole == bytes.fromhex("0400 c20a0000 02040000 01000000 01000000")
    assert bus.upload(0, 0x1018, 1, complete=True) == whole[2:]
    long = "long " * 120
    bus.segment.slaves[0].dictionary.entry(0x1009, 0).value = long
    assert bus.upload(0, 0x1009) == long.encode()


@pytest.mark.parametrize(
    ("request_", "code"),
    [
        (coe.Upload(0x2000, 0), Abort.NO_OBJECT),
        (coe.Upload(0x1018, 9), Abort.NO_SUBINDEX),
        (coe.Upload(0x1018, 2, complete=True), Abort.SUBINDEX_0),
        (coe.Download(0x6041, 0, bytes(2), 2), Abort.READ_ONLY),
        (coe.Download(0x6072, 0, bytes(4), 4), Abort.TOO_LONG),
        (coe.Download(0x6072, 0, bytes(1), 1), Abort.TOO_SHORT),
        (coe.Download(0x6060, 0, b"\x01", 1), Abort.RANGE),
        (coe.Download(0x6085, 0, bytes(4), 4), Abort.TOO_LOW),
        (coe.Download(0x60C2, 2, b"\x01", 1), Abort.TOO_HIGH),
        (coe.UploadNext(False), Abort.COMMAND),
        (coe.DownloadNext(False, b"1", True), Abort.COMMAND),
        (coe.Download(0x1A00, 1, bytes(4), 4), Abort.UNSUPPORTED),
    ],
)
def test_what_cannot_be_is_aborted(bus: Bus, request_: coe.Request, code: Abort) -> None:
    bus.preop(0)
    reply = bus.sdo(0, request_)
    assert isinstance(reply, coe.Aborted)
    assert (reply.code, reply.text) == (code, code.text)


def test_segments_of_a_download_must_turn_their_bit_and_have_the_length(bus: Bus) -> None:
    bus.preop(0)
    ask = coe.Download(0x6065, 0, b"", 4)
    assert isinstance(bus.sdo(0, ask), coe.Downloaded)
    assert isinstance(bus.sdo(0, coe.DownloadNext(False, b"\1\2", False)), coe.DownloadedNext)
    assert isinstance(bus.sdo(0, coe.DownloadNext(True, b"\3\4", True)), coe.DownloadedNext)
    assert bus.upload(0, 0x6065) == b"\1\2\3\4"
    for segment, code in (
        (coe.DownloadNext(True, b"\1\2\3\4", True), Abort.TOGGLE),
        (coe.DownloadNext(False, b"\1\2\3\4\5", True), Abort.TOO_LONG),
        (coe.DownloadNext(False, b"\1\2\3", True), Abort.TOO_SHORT),
    ):
        bus.sdo(0, ask)
        reply = bus.sdo(0, segment)
        assert isinstance(reply, coe.Aborted)
        assert (reply.index, reply.code) == (0x6065, code)
    assert bus.upload(0, 0x6065) == b"\1\2\3\4"


def test_information_names_every_object_and_entry(bus: Bus) -> None:
    bus.preop(0)
    counts = sdo_info.words_of(bus.inform(0, sdo_info.ask_list(sdo_info.ListKind.COUNTS)).data)
    everything = bus.inform(0, sdo_info.ask_list(sdo_info.ListKind.ALL)).data
    indexes = sdo_info.words_of(everything)[1:]
    assert counts[1] == len(indexes) == len(bus.segment.slaves[0].dictionary.objects)
    assert 0x6040 in sdo_info.words_of(bus.inform(0, sdo_info.ask_list(sdo_info.ListKind(2))).data)
    one = sdo_info.ObjectDescription.parse(bus.inform(0, sdo_info.ask_object(0x60C2)).data)
    assert (one.highest_subindex, one.code) == (2, sdo_info.ObjectCode.RECORD)
    entry = sdo_info.EntryDescription.parse(bus.inform(0, sdo_info.ask_entry(0x6041, 0)).data)
    assert (entry.name, entry.data_type, entry.bits) == ("Statusword", DataType.UNSIGNED16, 16)
    assert entry.access == 0x87
    refused = bus.inform(0, sdo_info.ask_object(0x2000))
    assert refused.operation == sdo_info.Question.ERROR
    assert sdo_info.error_code(refused.data) == Abort.NO_OBJECT


# -- mapping ---------------------------------------------------------------------------------


def test_another_pdo_is_assigned_in_preop(bus: Bus) -> None:
    bus.preop(0)
    for index, pdo in ((0x1C12, 0x1601), (0x1C13, 0x1A01)):
        bus.download(0, index, 0, b"\0")
        bus.download(0, index, 1, pdo.to_bytes(2, "little"))
        assert isinstance(bus.download(0, index, 0, b"\1"), coe.Downloaded)
    bus.map(0, 6, 6)
    assert bus.ask(0, State.SAFEOP) == (State.SAFEOP, 0)
    assert bus.cycle() == 3
    reply = bus.download(0, 0x1C12, 0, b"\0")
    assert isinstance(reply, coe.Aborted)
    assert reply.code == Abort.STATE


def test_a_pdo_takes_other_objects_by_complete_access(bus: Bus) -> None:
    bus.preop(0)
    mapped = bytes.fromhex("0300 10004060 20007a60 10007260")
    assert isinstance(bus.download(0, 0x1601, 0, mapped, complete=True), coe.Downloaded)
    assert bus.upload(0, 0x1601, 3) == bytes.fromhex("10007260")
    assert isinstance(bus.download(0, 0x1C12, 0, bytes.fromhex("0100 0116"), True), coe.Downloaded)
    bus.map(0, 8, 34)
    assert bus.ask(0, State.SAFEOP) == (State.SAFEOP, 0)


@pytest.mark.parametrize(
    ("mapping", "code"),
    [
        (0x60410010, Abort.NOT_MAPPABLE),
        (0x60400020, Abort.PDO_LENGTH),
        (0x20000010, Abort.NO_OBJECT),
        (0x60400110, Abort.NO_SUBINDEX),
    ],
)
def test_what_cannot_be_mapped_is_refused(bus: Bus, mapping: int, code: Abort) -> None:
    bus.preop(0)
    bus.download(0, 0x1601, 0, b"\0")
    bus.download(0, 0x1601, 1, mapping.to_bytes(4, "little"))
    reply = bus.download(0, 0x1601, 0, b"\1")
    assert isinstance(reply, coe.Aborted)
    assert reply.code == code


# -- clocks ----------------------------------------------------------------------------------


def test_slaves_have_clocks_of_their_own_until_offsets_bring_them_together(bus: Bus) -> None:
    bus.send(frames.by_station(Command.BWR, 0, Register.RECEIVE_TIMES, bytes(4)))
    arrived = [bus.number(n, Register.RECEIVE_TIME, 8) for n in range(3)]
    assert arrived[1] - arrived[0] == 1_000_000_007 + 600
    for slave in range(3):
        offset = arrived[0] - arrived[slave]
        bus.write(slave, Register.TIME_OFFSET, offset.to_bytes(8, "little", signed=True))
        bus.write(slave, Register.TIME_DELAY, (600 * slave).to_bytes(4, "little"))
    bus.cycle_ns = 0
    times = [bus.number(n, Register.SYSTEM_TIME, 8) for n in range(3)]
    assert [time - times[0] for time in times] == [0, -600, -1200]


def test_a_frame_that_turns_back_is_seen_on_both_ports(bus: Bus) -> None:
    bus.send(frames.by_station(Command.BWR, 0, Register.RECEIVE_TIMES, bytes(4)))
    turns = [
        bus.number(n, Register.RECEIVE_TIMES + 4, 4) - bus.number(n, Register.RECEIVE_TIMES, 4)
        for n in range(2)
    ]
    assert turns == [2400, 1200]
    assert bus.number(2, Register.RECEIVE_TIMES + 4, 4) == 0


def test_a_clock_that_drifts_follows_the_reference(bus: Bus) -> None:
    bus.segment.slaves[1].controller.clock.drift_ppm = 50.0
    for slave in (0, 1):
        own = bus.number(slave, Register.SYSTEM_TIME, 8)
        aim = 1_000_000_000_000 + bus.now - own
        bus.write(slave, Register.TIME_OFFSET, aim.to_bytes(8, "little", signed=True))
    bus.write(0, Register.STATION, b"\x01\x10")
    for _ in range(200):
        bus.send(frames.by_station(Command.FRMW, 0x1001, Register.SYSTEM_TIME, bytes(8)))
    difference = bus.number(1, Register.TIME_DIFFERENCE, 4) & 0x7FFFFFFF
    assert 700 < difference < 900  # 50 ns a ms, corrected by a sixteenth a ms


def test_with_sync0_inputs_are_those_of_its_last_pulse(bus: Bus) -> None:
    terminal = bus.segment.slaves[DIGITAL]
    assert isinstance(terminal, Digital)
    bus.preop(DIGITAL)
    bus.map(DIGITAL, 1, 1)
    start = bus.number(DIGITAL, Register.SYSTEM_TIME, 8) + 20 * MS
    bus.write(DIGITAL, Register.SYNC0_START, start.to_bytes(8, "little"))
    bus.write(DIGITAL, Register.ACTIVATION, b"\x03")
    assert bus.ask(DIGITAL, State.SAFEOP) == (State.PREOP | ERROR, AlCode.CLOCK_SYNC)
    bus.write(DIGITAL, Register.SYNC0_CYCLE, (4 * MS).to_bytes(4, "little"))
    bus.write(DIGITAL, Register.ACTIVATION, b"\x03")
    assert bus.ask(DIGITAL, State.SAFEOP | ERROR) == (State.SAFEOP, 0)
    bus.outputs[DIGITAL] = b"\1"
    bus.cycle()
    assert bus.ask(DIGITAL, State.OP) == (State.SAFEOP, 0)  # until the first pulse
    while bus.number(DIGITAL, Register.AL_STATUS) != State.OP:
        assert not terminal.outputs[0]
        bus.cycle()
    assert bus.number(DIGITAL, Register.SYSTEM_TIME, 8) >= start
    terminal.set_input(0, True)
    seen = []
    for _ in range(8):
        bus.cycle()
        seen.append(bus.inputs[DIGITAL])
    assert seen == sorted(seen)
    assert seen[0] == b"\0"
    assert seen[4:] == [b"\1"] * 4
    assert terminal.outputs[0]


# -- a master that begins anew -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("number", "manager", "state", "code"),
    [
        (2, SyncManager(0, 0, 0, activate=0), State.PREOP, AlCode.OUTPUT_SIZE),
        (2, SyncManager(0x1202, 16, 0x64), State.PREOP, AlCode.OUTPUT_SIZE),
        (3, SyncManager(0x1600, 34, 0x20, activate=0), State.PREOP, AlCode.INPUT_SIZE),
        (3, SyncManager(0x1600, 33, 0x20), State.PREOP, AlCode.INPUT_SIZE),
        (0, SyncManager(0, 0, 0, activate=0), State.INIT, AlCode.MAILBOX),
        (1, SyncManager(IN, 255, 0x22), State.INIT, AlCode.MAILBOX),
    ],
)
def test_a_state_is_left_when_its_sync_managers_are_taken_away(
    bus: Bus, number: int, manager: SyncManager, state: State, code: AlCode
) -> None:
    bus.op(0, 16, 34)
    bus.write(0, Register.SYNC + 8 * number, manager.pack())
    assert bus.number(0, Register.AL_STATUS) == state | ERROR
    assert bus.number(0, Register.AL_CODE) == code


@pytest.mark.parametrize("state", [State.SAFEOP, State.OP])
def test_cleared_sync_managers_leave_the_registers_as_they_are(bus: Bus, state: State) -> None:
    bus.op(0, 16, 34)
    bus.ask(0, state)
    bus.write(0, Register.STATION, b"\x01\x10")
    registers = bus.read(0, Register.TYPE, 0x12)
    bus.write(0, Register.SYNC, bytes(32))  # as KickCAT resets a segment, from whatever state
    bus.segment.advance(bus.now + 10 * MS)
    assert bus.read(0, Register.TYPE, 0x12) == registers


def test_the_same_sync_managers_again_change_nothing(bus: Bus) -> None:
    bus.op(0, 16, 34)
    bus.mailboxes(0)
    bus.map(0, 16, 34)
    assert bus.number(0, Register.AL_STATUS) == State.OP
