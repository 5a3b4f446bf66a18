"""Journals: everything that enters is in them, and replaying them gives the same card."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from msgspec.structs import replace
from tests.controller.hosts import Host, at_axes, connected, store

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.controller.ring import Ring, journals, own_ring
from openacr.errors import OpenacrError, StoreError
from openacr.journal.entries import Entered
from openacr.plant.describe.network_schema import Canopen, Node
from openacr.plant.describe.schema import DeviceTable, default_world
from openacr.protocol.events import ControlKey

CURTAIN = DeviceTable(
    kind="light-curtain", inputs={"clear": 31}, settings={"response_s": 0.0}, period_s=0.0005
)
WITH_A_NODE = replace(
    default_world(), canopen=Canopen(node=(Node(id=1, analog_inputs=1),)), device=(CURTAIN,)
)


def recorded(folder: Path) -> Path:
    """The journal of a card to which all kinds of things happen."""
    host = at_axes(WITH_A_NODE)
    store(host, "PBOOT", "_L", "SET 40", "DWL 0.1", "CLR 40", "DWL 0.07", "GOTO L")
    card, path = host.card, folder / "a.journal"
    host.send("?P12288")
    card.recorder = Recorder(card, path, project="the project", fingerprint="f")
    host.type("", "SYS", "DIM P(9)", "FLASH SAVE", "ESAVE", "PROG0", "RUN", "X30 Y20", "X0")
    card.advance(seconds=0.4)
    packets = Host(card, StreamKind.PACKETS)
    packets.send(b"\x00\x30\x02\x03")
    card.drag(0, 0.25)
    card.set_input(5, True)
    card.set_input(6, True)
    card.fault(3, "obstacle", 0.5)
    card.fault(2, "encoder-noise")
    card.set_analog(33288, 2.5)
    card.until(40, timeout_s=2.0)
    card.release_input(6)
    card.command("light-curtain", "interrupted")
    card.mend(2, "encoder-noise")
    card.mend(3)
    card.p[3] = 2.5
    card.bit[130] = True
    before_a_line(card)
    card.bit[131] = True
    card.advance()
    card.bit[131] = False
    card.advance(seconds=1.3)
    packets.close()
    card.send("DWL 0.2 REBOOT")
    card.send("\r")
    card.advance(seconds=1.7)
    card.press(ControlKey.CTRL_X)
    serial = Host(card, StreamKind.SERIAL)
    serial.send("PROG1\rATTACH MASTER1\r?RND(1)\r\xff")
    card.advance(777)
    card.close()
    return path


def before_a_line(card: Controller) -> None:
    """Advance to the next line of program 0 and stop before it."""
    card.announce_lines(1, lambda program, line: True)
    card.advance(seconds=1.0)
    assert card.within
    card.announce_lines()


def test_a_replay_meets_every_digest(tmp_path: Path) -> None:
    journal = read_journal(recorded(tmp_path))
    assert journal.is_whole
    assert (journal.header.model, journal.header.project) == ("ACR9000", "the project")
    assert {entry.what for entry in journal.entries} == set(Entered) - {Entered.SENT}
    again = Replay(journal)
    again.run()
    assert again.difference is None
    assert again.equal == sum(entry.is_digest for entry in journal.entries) >= 4
    assert again.entered + again.equal == len(journal.entries)
    assert again.card.bit[130] is False  # user flags are cleared by REBOOT
    assert not again.card.system.programs.is_empty(0)


def test_the_replay_of_the_other_build_meets_every_digest_too(tmp_path: Path) -> None:
    host, path = at_axes(), tmp_path / "a.journal"
    host.card.recorder = Recorder(host.card, path)
    host.type("X5 Y-2", "JOG FWD X", "?RND(9)")
    host.card.advance(seconds=0.15)
    host.card.close()
    code = "from openacr.cli.main import main; main()"
    environment = os.environ | {"OPENACR_PURE": "1"}
    found = subprocess.run(
        [sys.executable, "-c", code, "replay", str(path), "--check"],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (found.returncode, found.stderr) == (0, "")
    assert " digests equal" in found.stdout


def test_a_replay_stops_where_it_is_asked_to(tmp_path: Path) -> None:
    journal = read_journal(recorded(tmp_path))
    again = Replay(journal)
    again.run(0.2)
    assert again.card.lived_tk == journal.header.tick + 400
    assert (again.lived_s, again.equal) == (0.2, 0)
    again = Replay(journal)
    again.run(100.0)
    assert again.lived_s == 100.0


@pytest.mark.parametrize("what", sorted(set(Entered) - {Entered.SENT, Entered.DIGEST, Entered.END}))
def test_an_entry_that_is_left_out_is_noticed(tmp_path: Path, what: Entered) -> None:
    """Of every kind, one that has an effect at all."""
    card = Controller(world=WITH_A_NODE)
    host = Host(card)
    path = tmp_path / "a.journal"
    card.recorder = Recorder(card, path)
    if what in (Entered.OPEN, Entered.BYTES, Entered.CLOSE):
        other = Host(card)
        other.send("DWL 5\r")
        if what is Entered.CLOSE:
            other.close()
    elif what is Entered.INPUT:
        card.set_input(3, True)
    elif what is Entered.RELEASE:
        card.set_input(3, True)
        card.release_input(3)
    elif what in (Entered.FAULT, Entered.MEND):
        card.fault(3, "obstacle", 0.5)
        if what is Entered.MEND:
            card.mend(3)
    elif what is Entered.COMMAND:
        card.command("light-curtain", "interrupted")
    elif what is Entered.ANALOG:
        card.set_analog(33288, 1.0)
    elif what is Entered.DRAG:
        card.drag(0, 100.0)
    elif what is Entered.PARAMETER:
        card.p[12290] = 5
    elif what is Entered.FLAG:
        card.bit[130] = True
    elif what is Entered.WITHIN:
        host.send("PROG0\r10 IF (BIT130) THEN SET 131\r20 CLR 130\r30 GOTO 10\rRUN\r")
        before_a_line(card)
        card.bit[130] = True
    else:
        host.send("PROG0\r10 DWL 9\rRUN\r")
        card.press(ControlKey.CTRL_X)
    card.advance(10)
    card.close()
    journal = read_journal(path)
    left = [each for each in journal.entries if each.what is not what]
    if what is Entered.OPEN:
        left = [each for each in left if each.what is not Entered.BYTES]
    again = Replay(replace(journal, entries=tuple(left)))
    again.run()
    assert again.difference is not None
    whole = Replay(journal)
    whole.run()
    assert whole.difference is None


def test_everything_that_enters_is_in_memory_too() -> None:
    card = Controller()
    card.send("?1\r")
    card.advance(10)
    card.set_input(7, True)
    kinds = [(entry.tick, entry.what, entry.number, entry.data) for entry in card.journal]
    assert kinds == [
        (0, Entered.OPEN, 1, b"terminal"),
        (0, Entered.BYTES, 1, b"?1\r"),
        (10, Entered.INPUT, 7, b""),
    ]


# files


def test_a_journal_that_was_cut_off_anywhere_is_read_up_to_its_last_whole_record(
    tmp_path: Path,
) -> None:
    path = recorded(tmp_path)
    whole, content = read_journal(path), path.read_bytes()
    body = content.index(b"\n", content.index(b"\n") + 1) + 1
    for end in range(body, len(content), 7):
        path.write_bytes(content[:end])
        cut = read_journal(path)
        assert not cut.is_whole
        assert cut.entries == whole.entries[: content[body:end].count(b"\n")]
    path.write_bytes(content[: len(content) // 2 + body // 2])
    again = Replay(read_journal(path))
    again.run()
    assert again.difference is None


def test_damage_in_the_middle_is_named_with_its_line(tmp_path: Path) -> None:
    path = recorded(tmp_path)
    lines = path.read_bytes().split(b"\n")
    sent = b'[%d,"sent",1,"A"]' % json.loads(lines[5])[0]  # of recorded sessions
    for damage in (b"\x00\x00", b'[1,"what"]', b'[1,"bytes"]', b"{}", sent):
        path.write_bytes(b"\n".join([*lines[:5], damage, *lines[6:]]))
        with pytest.raises(StoreError, match="line 6 is damaged"):
            read_journal(path)


def test_what_is_no_journal_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x"
    with pytest.raises(StoreError, match="No such file"):
        read_journal(path)
    for content, said in (
        (b"PROG0\n", "is not a journal"),
        (b"openacr journal 2\n{}\n", "is not a journal"),
        (b"openacr journal 1\n{", "ends within its first record"),
        (b"openacr journal 1\n{}\n", "its first record cannot be read"),
    ):
        path.write_bytes(content)
        with pytest.raises(StoreError, match=said):
            read_journal(path)


def test_a_journal_of_another_layout_or_with_another_snapshot_is_refused(tmp_path: Path) -> None:
    path = recorded(tmp_path)
    magic, head, *rest = path.read_bytes().split(b"\n")
    for change, said in (
        ({"layout": "0"}, "another layout of the memory"),
        ({"digest": "0"}, "its snapshot is not that of its first tick"),
        ({"snapshot": "AAAA"}, "the snapshot cannot be read"),
    ):
        changed = json.dumps(json.loads(head) | change).encode()
        path.write_bytes(b"\n".join([magic, changed, *rest]))
        with pytest.raises(StoreError, match=said):
            Replay(read_journal(path))


def test_a_journal_cannot_tell_of_a_return_to_a_snapshot(tmp_path: Path) -> None:
    card = Controller()
    before = card.snapshot()
    card.recorder = Recorder(card, tmp_path / "a")
    with pytest.raises(StoreError, match="cannot return to a snapshot"):
        card.restore(before)
    card.close()


def test_a_full_disk_ends_the_journal_and_not_the_card(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("no device that is always full")
    card = Controller()
    with pytest.raises(StoreError, match="full: cannot be written: no space left"):
        Recorder(card, full)
    assert full.exists()
    assert caplog.messages == []  # the error alone says it
    card.recorder = recorder = Recorder(card, tmp_path / "a")
    recorder.records._file.close()
    recorder.records._file = full.open("wb", buffering=0)
    assert card.send("?1\r").endswith("1\r\nSYS>")
    card.close()
    assert "No space left" in recorder.failure
    assert caplog.messages == [f"{tmp_path / 'a'} is not complete: {recorder.failure}"]


def test_watching_does_not_change_the_card(tmp_path: Path) -> None:
    cards = [connected(), connected()]
    recorder = Recorder(cards[0].card, tmp_path / "a")
    cards[0].card.recorder = recorder
    for host in cards:
        host.type("PROG0", "10 P0=P0+1", "20 DWL 0.003", "30 GOTO 10", "SYS", "DIM P(2)")
        host.type("PROG0", "RUN")
        host.card.advance(5001)
        host.card.until(516, timeout_s=1.7)
    assert cards[0].card.digest() == cards[1].card.digest()
    cards[0].card.close()


# ring


def test_a_ring_keeps_the_last_files_and_each_can_be_replayed(tmp_path: Path) -> None:
    folder = tmp_path / "ring"
    for _ in range(2):  # the second card goes on counting where the first one stopped
        host = at_axes()
        card = host.card
        card.recorder = Ring(card, folder, file_s=2.0, files=3)
        store(host, "_L", "PRINT 1", "DWL 0.3", "GOTO L")
        host.type("LRUN")
        for _ in range(6):
            host.send("\x1bX/1:?P0")
            card.advance(seconds=1.1)
            host.send("\rLISTEN\r")
        card.close()
    names = [path.name for path in journals(folder)]
    assert names == ["000006.journal", "000007.journal", "000008.journal"]
    for name in names:
        again = Replay(read_journal(folder / name))
        again.run()
        assert (again.difference, again.equal >= 1) == (None, True)


def test_a_ring_is_bounded_also_where_hosts_send_very_much(tmp_path: Path) -> None:
    card = Controller()
    host = Host(card, StreamKind.PACKETS)
    card.recorder = Ring(card, tmp_path, most_bytes=100_000, files=2)
    for _ in range(6):
        for _ in range(400):
            host.send(b"\x00\x30\x02\xff" * 50)
        card.advance(seconds=1.0)
    card.close()
    kept = journals(tmp_path)
    assert [path.stem for path in kept] == ["000006", "000007"]
    assert sum(path.stat().st_size for path in kept) < 1_000_000
    again = Replay(read_journal(kept[0]))
    again.run()
    assert (again.difference, again.equal >= 1) == (None, True)


def test_a_folder_that_goes_away_leaves_the_card_without_a_journal_for_a_while(
    tmp_path: Path,
) -> None:
    card = Controller()
    folder = tmp_path / "ring"
    card.recorder = Ring(card, folder, file_s=2.0)
    folder.rename(tmp_path / "away")
    card.advance(seconds=3.1)
    assert card.send("?1\r").endswith("1\r\nSYS>")
    folder.mkdir()
    card.advance(seconds=3.0)
    card.close()
    assert journals(folder)


def test_a_place_that_cannot_be_used_at_all_is_said_at_once(tmp_path: Path) -> None:
    root = tmp_path / "journals"
    root.write_text("a file")
    with pytest.raises(StoreError, match=f"^{root}/1 cannot be used: Not a directory$"):
        own_ring(Controller(), root)


def test_cards_that_have_no_folder_of_their_own_do_not_meet(tmp_path: Path) -> None:
    one, two = Controller(), Controller()
    one.recorder, two.recorder = own_ring(one, tmp_path), own_ring(two, tmp_path)
    with pytest.raises(StoreError, match="in use by another card"):
        Ring(Controller(), tmp_path / "1")
    one.close()
    three = Controller()
    three.recorder = own_ring(three, tmp_path)
    two.close()
    three.close()
    counts = [len(journals(tmp_path / name)) for name in ("1", "2")]
    assert counts == [2, 1]


def test_a_journal_with_a_damaged_byte_is_refused_or_replayed_never_a_traceback(
    tmp_path: Path,
) -> None:
    path, damaged = tmp_path / "a.journal", tmp_path / "b.journal"
    card = Controller()
    card.recorder = Recorder(card, path)
    card.send("?P0\r")
    card.advance(seconds=2.5)
    card.close()
    content = path.read_bytes()
    header = content.index(b"\n", len(content.split(b"\n")[0]) + 1)
    places = [*range(0, 900, 20), *range(header - 40, len(content), 7)]
    refused = 0
    for place in places:
        for byte in (0xFF, 0x22):
            damaged.write_bytes(content[:place] + bytes([byte]) + content[place + 1 :])
            try:
                Replay(read_journal(damaged)).run()
            except OpenacrError as error:
                refused += 1
                assert "journal" in str(error)
    assert refused > len(places)
