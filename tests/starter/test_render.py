"""Templates of text files: loops, conditions and values."""

import pytest

from openacr.starter.render import render


def test_values_are_filled_in() -> None:
    assert render("a $x ${x}b $$\n", {"x": 3}) == "a 3 3b $\n"


def test_a_loop_repeats_its_lines_with_the_values_of_each_row() -> None:
    text = "%for rows\n$name$sign\n%end\nend\n"
    values = {"rows": [{"name": "X"}, {"name": "Y"}], "sign": "!"}
    assert render(text, values) == "X!\nY!\nend\n"


def test_a_loop_over_nothing_leaves_nothing() -> None:
    assert render("%for rows\n$lost\n%if lost\n%end\n%end\nend\n", {"rows": []}) == "end\n"


@pytest.mark.parametrize(("holds", "left"), [(True, "yes\nend\n"), (False, "no\nend\n")])
def test_a_condition_keeps_one_of_its_sides(holds: bool, left: str) -> None:
    assert render("%if a\nyes\n%else\nno\n%end\nend\n", {"a": holds}) == left
    assert render("%if not a\nno\n%else\nyes\n%end\nend\n", {"a": holds}) == left


def test_what_is_left_out_needs_no_values() -> None:
    text = "%if a\n%if lost\n$lost\n%else\n$lost\n%end\n%for lost\n$lost\n%end\n%end\nend\n"
    with pytest.raises(KeyError):
        render(text, {"a": True})
    assert render("%if a\n$lost\n%for lost\n$lost\n%end\n%end\nend\n", {"a": False}) == "end\n"


def test_conditions_are_nested_in_loops() -> None:
    text = "%for rows\n%if on\n$name\n%else\n-\n%end\n%end\n"
    assert render(text, {"rows": [{"name": 1, "on": True}, {"name": 2, "on": False}]}) == "1\n-\n"


def test_a_value_that_is_not_there_is_an_error() -> None:
    with pytest.raises(KeyError, match="lost"):
        render("$lost\n", {})


@pytest.mark.parametrize("text", ["%end\n", "%else\n", "%if a\nx\n", "%if a\nx\n%else\ny\n"])
def test_an_unfinished_block_is_an_error(text: str) -> None:
    with pytest.raises(ValueError, match="without its"):
        render(text, {"a": True})
