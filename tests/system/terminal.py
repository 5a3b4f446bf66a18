"""A card with a console: what a line prints, without echo and prompts."""

from openacr.controller import Controller


class Console:
    """Types lines and returns what they print."""

    def __init__(self, model: str = "ACR9000") -> None:
        self.card = Controller(model)
        self.card.send("ECHO 4\r")

    def type(self, *lines: str) -> str:
        """What the lines print, joined by `|`."""
        answer = "".join(self.card.send(line + "\r") for line in lines)
        return answer.removesuffix("\r\n").replace("\r\n", "|")

    def program(self, number: int, *lines: str) -> None:
        """Store a program."""
        assert self.type(f"PROG{number}", "PROGRAM", *lines, "ENDP") == ""

    def listen(self, number: int, seconds: float) -> str:
        """Run a program with LRUN for so long; what it prints."""
        said = self.type(f"PROG{number}", "LRUN")
        self.card.advance(seconds=seconds)
        said += self.card.take_output(self.card.console).decode("latin-1")
        return said.removesuffix("\r\n").replace("\r\n", "|")
