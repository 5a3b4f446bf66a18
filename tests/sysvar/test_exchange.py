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


@pytest.mark.parametrize("is_metric", [False, True])
@pytest.mark.parametrize("written", ["254", '"254mm"', '"10in"', '"254"'])
def test_lengths_of_a_file_are_in_its_unit_where_they_name_none(
    written: str, is_metric: bool
) -> None:
    store = Store(is_metric=is_metric)
    store.write(2001, 1.0)  # no longer empty: it keeps its unit
    imported(store, f'unit = "mm"\nP650002 = {written}')
    assert store.read(650_002) == (254.0 if is_metric else 10.0)


@pytest.mark.parametrize("unit", ["inch", "mm"])
def test_a_file_that_changes_the_unit_of_the_store_means_its_own_numbers(unit: str) -> None:
    store = Store()
    store.write(2001, 1.0)
    value = 10.0 if unit == "inch" else 254.0
    imported(store, f'unit = "{unit}"\nP650002 = {value}\nP250001 = "mm"\nP650000 = {value}')
    assert [store.read(n) for n in (2001, 650_002, 650_000)] == [25.4, 254.0, 254.0]
