"""A tiny card for tests of the servers: real line discipline, toy commands.

`LEN text` answers the length of the line, `SLEEP n` answers after n ticks, `SPAM n` prints n
lines, `TICK` the tick, anything else `ok`. A data packet is answered by the tick.
"""

from dataclasses import dataclass

from openacr.channels import Attention, StreamKind
from openacr.errors import NoFreeStreamError
from openacr.protocol.data import DataRequest
from openacr.protocol.events import NEED_DATA, Control, Escape, Event, Received, ReceivedLine
from openacr.protocol.status import FastStatus
from openacr.protocol.terminal import Terminal

PERIOD_S = 0.0005


@dataclass
class Stream:
    terminal: Terminal
    answer_tick: int = -1


class FakeCard:
    def __init__(self, streams: int = 16) -> None:
        self.period_s = PERIOD_S
        self.tick = 0
        self.streams: dict[int, Stream] = {}
        self.limit = streams
        self.next_id = 0
        self.controls: list[str] = []

    def open_stream(self, kind: StreamKind) -> int:
        if len(self.streams) >= self.limit:
            raise NoFreeStreamError("all streams are taken")
        self.next_id += 1
        self.streams[self.next_id] = Stream(Terminal(kind, timeout_tk=100))
        return self.next_id

    def close_stream(self, stream: int) -> None:
        del self.streams[stream]

    def receive(self, stream: int, data: bytes) -> None:
        self.streams[stream].terminal.receive_data(data, self.tick)
        self._pump(self.streams[stream])

    def accepts_input(self, stream: int) -> bool:
        return self.streams[stream].terminal.accepts_input

    def replying(self, stream: int) -> bool:
        return self.streams[stream].terminal.busy

    def take_output(self, stream: int) -> bytes:
        return self.streams[stream].terminal.data_to_send()

    def fast_status(self) -> bytes:
        return FastStatus((self.tick, *range(1, 80))).encode()

    def advance(self, ticks: int) -> None:
        for _ in range(ticks):
            self.tick += 1
            for stream in self.streams.values():
                if stream.terminal.busy and self.tick >= stream.answer_tick:
                    stream.terminal.busy = False
                    stream.terminal.send_bytes(b"ok\r\nSYS>")
                    self._pump(stream)

    def wake(self) -> None:
        """Let all lines that sleep be answered with the next tick."""
        for stream in self.streams.values():
            stream.answer_tick = self.tick

    def _pump(self, stream: Stream) -> None:
        while (event := stream.terminal.next_event()) is not NEED_DATA:
            assert not isinstance(event, type(NEED_DATA))
            self._act(stream, event)

    def _act(self, stream: Stream, event: Event) -> None:
        terminal = stream.terminal
        match event:
            case ReceivedLine(text):
                self._line(stream, text)
            case Control(code):
                self.controls.append(code.name)
            case Escape():
                terminal.attention = Attention.COMMANDS
                terminal.send_bytes(b"\r\nSYS>")
            case Received(DataRequest() as request):
                terminal.send_packet(request.reply([self.tick] * request.reply_words()))

    def _line(self, stream: Stream, text: str) -> None:
        word, _, rest = text.partition(" ")
        match word:
            case "SLEEP":
                stream.answer_tick = self.tick + int(rest)
                stream.terminal.busy = True
            case "SPAM":
                stream.terminal.send_bytes(b"x" * 98 + b"\r\n")
                for _ in range(int(rest) - 1):
                    stream.terminal.send_bytes(b"x" * 98 + b"\r\n")
                stream.terminal.send_bytes(b"SYS>")
            case "LISTEN":
                stream.terminal.attention = Attention.LISTENING
            case "LEN":
                stream.terminal.send_bytes(f"{len(text)}\r\nSYS>".encode())
            case "TICK":
                stream.terminal.send_bytes(f"{self.tick}\r\nSYS>".encode())
            case _:
                stream.terminal.send_bytes(b"ok\r\nSYS>")
