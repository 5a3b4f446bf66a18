"""Sums of the first n of many numbers, against sums that are added up."""

from hypothesis import given
from hypothesis import strategies as st

from openacr.basic.memory.running_sums import RunningSums

CHANGES = st.lists(st.tuples(st.integers(0, 99), st.integers(0, 9)), max_size=40)


@given(st.integers(1, 100), CHANGES)
def test_sums_and_places_are_those_of_the_numbers(
    count: int, changes: list[tuple[int, int]]
) -> None:
    sums, numbers = RunningSums(count), [0] * count
    for index, amount in changes:
        sums.add(index % count, amount)
        numbers[index % count] += amount
    for index in range(count + 1):
        assert sums.before(index) == sum(numbers[:index])
    for total in range(sum(numbers) + 2):
        beyond = (index for index in range(count) if sum(numbers[: index + 1]) > total)
        assert sums.find(total) == next(beyond, count)


def test_of_no_numbers_there_is_the_empty_sum() -> None:
    assert RunningSums(0).before(0) == 0
    assert RunningSums(0).find(0) == 0
