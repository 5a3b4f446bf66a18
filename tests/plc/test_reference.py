from pathlib import Path

from openacr.plc.instructions import INSTRUCTIONS, Instruction, Operand

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "plc.md"

_WRITTEN = {
    Operand.NONE: "",
    Operand.FLAG: " b",
    Operand.TIMER: " n preload",
    Operand.COUNTER: " n preload",
    Operand.LATCH: " n",
}


def row(instruction: Instruction) -> str:
    also = ", ".join(f"`{synonym}`" for synonym in instruction.synonyms)
    name = f"{instruction.name}{_WRITTEN[instruction.operand]}"
    return f"| `{name}` | {also} | {instruction.summary} |".replace("|  |", "| |")


def test_the_reference_page_has_every_instruction() -> None:
    table = PAGE.read_text().partition("## Instructions")[2].partition("\n`b` is")[0]
    found = [line for line in table.splitlines() if line.startswith("| `")]
    assert found == [row(instruction) for instruction in INSTRUCTIONS]
