"""What hosts find after a home search and after CLEAR."""

from openacr.controller import Controller

X = 'PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rPPU X1000\rDRIVE ON X\rVEL 10\r'


def test_the_position_is_zero_after_a_home_search_wherever_the_axis_was() -> None:
    card = Controller()
    card.send(X + "JOG VEL X5 ACC X50 DEC X50\rX3\r")
    card.advance(seconds=3)
    assert card.p[12288] == card.p[12290] == 3000
    card.send("JOG HOME X1\r")
    card.advance(seconds=0.5)
    assert card.bit[792], "the search goes on"
    card.set_input(2, True)
    card.advance(seconds=1)
    card.set_input(2, False)
    card.advance(seconds=2)
    assert card.bit[16134], "Found Home"
    assert not card.bit[792]
    assert [card.p[number] for number in (12288, 12290, 12294)] == [0, 0, 0]
    card.send("P12288=0\r")
    card.advance(seconds=0.1)
    assert [card.p[number] for number in (12288, 12290, 12294)] == [0, 0, 0]


def test_clear_answers_with_its_prompt_and_is_refused_over_stored_programs() -> None:
    card = Controller()
    assert card.send("CLEAR\r") == "CLEAR\r\nSYS>"
    assert card.send("PROG0\rCLEAR\r") == "PROG0\r\nP00>CLEAR\r\nP00>"
    assert card.send("10 VER\rSYS\rCLEAR\r").endswith("Program in memory\r\nSYS>")
    assert card.send("NEW ALL\rCLEAR\r") == "NEW ALL\r\nSYS>CLEAR\r\nSYS>"
