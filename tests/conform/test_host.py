"""Cases on a card in use: only what asks is typed, wrong answers are found, nothing changes."""

import re
from pathlib import Path

import pytest

from openacr import Controller
from openacr.client import Card
from openacr.client.errors import ConnectionLostError, GarbledError
from openacr.client.links import ProcessLink
from openacr.conform.campaign import Outcome, chosen, on_card_in_use, on_virtual_card
from openacr.conform.host import HostCard, occupation
from openacr.conform.read import supplied
from openacr.errors import UserError


class Wire(ProcessLink):
    """A card in this process whose answers pass a hand that may change them."""

    def __init__(self, card: Controller, pattern: bytes = b"(?!)", becomes: bytes = b"") -> None:
        super().__init__(card)
        self.pattern, self.becomes = re.compile(pattern), becomes
        self.typed = b""

    def read(self, timeout_s: float | None) -> bytes:
        return self.pattern.sub(self.becomes, super().read(timeout_s))

    def write(self, data: bytes) -> None:
        self.typed += data
        super().write(data)


class SlowWire(Wire):
    """A serial line: the bytes of an answer arrive one by one."""

    left = b""

    def read(self, timeout_s: float | None) -> bytes:
        data = self.left or super().read(timeout_s)
        self.left = data[1:]
        return data[:1]


def outcomes(wire: Wire, *areas: str, model: str = "ACR9000") -> list[Outcome]:
    wire.open()
    return list(on_card_in_use(chosen(supplied(), areas), HostCard(wire), model))


def in_use() -> Controller:
    """A card with programs, variables and a setting of its user."""
    card = Controller()
    card.send("DIM P(50)\rDIM PROG3(9000)\rP7=5\rPROG3\r10 P8=6\r20 END\rSYS\r")
    return card


def test_cases_that_only_ask_agree_and_change_nothing() -> None:
    card = in_use()
    listed = card.send("PROG3\rLIST\rSYS\r")
    settings = card.send("MEM\rATTACH\rCONFIG\r")
    wire = Wire(card)
    found = outcomes(wire, "evaluation", "communication")
    assert {each.result for each in found} == {"agrees", "not run"}
    asked = [each for each in found if each.result == "agrees"]
    assert len(asked) > 30
    assert all(each.bar for each in found if each.result == "not run")
    wire.close()
    assert card.send("PROG3\rLIST\rSYS\r") == listed
    assert card.send("MEM\rATTACH\rCONFIG\r") == settings
    assert (card.p[7], card.p[8]) == (5, 0)
    assert set(re.findall(rb"^[A-Z]+", wire.typed.replace(b"\r", b"\n"), re.M)) <= {
        b"SYS", b"PROG", b"PLC", b"PRINT"
    }  # fmt: skip


def test_answers_that_arrive_byte_by_byte_are_the_same() -> None:
    found = outcomes(SlowWire(in_use()), "communication", "evaluation")
    assert [each.result for each in found] == [
        each.result for each in outcomes(Wire(in_use()), "communication", "evaluation")
    ]


@pytest.mark.parametrize(
    ("pattern", "becomes"),
    [(rb"\r\n7\r\n", b"\r\n8\r\n"), (rb"\r\n7\r\n", b"\r\n"), (rb"\r\n7\r\n", b"\r\n7\r\n7\r\n")],
)
def test_each_answer_that_is_changed_on_the_wire_differs(pattern: bytes, becomes: bytes) -> None:
    honest = outcomes(Wire(in_use()), "evaluation")
    found = outcomes(Wire(in_use(), pattern, becomes), "evaluation")
    wrong = [each.case.name for each in found if each.result == "differs"]
    seven = [
        each.case.name
        for each in honest
        if each.result == "agrees" and each.case.name.endswith(", 7]")
    ]
    assert wrong == seven and len(seven) >= 2
    first = next(each for each in found if each.difference)
    assert first.data()["expected"] == "7"
    assert first.data()["shown"] != "7"


def test_a_card_without_a_prompt_and_one_that_is_gone_end_the_run() -> None:
    with pytest.raises(GarbledError, match="garbled reply to SYS"):
        outcomes(Wire(in_use(), rb"SYS>", b"?"), "evaluation")
    wire = Wire(in_use())
    wire.open()
    running = on_card_in_use(chosen(supplied(), ["evaluation"]), HostCard(wire), "")
    next(each for each in running if not each.bar)
    wire.close()
    with pytest.raises(ConnectionLostError):
        list(running)


def test_a_card_is_occupied_while_a_program_runs_or_an_axis_moves() -> None:
    card = in_use()
    card.send("DIM PLC0(500)\rPLC0\rLD 1\rOUT 40\rEND\rSYS\rRUN PLC0\r")
    with Card.open(card) as host:
        assert occupation(host) == ""  # PLCs are scanned always
        card.send("PROG3\rNEW\r10 GOTO 10\rRUN\r")
        assert occupation(host) == "PROG3 runs"
        card.send("HALT\rSYS\r")
        card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS1 "X"\rPPU X1000\rACC 10\rVEL 1\rX5\r')
        assert occupation(host) == "master 0 has moves"
        card.advance(seconds=10)
        card.send("JOG VEL X1\rJOG FWD X\r")
        assert occupation(host) == "axis 1 moves"


def test_cases_of_one_model_do_not_run_on_another(tmp_path: Path) -> None:
    head = "[case A]\nsource: 000 L7\nrests on: manual\nmodel: {}\n> VER\n...\n"
    (tmp_path / "one.txt").write_text(head.format("ACR8020"))
    (found,) = on_virtual_card(chosen(tmp_path, []), "ACR9000")
    assert (found.result, found.bar) == ("not for this model", "it is about the ACR8020")
    (found,) = on_virtual_card(chosen(tmp_path, []), "ACR8020")
    assert found.result == "agrees"


def test_sections_and_ids_are_chosen_by_words(tmp_path: Path) -> None:
    folder = tmp_path / "guide"
    folder.mkdir()
    for name, claim in (("01-limits", "ACR-LIM-01"), ("02-jogs", "ACR-JOG-01"), ("03-jog", "")):
        head = f"[case A]\nsource: 000 L7\nrests on: manual\n{f'proves: {claim}' if claim else ''}"
        (folder / f"{name}.txt").write_text(f"{head}\n> ?1\n1\n")
    found = [case.path.stem for case in chosen(tmp_path, ["LIMITS", "acr-jog"])]
    assert found == ["01-limits", "02-jogs"]
    assert len(chosen(tmp_path, ["guide"])) == len(chosen(tmp_path, [])) == 3
    with pytest.raises(UserError, match="--area weather: the sections are limits, jogs, jog; or"):
        chosen(tmp_path, ["limits", "weather"])
