"""Any text is imported or refused with a sentence; nothing of a refused one is stored."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from openacr.errors import UserError
from openacr.sysvar import Store
from openacr.sysvar.exchange import exported, imported
from openacr.sysvar.lookup import parameters

KEYS = st.sampled_from(
    ["P650002", "P2001", "P244", "P100001", "P200008", '"Cut Speed"', "P5", '"x"', "unit", "layout"]
)
VALUES = st.sampled_from(
    ["1", "-1.5", "true", '"mm"', '"disable"', "[1]", "{a = 1}", "nan", "inf", "1e400", "9" * 400,
     "1979-05-27", '""', '"X"', "2.5", "0"]
)  # fmt: skip
OF_A_RUN = {*range(234, 249), 1998, 1999, 4000, 4001}
LINES = st.lists(st.tuples(KEYS, VALUES), max_size=4)


@settings(max_examples=60, deadline=None)
@given(lines=LINES, noise=st.text(max_size=8))
def test_any_text_is_imported_or_refused(lines: list[tuple[str, str]], noise: str) -> None:
    store = Store()
    text = "\n".join(f"{key} = {value}" for key, value in lines) + f"\n# {noise!r}"
    try:
        imported(store, text, "x.toml")
    except UserError as error:
        assert "x.toml" in str(error)
        assert not store.token


def test_everything_exported_is_imported_again() -> None:
    first, second = Store(is_metric=True), Store()
    with first.transaction():
        for found in parameters():
            if found.is_length and not found.row.is_fixed and found.row.low == -float("inf"):
                first.write(found.number, 0.125 + found.number % 7)
    assert imported(second, exported(first, everything=True)) > 10_000
    for found in parameters():
        if not (found.row.is_fixed or found.number in OF_A_RUN):
            assert second.value(found.number) == first.value(found.number), found


def test_a_number_that_is_none_is_refused() -> None:
    with pytest.raises(UserError, match="P650002 Cut Speed cannot be 9999"):
        imported(Store(), "P650002 = " + "9" * 400)
