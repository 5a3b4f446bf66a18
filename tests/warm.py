"""`openacr` as a process that need not import anything: it is forked from one that has.

A start of Python with all modules of a panel takes a second of the processor, and several hundred
tests need a process. What a start imports, and what its files are called, is tested cold.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import io
import json
import os
import select
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
IMPORTED = (
    "openacr.cli.main", "openacr.cli.debug", "openacr.cli.lsp", "openacr.cli.mill",
    "openacr.cli.panel", "openacr.cli.record", "openacr.cli.run", "openacr.cli.serve",
    "openacr.cli.sweep", "openacr.controller.replay", "openacr.debugger.server",
    "openacr.debugger.real_cards", "openacr.language_server.server", "openacr.mill.session",
    "openacr.panel.server.web", "openacr.project", "openacr.bridge.process",
)  # fmt: skip
IMPORTED_BY_WORKERS = (
    "openacr.panel.work.tuning", "openacr.panel.control.engineer.tuning",
    "openacr.panel.server.web", "openacr.sweep.campaign", "openacr.verify.checking",
    "scipy.optimize",
)  # fmt: skip
LENGTH = struct.Struct("<I")
MOST_FDS = 4  # standard streams, and where the number of the process and its end are written
CAN_FORK = hasattr(os, "fork") and hasattr(socket, "send_fds")


class Popen(subprocess.Popen[Any]):
    """`openacr WORDS` with the interface of a process; the options are those of subprocess."""

    def __init__(
        self, words: Sequence[str | Path], *, most_bytes: int | None = None, **options: Any
    ) -> None:
        """`most_bytes`: of a file it may write."""
        self._most_bytes = most_bytes
        self._keeper = -1
        self._heard = b""
        command = ["openacr"] if CAN_FORK else [sys.executable, "-m", "openacr"]
        super().__init__([*command, *map(str, words)], **options)

    if CAN_FORK:

        def _execute_child(self, args: Any, *given: Any) -> None:
            """Have it forked; its streams are those subprocess has made."""
            _, _, _, _, cwd, env, _, _, _, *ends = given[:15]
            p2cread, p2cwrite, c2pread, c2pwrite, errread, errwrite = ends
            self._keeper, report = os.pipe()
            own = (p2cread, c2pwrite, errwrite)
            streams = [k if end == -1 else end for k, end in enumerate(own)]
            order = {
                "words": args[1:],
                "cwd": os.fspath(cwd or os.getcwd()),
                "env": dict(os.environ if env is None else env),
                "most_bytes": self._most_bytes,
            }
            try:
                _server().begin(order, [*streams, report])
            finally:
                os.close(report)
            self._child_created = True
            self._close_pipe_fds(p2cread, p2cwrite, c2pread, c2pwrite, errread, errwrite)  # type: ignore[attr-defined]
            self.pid = int(self._line(None) or b"0")

        def _internal_poll(self, _deadstate: Any = None) -> int | None:
            return self._ended(0.0)

        def _wait(self, timeout: float | None) -> int:
            code = self._ended(timeout)
            if code is None:
                assert timeout is not None
                raise subprocess.TimeoutExpired(self.args, timeout)
            return code

        def _ended(self, limit_s: float | None) -> int | None:
            """The exit code, if it comes in time."""
            if self.returncode is None:
                line = self._line(limit_s)
                if line is not None:
                    self.returncode = int(line or -signal.SIGKILL)
                    os.close(self._keeper)
            return self.returncode

        def _line(self, limit_s: float | None) -> bytes | None:
            """The next line of its keeper; empty at its end, None if it does not come in time."""
            end_s = None if limit_s is None else time.monotonic() + limit_s
            while b"\n" not in self._heard:
                left_s = None if end_s is None else max(0.0, end_s - time.monotonic())
                if not select.select([self._keeper], [], [], left_s)[0]:
                    return None
                if not (data := os.read(self._keeper, 100)):
                    return b""
                self._heard += data
            line, _, self._heard = self._heard.partition(b"\n")
            return line


def fork_workers() -> None:
    """Have the processes of pools forked, too, by a server that has imported what they import."""
    if CAN_FORK:
        from multiprocessing.context import SpawnProcess
        from multiprocessing.forkserver import set_forkserver_preload

        set_forkserver_preload(list(IMPORTED_BY_WORKERS))
        SpawnProcess._Popen = staticmethod(_forked)  # type: ignore[assignment]


def _forked(process: Any) -> Any:
    from multiprocessing.popen_forkserver import Popen as Forked

    process._args = (dict(os.environ), process._target, *process._args)
    process._target = _in_environment
    return Forked(process)


def _in_environment(env: dict[str, str], target: Any, /, *args: Any, **options: Any) -> None:
    """In the process: its server has the environment of an earlier test."""
    os.environ.clear()
    os.environ.update(env)
    target(*args, **options)


def run(
    words: Sequence[str | Path],
    *,
    capture_output: bool = False,
    check: bool = False,
    input: Any = None,
    timeout: float | None = None,
    **options: Any,
) -> subprocess.CompletedProcess[Any]:
    """As `subprocess.run`: `openacr WORDS` from its start to its end."""
    if input is not None:
        options["stdin"] = subprocess.PIPE
    if capture_output:
        options |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with Popen(words, **options) as process:
        try:
            out, err = process.communicate(input, timeout=timeout)
        except BaseException:
            process.kill()
            raise
    done = subprocess.CompletedProcess(process.args, process.returncode, out, err)
    if check:
        done.check_returncode()
    return done


# --- the process that forks ---------------------------------------------------------------


class _Server:
    """Forks processes; it ends with the tests."""

    def __init__(self) -> None:
        self._socket, other = socket.socketpair()
        code = f"from tests.warm import serve; serve({other.fileno()})"
        with other:
            self._process = subprocess.Popen(
                [sys.executable, "-c", code], cwd=ROOT, pass_fds=[other.fileno()],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            )  # fmt: skip
        atexit.register(self.close)

    def begin(self, order: Mapping[str, Any], fds: list[int]) -> None:
        text = json.dumps(order).encode()
        socket.send_fds(self._socket, [LENGTH.pack(len(text))], fds)
        self._socket.sendall(text)

    def close(self) -> None:
        self._socket.close()
        self._process.wait()


_running: list[_Server] = []


def _server() -> _Server:
    if not _running:
        _running.append(_Server())
    return _running[0]


def serve(number: int) -> None:
    """Fork for every order, until the tests have ended; it returns in the processes, too."""
    for name in IMPORTED:
        importlib.import_module(name)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the tests
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    gc.collect()
    gc.freeze()
    orders = socket.socket(fileno=number)
    while True:
        head, fds, _, _ = socket.recv_fds(orders, LENGTH.size, MOST_FDS)
        if len(head) < LENGTH.size:
            return
        text = b""
        while len(text) < LENGTH.unpack(head)[0]:
            text += orders.recv(LENGTH.unpack(head)[0] - len(text))
        if os.fork() == 0:
            orders.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _keep(json.loads(text), fds)
            return
        for end in fds:
            os.close(end)


def _keep(order: dict[str, Any], fds: list[int]) -> None:
    """Fork the process and report its number and its end; in the process it returns at the end."""
    *streams, report = fds
    if (child := os.fork()) == 0:
        os.close(report)
        _run(order, streams)
        return
    for end in streams:
        os.close(end)
    with suppress(OSError):  # the tests have gone
        os.write(report, b"%d\n" % child)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        os.write(report, b"%d\n" % code)
    os._exit(0)


def _run(order: dict[str, Any], streams: list[int]) -> None:
    for number, end in enumerate(streams):
        os.dup2(end, number)
    for end in streams:
        os.close(end)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.environ.clear()
    os.environ.update(order["env"])
    os.chdir(order["cwd"])
    if (most := order["most_bytes"]) is not None:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    sys.argv = ["openacr", *order["words"]]
    sys.stdin = sys.__stdin__ = open(0, closefd=False)  # type: ignore[misc]
    is_direct = "PYTHONUNBUFFERED" in os.environ
    sys.stdout = sys.__stdout__ = io.TextIOWrapper(  # type: ignore[misc]
        open(1, "wb", 0 if is_direct else -1, closefd=False), write_through=is_direct
    )
    sys.stderr = sys.__stderr__ = open(  # type: ignore[misc]
        2, "w", buffering=1, errors="backslashreplace", closefd=False
    )
    from openacr.cli.main import main

    main()
