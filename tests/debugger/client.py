"""A client of the debugger: it sends requests and waits for answers and events."""

from __future__ import annotations

import subprocess
import threading
from pathlib import Path
from queue import Queue
from typing import Any

from tests import warm

from openacr.debugger.wire import read_message, write_message

Json = dict[str, Any]
LIMIT_S = 60.0


class RefusedError(Exception):
    """A request that the adapter has answered with an error."""


class Client:
    """A debugger of its own process, as editors start it."""

    def __init__(self) -> None:
        self.process = warm.Popen(["debug"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self._in, self._out = self.process.stdin, self.process.stdout
        self._sequence = 0
        self._heard: Queue[Json | None] = Queue()
        self._kept: list[Json] = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        while (message := read_message(self._out)) is not None:
            self._heard.put(message)
        self._heard.put(None)

    def ask(self, command: str, **arguments: object) -> Json:
        """The body of the answer to a request; RefusedError with its message."""
        self._sequence += 1
        number = self._sequence
        message = {"seq": number, "type": "request", "command": command, "arguments": arguments}
        write_message(self._in, message)
        answer = self._wait(lambda each: each.get("request_seq") == number)
        assert answer["command"] == command
        if not answer["success"]:
            raise RefusedError(answer["message"])
        return dict(answer.get("body", {}))

    def event(self, name: str) -> Json:
        """The body of the next event of a kind."""
        return dict(self._wait(lambda each: each.get("event") == name)["body"])

    def kept(self) -> list[Json]:
        """What has come and was not waited for, before the last answer."""
        return self._kept

    def stop(self) -> tuple[str, int]:
        """Reason and thread of the next stop."""
        body = self.event("stopped")
        return body["reason"], body["threadId"]

    def _wait(self, is_meant: Any) -> Json:
        for place, message in enumerate(self._kept):
            if is_meant(message):
                return self._kept.pop(place)
        while True:
            heard = self._heard.get(timeout=LIMIT_S)
            assert heard is not None, "the debugger has ended"
            if is_meant(heard):
                return heard
            self._kept.append(heard)

    def launch(self, folder: Path, **arguments: object) -> None:
        """Initialize and launch; the configuration is not done yet."""
        self.ask("initialize", adapterID="openacr")
        self.event("initialized")
        self.ask(
            "launch", **({"program": str(folder), "speed": 0, "stopOnEntry": True} | arguments)
        )

    def place(self, thread: int) -> tuple[str, int]:
        """File name and line of the first frame of a thread."""
        frame = self.ask("stackTrace", threadId=thread)["stackFrames"][0]
        return frame["source"]["name"], frame["line"]

    def value(self, expression: str, frame: int = 100) -> str:
        return str(self.ask("evaluate", expression=expression, frameId=frame)["result"])

    def end(self) -> int:
        """End the session; the exit code."""
        self.ask("disconnect")
        return self.process.wait(LIMIT_S)

    def hang_up(self) -> None:
        """Close the line as an editor does that dies."""
        self._in.close()

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        for stream in (self._in, self._out):
            stream.close()
