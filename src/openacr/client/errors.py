"""Errors between a host and a card, as types whose fields give the details."""

import re

from openacr.errors import OpenacrError, SourceError
from openacr.messages import (
    MESSAGES,
    OK,
    PROGRAM_IS_RUNNING,
    REDIMENSIONED_BLOCK,
    SLAVE_KILL_ACTIVE,
    UNKNOWN_COMMAND,
    Message,
)

_TEXTS = [
    (re.compile(re.escape(message.text).replace(r"\{\}", ".*")), message)
    for message in MESSAGES.values()
    if message is not OK
]
_HINTS = {
    UNKNOWN_COMMAND: "moves and profile settings need a program level",
    PROGRAM_IS_RUNNING: "halt it first",
    REDIMENSIONED_BLOCK: "NEW ALL and CLEAR at the SYS level free the memory",
    SLAVE_KILL_ACTIVE: "Ctrl-Y (clear_kills) allows the axes to move again",
}


class ClientError(OpenacrError):
    """Base of everything the client reports."""


class RefusedError(ClientError):
    """The card has answered a line with an error: `line` was sent, `text` came back."""

    def __init__(self, line: str, text: str, hint: str = "") -> None:
        self.line, self.text = line, text
        self.message = message_of(text)
        self.hint = hint or _HINTS.get(self.message or OK, "")
        super().__init__(f"{line}: {text}" + (f" ({self.hint})" if self.hint else ""))


class NoReplyError(ClientError, TimeoutError):
    """The card did not answer in time; `is_begun`: it did not finish its answer."""

    def __init__(self, link: str, sent: str, wait_s: float, *, is_begun: bool = False) -> None:
        self.sent, self.is_begun = sent, is_begun
        what = "no end of the reply" if is_begun else "no reply"
        within = f"{round(wait_s, 2):g} s"
        super().__init__(
            f"{link}: {what} within {within} to {sent} (check that the card's terminal is"
            " reachable and not in use; lines that wait, such as DWL, INH or a move with a full"
            " buffer, need a longer time-out)"
        )


class GarbledError(ClientError):
    """The reply does not match the request: noise on the line, or another host using it."""

    def __init__(self, link: str, sent: str, received: bytes) -> None:
        self.sent, self.received = sent, received
        super().__init__(f"{link}: garbled reply to {sent}: {received[:60]!r}")


class ConnectionLostError(ClientError, ConnectionError):
    """The connection is lost; a command in transit may or may not have been executed."""


class DownloadError(ClientError, SourceError):
    """The card has refused a line of a file; nothing after that line was sent."""


class ChangedError(ClientError):
    """What a card holds is no longer what was read of it."""


class VerificationError(ClientError, SourceError):
    """The listing of the card differs from what was sent."""


class RestoreError(ClientError):
    """A backup could not be restored; `former` is the previous contents, as files by name.

    `is_back`: the card has its former contents again.
    """

    def __init__(
        self, failure: BaseException, former: dict[str, str], second: BaseException | None = None
    ) -> None:
        self.failure, self.former, self.is_back = failure, former, second is None
        ended = str(failure) or "interrupted"
        if second is None:
            super().__init__(f"{ended}; the card has its former contents again")
        else:
            super().__init__(
                f"{ended}; the former contents could not be restored either:"
                f" {str(second) or 'interrupted'}"
            )


def message_of(text: str) -> Message | None:
    """The card's known message with this text."""
    found = (message for pattern, message in _TEXTS if pattern.fullmatch(text))
    return next(found, None)
