"""The language side of a card as a whole."""

from msgspec import msgpack
from tests.basic.machine import Machine

from openacr.basic.execute.language_state import Language, put_back, take
from openacr.basic.language.loader import file_lines
from openacr.channels import Attention


def test_a_snapshot_taken_at_any_moment_goes_on_the_same_way() -> None:
    first = Machine()
    first.type("DIM P(10)", "DIM DEF(2)", "#DEFINE Count P1", 'PASSWORD ON "x"', "CONFIG CLEAR")
    first.type('IP "10.0.0.7"', "PROG 1", "DIM $V(1,20)", '$V0 = "text"')
    first.load(1, "INPUT P2", "_L", "Count = Count + P2", "DWL 0.01", "GOTO L")
    first.connect("STREAM2")
    first.type('OPEN "STREAM2:" AS #2', "LRUN")
    first.advance(10)
    first.key("2\r")
    first.advance(30)
    first.sent()
    image = first.card.memory.snapshot()
    state = msgpack.encode(take(first.system, first.executor))

    second = Machine()
    second.connect("STREAM2")
    second.card.memory.restore(image)
    put_back(second.system, second.executor, msgpack.decode(state, type=Language))
    for card in (first, second):
        card.advance(100)
        card.session.escape()
    assert second.sent() == first.sent() == "|P01>"
    for line in ("?Count;$V0", "IP", "DIM", "HALT", "SYS", "PASSWORD", "DIM", "MEM"):
        assert first.type(line) == second.type(line)
    assert second.system.sessions["STREAM2"].attention is Attention.OPEN
    assert second.card.memory.digest() == first.card.memory.digest()


def test_battery_backed_memory_survives_a_restart() -> None:
    card = Machine()
    card.type("DIM P(10)", "DIM DEF(2)", "#DEFINE Count P1", "Count = 5.5", "PROG 1", "DIM LV(3)")
    card.type("LV2 = 7", "P38912 = 9", "ECHO 3", "SET 128", "ATTACH MASTER0", "10 DWL 1")
    card.type('OPEN "COM2:" AS #1')
    before = card.type("MEM PROG1")
    card.executor.threads.reset()
    card.system.restart()
    card.connect("COM1")
    assert card.type("?Count;P38912;BIT128", "PROG 1") == "5.590|SYS>P01>"
    assert card.type("?LV2", "ATTACH", "LIST") == "7|P01>P01>10 DWL 1|P01>"
    assert before.startswith(card.type("MEM PROG1").removesuffix("P01>"))
    assert card.system.sessions["COM2"].attention is Attention.COMMANDS


FILE = """\
SYS>HALT ALL
SYS>NEW ALL
CLEAR
DIM P(10)
DIM DEF(3)
#DEFINE Total P1
PROG 3
' a comment
PROGRAM
_Again
Total = (Total +
P2)
IF (Total < 5) THEN GOTO Again
PRINT "total is
"; Total
PROG0
"""


def test_a_download_file_sets_up_and_stores_a_program() -> None:
    card = Machine()
    answers = [card.type(line.text) for line in file_lines(FILE)]
    assert [answer for answer in answers if "|" in answer] == []
    card.card.memory.write(2, 2)
    assert card.type("PROG 3", "LIST") == (
        "P03>PROGRAM| _Again| Total = (Total+P2)| IF (Total < 5) THEN GOTO Again|"
        ' PRINT "total is ";Total|ENDP|P03>'
    )
    card.type("LRUN")
    card.advance()
    assert card.sent() == "total is 6|P03>"


def test_an_error_in_one_line_of_a_file_does_not_stop_the_next() -> None:
    card = Machine()
    for line in file_lines("DIM P(5)\nunit move\nP1 = 7\n"):
        card.session.feed_line(line.text)
    assert card.sent() == "SYS>Unknown command|SYS>SYS>"
    assert card.card.memory.read(1) == 7
