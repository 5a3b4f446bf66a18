"""A line between two ends that can be frozen in one direction, cut, mended and reset."""

import socket
import struct
import threading
from contextlib import suppress

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
            while data := source.recv(65536):
                flows.wait()
                sink.sendall(data)
                self.passed += len(data)
        with suppress(OSError):
            sink.shutdown(socket.SHUT_WR)

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
