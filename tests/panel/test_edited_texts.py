"""Texts of controller files in the editor: questions, versions, comparing, sending."""

from collections.abc import Iterator
from functools import partial
from itertools import count
from typing import Any

import httpx
import pytest
from tests.panel.bench import HandStation, Served

from openacr.client import Level
from openacr.client.stored import ListedLine, listing, version_of
from openacr.panel.work import desk as desks
from openacr.panel.work.comparing import compared
from openacr.panel.work.desk import State
from openacr.panel.work.text_questions import About, answer, desk

SETUP = (
    "SYS\nDIM P(100)\nDIM PROG3(5000)\n#DEFINE SPEED P0\nATTACH AXIS0 ENC0 DAC0 ENC0\n"
    'PROG3\nATTACH SLAVE0 AXIS0 "X"\n'
)
TEXT = (
    "PROGRAM\nDIM LV(1)\n_more\nLV0 = LV0+1 ' \U0001d11e and on\nX 10\nNOWORD 5\nGOTO more\nENDP\n"
)
MARKS = map("text-{:04}".format, count())


class Editor:
    """A text as a browser edits it, asked in this process."""

    def __init__(self, text: str = TEXT, name: str = "prog3.8k", setup: str = SETUP) -> None:
        self.mark, self.name, self.version = next(MARKS), name, 1
        assert self.send(State(self.mark, name, 1, text=text, setup=setup)) == []

    def send(self, state: State, ask: str = "colors", **about: Any) -> Any:
        found = answer(state, ask, About(**{"last": -1, **about}))
        return found.get("answer") if "refusal" not in found and "stale" not in found else found

    def ask(self, question: str, line: int = 0, column: int = 0, **about: Any) -> Any:
        state = State(self.mark, self.name, self.version, self.version)
        return self.send(state, question, line=line, column=column, **about)

    def change(self, *changes: desks.Change, base: int | None = None) -> Any:
        base = self.version if base is None else base
        self.version += 1
        return self.send(State(self.mark, self.name, self.version, base, changes=changes))

    @property
    def text(self) -> str:
        opened = desk().at(State(self.mark, self.name, self.version, self.version))
        assert opened is not None
        return opened.document.text


def test_the_parts_of_lines_have_kinds_and_columns_in_16_bit_units() -> None:
    editor = Editor()
    assert editor.ask("colors", 3, last=4) == [
        [3, 0, 3, "variable"], [3, 6, 9, "variable"], [3, 10, 11, "number"],
        [3, 12, 23, "remark"], [4, 0, 1, "axis"], [4, 2, 4, "number"],
    ]  # fmt: skip


def test_numbers_of_parameters_and_flags_are_explained_after_them_in_16_bit_units() -> None:
    editor = Editor('PROGRAM\nPRINT "\U0001d11e",P12288\nSET BIT792\nP12544 = 0\nENDP\n')
    hints = editor.ask("hints", 1, last=2)
    assert hints == [[1, 17, "AXIS 0: Current Position"], [2, 10, hints[1][2]]]
    assert "Jog Active" in hints[1][2]


def test_what_has_a_value_is_named_line_by_line_and_expressions_are_not() -> None:
    text = (
        "PROGRAM\nDIM LV(2)\nLV0 = SPEED + LA0( 3 ) + LA1(LV0) ' P9\nDWL 1\n"
        "IF (P12288 > SV2) THEN SET BIT 130 : SPEED = P0 + P(LV0)\nENDP\n"
    )
    assert Editor(text).ask("values", 1, last=9) == [
        (2, "PROG3", [("LV0", "LV0"), ("SPEED", "P0"), ("LA0(3)", "LA0(3)")]),
        (4, "PROG3", [("P12288", "P12288"), ("SV2", "SV2"), ("BIT130", "BIT130"), ("SPEED", "P0"),
                      ("LV0", "LV0")]),
    ]  # fmt: skip
    assert Editor(text).ask("values", 0, last=1) == []
    plc = Editor("LD 5\nAND NOT gripper\nOUT 41\n", "plc2.8k", "#DEFINE gripper BIT33\n")
    assert plc.ask("values", 1, last=2) == [
        (1, "PLC2", [("gripper", "BIT33")]), (2, "PLC2", [("BIT41", "BIT41")]),
    ]  # fmt: skip


