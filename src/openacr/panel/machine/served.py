"""The card of a project with its bus open: served by a process of its own, which the panel starts.

Frames do not wait for screens then. The process ends with the panel: at the end of its standard
input it brings the drives to rest and leaves.
"""

import json
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, cast

from openacr.errors import UserError

LISTENING, BUS = "listening ascii=", "bus "
END_S = 30.0  # that the process takes to leave


class ServedCard:
    """The process of a card; UserError if it does not come to listen, which it has explained."""

    def __init__(
        self, project: Path, bus: str | None, *, is_real: bool, is_real_time: bool = False
    ) -> None:
        words = [sys.executable, "-m", "openacr", "serve", str(project), "--report-bus"]
        words += ["--ascii-port", "0", "--binary-port", "0", "--no-journal", "--yes"]
        words += ["--real"] if is_real else []
        words += ["--realtime"] if is_real_time else []
        words += [] if bus is None else ["--bus", bus]
        self._process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8",
            start_new_session=True,  # Ctrl-C is for the panel, which may ask first
        )  # fmt: skip
        self._in = cast("IO[str]", self._process.stdin)
        self._out = cast("IO[str]", self._process.stdout)
        self._report: dict[str, Any] | None = None
        self.address = self._listening()
        self._reading = threading.Thread(target=self._read, name="bus report", daemon=True)
        self._reading.start()

    @property
    def report(self) -> dict[str, Any] | None:
        """The newest state of the bus; None before the first, and once the process has ended."""
        return self._report

    def reset_counters(self) -> None:
        """Let the counters of frames begin at 0; UserError once the process has ended."""
        try:
            self._in.write("reset\n")
            self._in.flush()
        except (OSError, ValueError):  # its pipe is broken, or closed
            raise UserError("the card with the bus has ended") from None

    def close(self) -> None:
        """Have the card bring its drives to rest and end."""
        with suppress(OSError):
            self._in.close()
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()  # the drives stop by their own watchdogs
            self._process.wait()
        self._reading.join()
        self._out.close()

    def _listening(self) -> str:
        for line in self._out:
            if line.startswith(LISTENING):
                return line.removeprefix(LISTENING).split()[0]
        self._process.communicate()
        raise UserError("the card with its bus has not started: the lines above say why")

    def _read(self) -> None:
        for line in self._out:
            if line.startswith(BUS):
                with suppress(ValueError):  # the last line of a process that is killed
                    self._report = json.loads(line.removeprefix(BUS))
        self._report = None
