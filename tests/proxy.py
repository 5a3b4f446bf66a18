"""A line between two ends that can be frozen in one direction, cut, mended and reset."""

import math
import socket
import struct
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from queue import SimpleQueue

from openacr.closing import Closing


class Proxy(Closing):
    """A port that leads to another one; `freeze_*` holds bytes back without a word to any end."""

    def __init__(self, address: str) -> None:
        host, port = address.rsplit(":", 1)
        self._target = (host, int(port))
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._server.getsockname()[1])
        self._up, self._down = threading.Event(), threading.Event()
        self._up.set()
        self._down.set()
        self._pairs: list[tuple[socket.socket, socket.socket]] = []
        self._changes = threading.Lock()  # of the pairs: they are made in the thread
        self._is_cut = self._is_over = False
        self._late_s, self._bytes_per_s = 0.0, math.inf
        self.passed = 0  # bytes, in both directions
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def address(self) -> str:
        return f"127.0.0.1:{self.port}"

    @property
    def url(self) -> str:
        return f"http://{self.address}"

    @property
    def ws_url(self) -> str:
        return f"ws://{self.address}/ws"

    def close(self) -> None:
        """End the line."""
        self._is_over = True
        self.thaw()
        self._server.close()
        self._close()

    def _accept(self) -> None:
        while not self._is_over:
            try:
                near, _ = self._server.accept()
            except OSError:
                return
            if self._is_cut:
                near.close()
                continue
            try:
                far = socket.create_connection(self._target)
            except OSError:  # what it stands for has ended
                near.close()
                continue
            for end in (near, far):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with self._changes:
                self._pairs.append((near, far))
            if self._is_cut or self._is_over:  # meanwhile
                self._close()
                continue
            for source, sink, flows in ((near, far, self._up), (far, near, self._down)):
                threading.Thread(target=self._copy, args=(source, sink, flows), daemon=True).start()

    def _copy(self, source: socket.socket, sink: socket.socket, flows: threading.Event) -> None:
        with suppress(OSError):
            for data in self._pieces(source):
                flows.wait()
                sink.sendall(data)
                self.passed += len(data)
        with suppress(OSError):
            sink.shutdown(socket.SHUT_WR)

    def _pieces(self, source: socket.socket) -> Iterator[bytes]:
        """What comes from an end; on a slow line each piece later, and one after the other."""
        if not self._late_s:
            yield from iter(lambda: source.recv(65536), b"")
            return
        coming: SimpleQueue[tuple[float, bytes]] = SimpleQueue()
        threading.Thread(target=self._read, args=(source, coming), daemon=True).start()
        free_s = 0.0
        while (piece := coming.get())[1]:
            due_s, data = piece
            free_s = max(free_s, due_s) + len(data) / self._bytes_per_s
            time.sleep(max(0.0, free_s - time.monotonic()))
            yield data

    def _read(self, source: socket.socket, coming: "SimpleQueue[tuple[float, bytes]]") -> None:
        with suppress(OSError):
            while data := source.recv(4096):
                coming.put((time.monotonic() + self._late_s, data))
        coming.put((0.0, b""))

    def slow(self, late_s: float, bytes_per_s: float) -> None:
        """Connections that are made from now on are slow in both directions."""
        self._late_s, self._bytes_per_s = late_s, bytes_per_s

    def freeze_up(self) -> None:
        """Nothing more reaches the far end."""
        self._up.clear()

    def freeze_down(self) -> None:
        """Nothing more comes from the far end."""
        self._down.clear()

    def freeze(self) -> None:
        """Nothing goes through."""
        self.freeze_up()
        self.freeze_down()

    def thaw(self) -> None:
        """What was held back arrives, and all that follows."""
        self._up.set()
        self._down.set()

    def cut(self) -> None:
        """Both ends are closed, and no new connection is made."""
        self._is_cut = True
        self._close()

    def mend(self) -> None:
        """Connections may be made again."""
        self._is_cut = False

    def reset(self) -> None:
        """Both ends get a reset; a new connection may be made at once."""
        self._close(linger=struct.pack("ii", 1, 0))

    def _close(self, linger: bytes | None = None) -> None:
        with self._changes:
            pairs, self._pairs = self._pairs, []
        for end in (end for pair in pairs for end in pair):
            with suppress(OSError):
                if linger is not None:
                    end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
                end.shutdown(socket.SHUT_RDWR)
            end.close()