def test_programs_blocks_and_remarks_fold() -> None:
    text = "' one\n' two\nPROGRAM\nIF (P0 = 1)\nDWL 1\nENDIF\nENDP\n"
    editor = Editor(text, name="setup.8k")
    assert editor.ask("folds") == [[0, 1], [2, 6], [3, 5]]
    editor.change((3, 0, 3, 0, "X 1\n"))
    assert editor.ask("folds") == [[0, 1], [2, 7], [4, 6]]


def test_findings_name_the_place_and_what_mends_it() -> None:
    assert Editor(TEXT.replace("NOWORD", "GOSUP")).ask("findings") == {
        "findings": [
            {
                "span": [5, 0, 5, 5],
                "text": "Unknown command (did you mean GOSUB?)",
                "is_warning": False,
                "fix": {"title": "Write GOSUB", "edits": [[5, 0, 5, 5, "GOSUB"]]},
            }
        ],
        "more": 0,
    }


def test_names_and_memory_of_the_card_are_known_to_its_programs() -> None:
    editor = Editor("PROGRAM\nX 10\nSPEED = 2\nY 5\nENDP\n")
    assert [each["span"] for each in editor.ask("findings")["findings"]] == [[3, 0, 3, 1]]
    assert editor.ask("definitions", 2, 1) == {"places": [], "other": 1}
    assert editor.ask("rename", 2, 1, word="PACE") == {
        "version": 1, "answer": None,
        "refusal": "this name is defined on the card, not in this text: rename it there",
    }  # fmt: skip


def test_completion_hover_and_signature_are_those_of_the_language_server() -> None:
    editor = Editor("PROGRAM\nDWL\nDWL 5\nGOTO\n_more\nENDP\n")
    found = editor.ask("complete", 1, 3)
    assert found["span"] == [1, 0, 1, 3]
    assert [(each["label"], each["kind"], each["text"]) for each in found["items"]] == [
        ("DWL", "command", "DWL")
    ]
    assert found["items"][0]["doc"].startswith("**DWL")
    shown = editor.ask("hover", 2, 1)
    assert (shown["span"], shown["text"]) == ([2, 0, 2, 3], found["items"][0]["doc"])
    assert editor.ask("hover", 2, 50) is None or editor.ask("hover", 2, 50)["span"] == [2, 4, 2, 5]
    assert editor.ask("signature", 2, 5)["label"].startswith("DWL")


def test_a_label_is_found_and_renamed_everywhere() -> None:
    editor = Editor()
    assert [each["span"] for each in editor.ask("references", 6, 6)["places"]] == [
        [2, 1, 2, 5], [6, 5, 6, 9],
    ]  # fmt: skip
    assert editor.ask("definitions", 6, 6) == {
        "places": [{"span": [2, 1, 2, 5], "text": "_more"}], "other": 0,
    }  # fmt: skip
    assert editor.ask("renamable", 6, 6) == {"span": [6, 5, 6, 9], "text": "more"}
    assert editor.ask("renamable", 3, 0) is None
    assert editor.ask("rename", 6, 6, word="again") == [
        [2, 1, 2, 5, "again"], [6, 5, 6, 9, "again"],
    ]  # fmt: skip
    refused = editor.ask("rename", 6, 6, word="5x")
    assert refused["refusal"] == ("5x: a label has up to 32 letters and digits, a letter first")


def test_the_outline_holds_programs_with_their_labels() -> None:
    editor = Editor("SYS\nDIM PROG3(500)\nPROG3\nPROGRAM\n_go\nENDP\nPLC0\n", "all.8k", "")
    assert editor.ask("outline") == [
        {"name": "PROG3", "detail": "", "line": 2, "parts": [
            {"name": "go", "detail": "label", "line": 4, "parts": []}]},
        {"name": "PLC0", "detail": "", "line": 6, "parts": []},
    ]  # fmt: skip


def test_formatting_writes_lines_as_list_shows_them() -> None:
    assert Editor("PROGRAM\nX 10\nENDP\n").ask("formatted") == [[1, 0, 1, 4, " X10"]]


def test_stored_lines_are_known_by_their_numbers_on_the_card() -> None:
    free = Editor("PROGRAM\n' not stored\n\nDWL 5\nENDP\n")
    assert free.ask("stored")["PROG3"] == [[10, 0], [20, 3], [30, 4]]
    whole = "SYS\nPROG3\nPROGRAM\nDWL 5\nENDP\nPLC0\n15 LD 5\n20 OUT 6\n"
    assert Editor(whole, "all.8k", "").ask("stored") == {
        "PROG3": [[10, 2], [20, 3], [30, 4]], "PLC0": [[15, 6], [20, 7]],
    }  # fmt: skip


