"""Standard input as a stream of the loop.

A thread reads ahead, so that a request can be withdrawn while it waits for its turn; and a
message is taken from it at once, where a thread for each line (as in pygls) would wait for a
check to give way.
"""

from __future__ import annotations

import asyncio
import threading
from typing import IO

MOST_BYTES = 1 << 16  # at once


def stream_of(file: IO[bytes]) -> asyncio.StreamReader:
    """What is read from an unbuffered file; to be called while the loop runs."""
    reader = asyncio.StreamReader()
    loop = asyncio.get_running_loop()
    threading.Thread(target=_read, args=(file, reader, loop), daemon=True).start()
    return reader


def _read(file: IO[bytes], reader: asyncio.StreamReader, loop: asyncio.AbstractEventLoop) -> None:
    try:
        while data := file.read(MOST_BYTES):
            loop.call_soon_threadsafe(reader.feed_data, data)
        loop.call_soon_threadsafe(reader.feed_eof)
    except RuntimeError:  # the loop has ended before its input
        pass
