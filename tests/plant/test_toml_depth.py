"""Files whose tables are nested without end are refused before they are parsed."""

from collections.abc import Callable

import pytest

from openacr.errors import SourceError
from openacr.plant.describe.toml_file import MOST_DEPTH, parse

DEEP: dict[str, Callable[[int], str]] = {
    "key": lambda n: ".".join(["a"] * n) + " = 1",
    "quoted key": lambda n: ".".join(['"a b"'] * n) + " = 1",
    "table": lambda n: f"[{'.'.join(['a'] * n)}]",
    "list": lambda n: "a = " + "[" * n + "]" * n,
    "table in a line": lambda n: "a = " + "{a = " * n + "1" + "}" * n,
    "key in a table in a line": lambda n: "a = {" + ".".join(["a"] * n) + " = 1}",
}


@pytest.mark.parametrize("kind", DEEP)
def test_a_depth_that_no_user_needs_is_refused(kind: str) -> None:
    for depth in (MOST_DEPTH + 1, 20_000):
        with pytest.raises(SourceError, match=f"nested deeper than {MOST_DEPTH}"):
            parse(DEEP[kind](depth), "machine.toml")


@pytest.mark.parametrize("kind", DEEP)
def test_what_is_not_deep_is_parsed(kind: str) -> None:
    assert parse(DEEP[kind](MOST_DEPTH), "machine.toml")


def test_text_in_strings_and_remarks_has_no_depth() -> None:
    dots, brackets = "a." * 100, "[" * 100
    text = (
        f"a = \"{dots}{brackets}\"\nb = '{dots}{brackets}'\n# {dots}{brackets}\n"
        f'c = """\n{dots}"{brackets}\n"""\nd = [{"1.5, " * 100}]\n'
    )
    assert len(parse(text, "machine.toml")["d"]) == 100
