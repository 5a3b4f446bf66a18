"""Colours of paths and messages: one table, shown on both grounds."""

import re
from itertools import combinations

import pytest

from openacr.mill.config.colors import COLORS
from openacr.panel.palette import MODULE, module_text

GROUND = re.compile(r"--drawing: light-dark\((#\w{6}), (#\w{6})\);")
LEAST_CONTRAST = 3.0  # of lines and other graphics (WCAG 2.2, 1.4.11)
INDICES = range(16)


def channels(color: str) -> list[float]:
    """Red, green and blue, 0 to 1."""
    return [int(color[at : at + 2], 16) / 255 for at in (1, 3, 5)]


def luminance(color: str) -> float:
    """Relative luminance of a colour of the screen (WCAG 2.2)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels(color)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def grounds() -> tuple[str, str]:
    """The ground of pictures in the light and in the dark theme."""
    found = GROUND.search((MODULE.parents[2] / "css/base.css").read_text())
    assert found is not None
    return found[1], found[2]


def test_contrast_is_that_of_the_definition() -> None:
    assert contrast("#000000", "#FFFFFF") == pytest.approx(21.0)
    assert contrast("#777777", "#FFFFFF") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("index", INDICES)
def test_every_colour_of_the_store_shows_on_both_themes_and_on_white(index: int) -> None:
    light, dark = grounds()
    color = COLORS[index]
    assert contrast(color.on_light, light) >= LEAST_CONTRAST
    assert contrast(color.on_light, "#FFFFFF") >= LEAST_CONTRAST
    assert contrast(color.on_dark, dark) >= LEAST_CONTRAST


def test_no_two_colours_of_a_theme_are_alike() -> None:
    for theme in zip(*COLORS, strict=True):
        for one, other in combinations(theme, 2):
            apart = max(abs(a - b) for a, b in zip(channels(one), channels(other), strict=True))
            assert apart >= 0.1, (one, other)


def test_the_module_of_the_screens_is_that_of_the_table() -> None:
    assert len(COLORS) == len(INDICES)
    assert MODULE.read_text() == module_text(), "python -m openacr.panel.palette"
