"""Parameters and flags are found by words of their names, the best first."""

import pytest

from openacr.client.search import search


def ids(text: str, count: int = 3) -> list[str]:
    found = search(text, count)
    return [f"{'P' if hasattr(each, 'unit') else 'BIT'}{each.number}" for each in found]


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("12290", "P12290"),
        ("p12290", "P12290"),
        ("BIT516", "BIT516"),
        ("axis1 actual position", "P12546"),
        ("axis1.actual position", "P12546"),
        ("position actual axis1", "P12546"),
        ("act pos", "P12290"),
        ("actpos", "P12290"),
        ("axs1 flwerr", "P12547"),
        ("in motion", "BIT516"),
        ("master1 motion in", "BIT548"),
    ],
)
def test_the_best_fit_is_first(text: str, first: str) -> None:
    assert ids(text)[0] == first


def test_a_number_is_before_names_that_contain_it() -> None:
    assert ids("516", 1) == ["P516"]
    assert ids("bit516")[0] == "BIT516"
    assert all(each.startswith("BIT516") for each in ids("bit516"))


def test_the_beginning_of_a_word_is_before_its_inside() -> None:
    names = [each.name.lower() for each in search("rate", 500)]
    begins = [f" {name}".find(" rate") >= 0 for name in names]
    assert True in begins
    assert False in begins
    assert begins == sorted(begins, reverse=True)


def test_no_more_are_found_than_wanted_and_nothing_for_nothing() -> None:
    assert len(search("position", 7)) == 7
    assert search("  ", 7) == []
    assert search("zzzz", 7) == []