def test_changes_are_taken_one_after_the_other_in_16_bit_units() -> None:
    editor = Editor("' \U0001d11e: a\nsecond\nthird\n")
    assert editor.change((0, 6, 0, 7, "b"), (1, 0, 2, 0, "")) == []
    assert editor.text == "' \U0001d11e: b\nthird\n"
    assert editor.change((1, 5, 1, 5, "\nlast")) == []
    assert editor.text == "' \U0001d11e: b\nthird\nlast\n"


def test_a_text_is_asked_for_whole_where_it_is_not_known_in_that_version() -> None:
    editor = Editor("one\n")
    assert editor.change((0, 0, 0, 0, "x"), base=0) == {"stale": True}
    editor.version = 1
    assert editor.text == "one\n"  # nothing was changed
    unknown = State("never-seen-0", "prog3.8k", 2, 1)
    assert answer(unknown, "colors", About()) == {"stale": True}
    assert compared(unknown, {}) == {"stale": True}


def test_the_text_that_was_not_used_longest_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desks, "MOST_OPEN", 2)
    desk.cache_clear()
    first, second = Editor("1\n"), Editor("2\n")
    assert first.text == "1\n"
    third = Editor("3\n")
    assert second.ask("colors") == {"stale": True}
    assert (first.text, third.text) == ("1\n", "3\n")
    desk.cache_clear()


def rows(editor: Editor, name: str, *listed: tuple[int, str]) -> Any:
    state = State(editor.mark, editor.name, editor.version, editor.version)
    lines = [ListedLine(*each) for each in listed]
    found = compared(state, {name: lines})["answer"][0]
    assert found["name"] == name
    return found["is_equal"], [tuple(row) for row in found["rows"]]


def test_a_text_is_compared_by_what_its_lines_mean() -> None:
    editor = Editor("PROGRAM\nx 10\n' left out\nDWL 5\nENDP\n")
    same = ((10, "PROGRAM"), (20, " X10"), (30, " DWL 5"), (40, "ENDP"))
    assert rows(editor, "PROG3", *same)[0]
    assert rows(editor, "PROG3", *same[:1], (20, " X11"), (30, " Z1"), *same[2:]) == (False, [
        (1, "PROGRAM", 10, "PROGRAM", True), (2, "x 10", 20, " X11", False),
        (0, "", 30, " Z1", False), (4, "DWL 5", 30, " DWL 5", True), (5, "ENDP", 40, "ENDP", True),
    ])  # fmt: skip
    numbered = Editor("10 P0 = 1\n20 P1 = 1\n")
    assert rows(numbered, "PROG3", (10, "P0=1"), (20, "P1 = 1"))[0]
    assert not rows(numbered, "PROG3", (10, "P0=1"), (25, "P1 = 1"))[0]
    assert rows(numbered, "PROG4", (10, "P0=1")) == (False, [(0, "", 10, "P0=1", False)])


# --- to the card ----------------------------------------------------------------------


def lines_of(hand: HandStation, level: Level) -> list[ListedLine]:
    future = hand.station.on_card.aside.begin(lambda talk: listing(talk, level))
    hand.until(future.done)
    return future.result()


def test_a_text_replaces_only_the_listing_that_it_was_made_of(hand: HandStation) -> None:
    hand.do("card.send", program=3, text="10 P0 = 1\n")
    version = version_of(lines_of(hand, Level.program(3)))
    hand.do("card.send", program=3, text="10 P0 = 2\n", version=version)
    error = hand.refused("card.send", program=3, text="10 P0 = 3\n", version=version)
    assert error == {
        "code": "conflict", "text": "PROG3 was changed on the card since it was read",
    }  # fmt: skip
    assert lines_of(hand, Level.program(3)) == [ListedLine(10, "P0 = 2")]
    hand.do("card.send", program=3, text="10 P0 = 3\n")  # overwritten on purpose
    assert lines_of(hand, Level.program(3)) == [ListedLine(10, "P0 = 3")]


def test_a_refused_line_is_named_by_its_number_in_the_text(hand: HandStation) -> None:
    error = hand.refused("card.send", program=3, text="PROGRAM\n\nNOWORD 5\nENDP\n")
    assert (error["code"], error["line"]) == ("refused", 3)


def test_a_parked_text_is_sent_by_its_mark(hand: HandStation) -> None:
    parked = hand.station.on_card.parked
    mark = parked.put("10 P0 = 7\n")
    hand.do("card.send", program=3, parked=mark)
    assert lines_of(hand, Level.program(3)) == [ListedLine(10, "P0 = 7")]
    for number in range(10, 18):
        parked.put(f"10 P0 = {number}\n")
    error = hand.refused("card.send", program=3, parked=mark)
    assert error["text"] == "the text is no longer here: send it again"


