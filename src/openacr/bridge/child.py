"""The process of a bridge: `python -m openacr.bridge.child`, started by a panel with pipes.

It ends its systems when the panel asks for it. When its input ends without that, the panel was
killed, and the process ends at once: hosts learn of it by their lost connections, as they do of any
process that was killed.
"""

import logging
import os
import sys
import threading
from pathlib import Path
from typing import BinaryIO

from openacr.bridge.bridge import Bridge
from openacr.bridge.messages import (
    HEAD,
    Begin,
    End,
    Failed,
    FromProcess,
    Logged,
    Opened,
    Reading,
    Taken,
    ToProcess,
    Written,
    framed,
    length_of,
    to_process,
)
from openacr.bridge.pipe_feed import PipeFeed
from openacr.bridge.systems import bridge_of
from openacr.errors import OpenacrError


class Pipe:
    """The two pipes to the panel. Any thread may send."""

    def __init__(self, source: BinaryIO, drain: BinaryIO) -> None:
        self._source, self._drain = source, drain
        self._lock = threading.Lock()

    def send(self, message: FromProcess) -> None:
        """Send a message; the other pipe tells of a panel that has gone."""
        try:
            with self._lock:
                self._drain.write(framed(message))
                self._drain.flush()
        except (OSError, ValueError):
            pass

    def next(self) -> ToProcess | None:
        """The next message; None at the end of the panel."""
        try:
            head = self._source.read(HEAD.size)
            data = self._source.read(length_of(head)) if len(head) == HEAD.size else b""
            return to_process(data) if data else None
        except (OSError, ValueError):
            return None


class ToPanel(logging.Handler):
    """Sends the log to the panel, which has it among its own lines."""

    def __init__(self, pipe: Pipe) -> None:
        super().__init__()
        self._pipe = pipe

    def emit(self, record: logging.LogRecord) -> None:
        """Send a line."""
        self._pipe.send(Logged(record.levelno, record.name, self.format(record)))


def serve(pipe: Pipe) -> bool:
    """Publish what comes; whether the panel has asked for the end, and was not killed."""
    begin = pipe.next()
    if not isinstance(begin, Begin):
        return False
    logging.basicConfig(level=begin.log_level, handlers=[ToPanel(pipe)], format="%(message)s")
    feed = PipeFeed(begin.axes, pipe.send)
    try:
        bridge = bridge_of(begin.file, Path(begin.folder), feed)
    except OpenacrError as error:
        pipe.send(Failed(str(error)))
        return False
    threading.Thread(target=_open, args=(bridge, pipe), daemon=True).start()
    is_asked = _take(pipe, feed)
    if is_asked:
        bridge.stop()
    return is_asked


def _open(bridge: Bridge, pipe: Pipe) -> None:
    """Begin, while values come already."""
    try:
        bridge.start()
    except OpenacrError as error:
        pipe.send(Failed(str(error)))
    else:
        pipe.send(Opened(tuple(bridge.places)))


def _take(pipe: Pipe, feed: PipeFeed) -> bool:
    """Take over what comes until the panel ends; whether it has asked for a proper end."""
    while (message := pipe.next()) is not None:
        match message:
            case Reading(moment):
                feed.take(moment)
                pipe.send(Taken())
            case Written():
                feed.finish(message)
            case End():
                return True
    return False


def main() -> None:
    """Serve on the pipes; what libraries print goes where errors go."""
    drain = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    is_asked = serve(Pipe(sys.stdin.buffer, drain))
    os._exit(not is_asked)  # threads of libraries hold no process that has ended


if __name__ == "__main__":
    main()
