"""Catalogues of the screens hold every text that is used, in every language alike."""

import re
from pathlib import Path

import pytest

from openacr.panel.commands.all import COMMANDS

JS = Path(__file__).parents[2] / "src/openacr/panel/web/js"
KEY = r"[a-z][A-Za-z0-9. ]*\.[A-Za-z0-9. ]+"
# Keys that are made at run time begin with one of these.
MADE = (
    "alarm.", "block.", "board.", "graphics.", "home.state.", "load.", "override.", "pad.",
    "role.", "scope.", "state.", "card.", "programs.state.",
    "watch.format.", "panels.", "time.kind.", "time.step.", "world.fault.", "world.input.",
    "tune.worse.",
)  # fmt: skip


def catalogue(language: str) -> dict[str, str]:
    files = [JS / "catalog" / folder / f"{language}.js" for folder in ("", "bench")]
    texts = [each.read_text(encoding="utf-8") for each in files]
    found = [
        pair for text in texts for pair in re.findall(rf'"({KEY})": "((?:[^"\\]|\\.)*)"', text)
    ]
    found += [(row.name, row.titles[language]) for row in COMMANDS.values() if row.titles]
    assert len(found) == len(dict(found))  # one text for each key
    return dict(found)


def used() -> set[str]:
    keys: set[str] = set()
    for path in JS.rglob("*.js"):
        if JS / "catalog" not in path.parents:
            text = path.read_text(encoding="utf-8")
            keys.update(re.findall(rf'"({KEY})"', text))
    return keys


def test_every_text_that_a_screen_asks_for_is_in_the_catalogue() -> None:
    english = catalogue("en")
    asked = set()
    for path in JS.rglob("*.js"):
        text = path.read_text(encoding="utf-8")
        asked.update(re.findall(rf'\bt\("({KEY})"', text))
        asked.update(re.findall(rf'\b(?:title|label): "({KEY})"', text))
    assert len(asked) > 250
    assert sorted(asked - english.keys()) == []


def test_every_text_of_the_catalogue_is_used() -> None:
    spare = catalogue("en").keys() - used()
    assert sorted(key for key in spare if not key.startswith(MADE)) == []


@pytest.mark.parametrize("language", ["de"])
def test_every_language_has_the_texts_and_places_of_english(language: str) -> None:
    english, other = catalogue("en"), catalogue(language)
    assert sorted(english) == sorted(other)
    places = re.compile(r"\{\w+\}")
    unlike = {
        key
        for key, text in english.items()
        if sorted(places.findall(text)) != sorted(places.findall(other[key]))
    }
    assert unlike == set()
