"""`openacr term` on Windows: keys of the console, without its module."""

import sys
from collections import deque
from types import SimpleNamespace

import pytest
from tests.client.cards import WrappedLink

from openacr.cli.live import console, term
from openacr.client.links import SerialLink, wire_to
from openacr.controller import Controller
from openacr.io.keyboard import Keyboard


class FakeConsole:
    """Keys as `msvcrt` delivers them."""

    def __init__(self, keys: str) -> None:
        self.keys = deque(keys)

    def kbhit(self) -> bool:
        return bool(self.keys)

    def getwch(self) -> str:
        return self.keys.popleft()


@pytest.mark.parametrize(
    ("keys", "codes"),
    [
        ("", b""),
        ("X5\r", b"X5\r"),
        ("\x18\x19\x1a", b"\x18\x19\x1a"),
        ("\xe0H\x00P", b"\x1b[A\x1b[B"),
        ("a\xe0Kb\x00;c", b"abc"),  # arrow left and F1 have no meaning
        ("\xe4\u20ac", b"\xe4"),
    ],
)
def test_keys_arrive_as_a_terminal_sends_them(keys: str, codes: bytes) -> None:
    assert console.waiting_keys(FakeConsole(keys)) == codes


def test_a_lone_escape_is_the_last_of_the_keys_of_one_turn() -> None:
    keys = FakeConsole("a\x1bH")
    assert console.waiting_keys(keys) == b"a\x1b"
    assert console.waiting_keys(keys) == b"H"


def test_a_session_passes_keys_and_shows_the_answers(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    link = WrappedLink(Controller())
    link.open()
    keys = FakeConsole("?6*7\r")
    polls = iter(range(100))

    def kbhit() -> bool:
        if next(polls) == 50:
            keys.keys.append("\x03")
        return keys.kbhit()

    fake = SimpleNamespace(kbhit=kbhit, getwch=keys.getwch)
    monkeypatch.setitem(sys.modules, "msvcrt", fake)
    console.exchange(link, Keyboard())
    shown = capsys.readouterr().out.replace("\r", "")
    assert shown.endswith("SYS>?6*7\n42\nSYS>")


def test_a_system_without_raw_terminals_uses_the_console(monkeypatch: pytest.MonkeyPatch) -> None:
    used = []
    monkeypatch.setattr(term, "find_spec", lambda name: None)
    monkeypatch.setattr(console, "exchange", lambda link, keyboard: used.append(link))
    monkeypatch.setattr(term, "_save_history", lambda lines: None)
    link = WrappedLink(Controller())
    term._interactive(link)  # type: ignore[arg-type]
    assert used == [link]


@pytest.mark.parametrize("name", ["COM3", "com12", r"\\.\COM12"])
def test_serial_ports_of_windows_are_known_by_their_names(name: str) -> None:
    found = wire_to(name)
    assert isinstance(found, SerialLink) and found.name == name