def test_a_file_is_sent_line_by_line_with_what_the_card_remarks(hand: HandStation) -> None:
    put = hand.station.on_card.parked.put
    mark = put("SYS\nDIM PLC1(500)\nPROG3\nPROGRAM\nP0 = 4\nENDP\nVER\n")
    done = hand.do("card.download", parked=mark)
    assert (done["sent"], [line for line, _ in done["remarks"]]) == (7, [7])
    assert [each.text for each in lines_of(hand, Level.program(3))] == [
        "PROGRAM",
        " P0 = 4",
        "ENDP",
    ]
    error = hand.refused("card.download", parked=put("SYS\nPROG3\nNOWORD 5\n"))
    assert (error["line"], error["text"]) == (
        3, "3: Unknown command (moves and profile settings need a program level)",
    )  # fmt: skip


def test_no_file_is_sent_while_something_runs(hand: HandStation) -> None:
    mark = hand.station.on_card.parked.put("PROG4\n10 P0 = 4\n")
    hand.do("card.send", program=3, text="10 DWL 1\n20 GOTO 10\n")
    hand.do("card.run", program=3)
    assert hand.refused("card.download", parked=mark)["text"] == "PROG3 run: halt them first"
    hand.do("card.halt", program=3)
    hand.do("card.download", parked=mark)
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(0.2)
    error = hand.refused("card.download", parked=mark)
    assert error["text"] == "the machine moves: no file is sent to the card"
    hand.do("stop.all")


# --- over HTTP ------------------------------------------------------------------------


@pytest.fixture(scope="module")
def web(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Served, httpx.Client]]:
    served = Served(tmp_path_factory.mktemp("panel"))
    with httpx.Client(base_url=f"{served.url}/api", timeout=None) as client:
        yield served, client
    served.close()


def test_a_text_is_edited_compared_and_parked_over_http(web: tuple[Served, httpx.Client]) -> None:
    served, client = web
    store = partial(Level.program, 3)
    served.call(lambda s: s.link.machine.card.download("PROGRAM\nDWL 5\nENDP\n", to=store()))
    listed = client.get("/card/listing", params={"program": 3}).json()
    lines = [ListedLine(each["number"], each["text"]) for each in listed["lines"]]
    assert listed["version"] == version_of(lines)
    setup = client.get("/card/surroundings", params={"program": 3}).json()["setup"]
    assert setup.splitlines()[0] == "SYS"
    assert "DIM PROG3(" in setup and "ATTACH AXIS0 ENC0 DAC0 ENC0\n" in setup
    text = {"mark": "0123abcd", "name": "prog3.8k", "version": 1}
    whole = {**text, "text": "PROGRAM\nDWL 5\nNOWORD\nENDP\n", "setup": setup}
    found = client.post("/text", json={**whole, "ask": "findings"}).json()
    assert [each["span"] for each in found["answer"]["findings"]] == [[2, 0, 2, 6]]
    change = {**text, "version": 2, "base": 1, "changes": [[2, 0, 3, 0, ""]]}
    found = client.post("/text", json={**change, "ask": "findings"}).json()
    assert found == {"version": 2, "answer": {"findings": [], "more": 0}}
    found = client.post("/text", json={**change, "ask": "outline"}).json()
    assert found == {"stale": True}  # another process answers it
    both = client.post("/text/compare", json={**change, "programs": ["PROG3"]}).json()
    assert both["answer"][0]["is_equal"]
    assert len(client.post("/text/parked", json={"text": "10 P0 = 1\n"}).json()["parked"]) == 32


@pytest.mark.parametrize(
    "wrong",
    [
        {"name": "../prog3.8k"}, {"name": "a/b.8k"}, {"name": "setup.txt"}, {"mark": "../../etc"},
        {"programs": ["PROG16"]}, {"programs": ["PLC8"]}, {"programs": ["SYS"]},
    ],
)  # fmt: skip
def test_names_lead_out_of_no_folder(
    web: tuple[Served, httpx.Client], wrong: dict[str, Any]
) -> None:
    text = {"mark": "0123abcd", "name": "prog3.8k", "version": 1, "text": "", "programs": []}
    answered = web[1].post("/text/compare", json={**text, **wrong})
    assert (answered.status_code, answered.json()["error"]["code"]) == (400, "bad")
