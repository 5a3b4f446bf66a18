"""Long records: every part is that of numpy over the samples, however they came."""

from pathlib import Path

import numpy as np
import pytest

from openacr.errors import UserError
from openacr.panel.control.engineer.pyramid import ALIGNED, FACTOR, LEVELS, Pyramid

pytestmark = pytest.mark.evidence("oracle", "numpy over all samples")
RNG = np.random.default_rng(3)
WALK = np.cumsum(RNG.normal(size=(3, 150_000)), axis=1)
WALK[1, 70_000:90_000] = np.nan
WALK[2, ::7] = np.nan
MANY = 1 << 30


def filled(values: np.ndarray, sizes: tuple[int, ...] = (1, 7, 1000, 16, 70_000)) -> Pyramid:
    """The samples, appended in pieces of these sizes."""
    found, first, turn = Pyramid(len(values), MANY), 0, 0
    while first < values.shape[1]:
        size = sizes[turn % len(sizes)]
        found.append(values[:, first : first + size])
        first, turn = first + size, turn + 1
    return found


@pytest.fixture(scope="module")
def walk() -> Pyramid:
    return filled(WALK)


PARTS = [
    (0, 150_000), (0, 1), (149_999, 150_000), (3, 17), (15, 16), (16, 32), (17, 31), (255, 4097),
    (1, 65_537), (65_535, 65_537), (65_536, 131_072), (70_000, 90_000), (69_999, 149_990),
]  # fmt: skip


@pytest.mark.parametrize(("first", "last"), PARTS)
@pytest.mark.parametrize("most", [2, 3, 100, 1000])
def test_columns_hold_the_extremes_of_their_samples(
    walk: Pyramid, first: int, last: int, most: int
) -> None:
    found = walk.columns(first, last, most)
    count = found.low.shape[1]
    assert count <= most
    assert found.first <= first < found.first + found.width
    assert found.first + count * found.width >= last > found.first + (count - 1) * found.width
    assert found.width == 1 or count * 2 * FACTOR >= min(most, last - first)
    for n in range(count):
        begin = found.first + n * found.width
        part = WALK[:, begin : min(begin + found.width, last)]
        with np.errstate(invalid="ignore"):
            np.testing.assert_array_equal(found.low[:, n], np.fmin.reduce(part, axis=1))
            np.testing.assert_array_equal(found.high[:, n], np.fmax.reduce(part, axis=1))


@pytest.mark.parametrize(("first", "last"), PARTS)
def test_measures_of_a_part_are_those_of_its_samples(walk: Pyramid, first: int, last: int) -> None:
    for values, found in zip(WALK[:, first:last], walk.summaries(first, last), strict=True):
        there = values[~np.isnan(values)]
        assert found.count == len(there)
        if len(there):
            assert (found.min, found.max) == (there.min(), there.max())
            assert found.mean == pytest.approx(there.mean(), rel=1e-9, abs=1e-9)
            assert found.rms == pytest.approx(np.sqrt(np.mean(there**2)), rel=1e-9)
        else:
            assert np.isnan([found.min, found.max, found.mean, found.rms]).all()


@pytest.mark.parametrize(("first", "last"), PARTS)
def test_samples_come_back_as_they_were(walk: Pyramid, first: int, last: int) -> None:
    np.testing.assert_array_equal(walk.samples(first, last), WALK[:, first:last])


def test_columns_stay_where_they_are_while_the_part_moves(walk: Pyramid) -> None:
    one, other = walk.columns(1000, 101_000, 500), walk.columns(1100, 101_100, 500)
    assert one.width == other.width
    moved = (other.first - one.first) // one.width
    assert (other.first - one.first) % one.width == 0
    np.testing.assert_array_equal(one.low[:, moved + 1 : 400], other.low[:, 1 : 400 - moved])


def test_of_a_record_beyond_its_bound_the_newest_part_is_kept() -> None:
    values = np.arange(4.3 * ALIGNED)[None, :]
    found = Pyramid(1, int(2 * ALIGNED * 8 * 1.34))
    assert found.room == 2 * ALIGNED
    for first in range(0, values.shape[1], 50_000):
        found.append(values[:, first : first + 50_000])
        assert found.next - found.first <= found.room
        assert found.next - found.first > min(found.next, found.room) - ALIGNED
    assert found.first == 3 * ALIGNED
    assert found.size_bytes <= 2 * ALIGNED * 8 * 1.34
    all_kept = found.samples(found.first, found.next)
    np.testing.assert_array_equal(all_kept, values[:, found.first :])
    (whole,) = found.summaries(found.first, found.next)
    assert (whole.count, whole.min, whole.max) == (all_kept.size, found.first, found.next - 1)
    shown = found.columns(found.first, found.next, 50)
    assert (shown.low[0, 0], shown.high[0, -1]) == (found.first, found.next - 1)
    for first, last in ((found.first - 1, found.next), (found.first, found.next + 1), (9, 9)):
        with pytest.raises(UserError, match=f"of this record {3 * ALIGNED} to {found.next}"):
            found.samples(first, last)


def test_a_part_is_read_from_few_entries_of_any_level(
    walk: Pyramid, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[tuple[int, int]] = []
    plain = Pyramid._read

    def noted(self: Pyramid, level: int, first: int, last: int) -> np.ndarray:
        read.append((level, last - first))
        return plain(self, level, first, last)

    monkeypatch.setattr(Pyramid, "_read", noted)
    for first, last in PARTS:
        read.clear()
        walk.columns(first, last, 100)
        assert sum(count for _, count in read) <= 2 * FACTOR * 100 + 2 * FACTOR * LEVELS
        read.clear()
        walk.summaries(first, last)
        assert sum(count for _, count in read) <= 4 * FACTOR * LEVELS


def test_files_are_in_the_folder_that_is_given_and_go_with_the_record(tmp_path: Path) -> None:
    found = Pyramid(1, MANY, tmp_path)
    found.append(np.zeros((1, 100)))
    found.close()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(FileNotFoundError):
        Pyramid(1, MANY, tmp_path / "none")
