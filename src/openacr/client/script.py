"""A scripted terminal session: lines in, everything the card sends out.

Each line is sent after the prompt of the one before it. Where no prompt can be expected
(prompts turned off by ECHO, a control key next) the card gets QUIET_S of silence instead.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from openacr.channels import EchoMode
from openacr.client.errors import NoReplyError
from openacr.client.links import Link

QUIET_S = 0.3
ESC = b"\x1b"
_PROMPT = re.compile(rb"(?:^|\n)(?:SYS|P\d\d|PLC\d+)>$")
_ECHO = re.compile(rb"(?:^|:)\s*ECHO\s*(\d+)", re.IGNORECASE)
_KEYS = re.compile(rb"[\x18\x19\x1a\x1b]+")


@dataclass(slots=True)
class Script:
    """Sends lines over a link and passes on the replies."""

    link: Link
    show: Callable[[bytes], None]
    wait_s: float
    _prompts: bool = True

    def run(self, lines: Iterable[bytes]) -> None:
        """Send every line and wait for its reply; NoReplyError, ConnectionLostError."""
        waiting: bytes | None = None
        for line in lines:
            keys = _KEYS.fullmatch(line) is not None
            if waiting is not None:
                self._finish(waiting, interrupted=keys)
            self.link.write(line if keys else line + b"\r")
            waiting = line
        if waiting is not None:
            self._finish(waiting, interrupted=False)

    def _finish(self, line: bytes, *, interrupted: bool) -> None:
        """Take the reply to `line`."""
        echo = _ECHO.search(line)
        if echo is not None:
            self._prompts = not int(echo[1]) & EchoMode.NO_PROMPT
        silent_key = _KEYS.fullmatch(line) is not None and ESC not in line
        if interrupted or silent_key or not self._prompts:
            self._until_quiet(line)
        else:
            self._until_prompt(line)

    def _until_quiet(self, line: bytes) -> None:
        deadline_s = self.link.now_s() + self.wait_s
        while data := self.link.read(QUIET_S):
            self.show(data)
            self._left_s(deadline_s, line)

    def _until_prompt(self, line: bytes) -> None:
        seen = b""
        deadline_s = self.link.now_s() + self.wait_s
        while not _PROMPT.search(seen):
            data = self.link.read(self._left_s(deadline_s, line))
            self.show(data)
            seen = (seen + data)[-64:]

    def _left_s(self, deadline_s: float, line: bytes) -> float:
        """Time left for the reply; NoReplyError when it has expired."""
        left_s = deadline_s - self.link.now_s()
        if left_s <= 0:
            raise NoReplyError(self.link.name, line.decode("utf-8", "replace"), self.wait_s)
        return left_s
