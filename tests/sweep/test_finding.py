"""What matters, and the search for the best: against results that are known."""

import math
from pathlib import Path

import numpy as np
import pytest
from tests.sweep.projects import Here, formula_project, rows_of, sweep_file

from openacr.sweep.load import load_sweep
from openacr.sweep.sensitivity import what_matters
from openacr.workers import LocalPool, Pool

pytestmark = pytest.mark.evidence(
    "oracle", "closed form of the Sobol indices of Ishigami's function; minimum of a quadratic"
)

INPUTS = "".join(
    f"[vary.x{n + 1}]\nparameter = {n}\nrange = [{-math.pi!r}, {math.pi!r}]\n" for n in range(3)
)
ISHIGAMI = f"""duration_s = 0.002
{INPUTS}
[design]
kind = "sobol"
samples = 128
seed = 3
[measures]
y = "at_end(P5)"
"""


def ishigami_indices(a: float = 7.0, b: float = 0.1) -> dict[str, tuple[float, float]]:
    """First-order and total indices: Ishigami and Homma (1990)."""
    first = 0.5 * (1 + b * math.pi**4 / 5) ** 2
    second = a**2 / 8
    with_third = 8 * b**2 * math.pi**8 / 225
    whole = first + second + with_third
    return {
        "x1": (first / whole, (first + with_third) / whole),
        "x2": (second / whole, second / whole),
        "x3": (0.0, with_third / whole),
    }


def test_sobol_indices_of_ishigamis_function_on_the_card_are_those_of_its_closed_form(
    tmp_path: Path,
) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, ISHIGAMI)
    rows = rows_of(file, LocalPool(2))
    assert len(rows) == 128 * 5
    x1, x2, x3 = np.array([row.point for row in rows]).T
    y = np.sin(x1) + 7 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1)
    measures = np.array([row.outcome.measures for row in rows])
    assert measures[:, 0] == pytest.approx(y, abs=1e-9)
    found = what_matters(load_sweep(file), [row.point for row in rows], measures)["y"]
    for name, (first, total) in ishigami_indices().items():
        for key, expected in (("first", first), ("total", total)):
            index, confidence = found[name][key], found[name][f"{key}_confidence"]
            assert index is not None and confidence is not None
            assert abs(index - expected) < confidence < 0.4


def test_a_failed_run_leaves_no_indices(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, ISHIGAMI.replace("samples = 128", "samples = 4"))
    rows = rows_of(file)
    measures = np.array([row.outcome.measures for row in rows])
    measures[7, 0] = math.nan
    found = what_matters(load_sweep(file), [row.point for row in rows], measures)["y"]
    assert found["x2"] == dict.fromkeys(("first", "first_confidence", "total", "total_confidence"))


GRID = """
[vary.up]
parameter = 0
values = [1, 2, 3, 4]
[vary.other]
parameter = 1
values = [5, 6]
[measures]
rising = "up ** 3 + 1 / other"
falling = "-exp(up)"
same = "4"
some = "log(up - 2)"
"""


def test_of_other_designs_ranks_are_compared(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, GRID)
    rows = rows_of(file)
    measures = np.array([row.outcome.measures for row in rows])
    found = what_matters(load_sweep(file), [row.point for row in rows], measures)
    # Ranks of `up` 0.5 0.5 2.5 2.5 4.5 4.5 6.5 6.5; of `rising` 1 0 3 2 5 4 7 6: 40 / sqrt(40 42).
    assert found["rising"]["up"]["rank_correlation"] == pytest.approx(math.sqrt(40 / 42))
    assert found["rising"]["other"]["rank_correlation"] == pytest.approx(-4 / math.sqrt(8 * 42) / 1)
    assert found["falling"]["up"]["rank_correlation"] == pytest.approx(-1.0)
    assert found["falling"]["other"]["rank_correlation"] == pytest.approx(0.0, abs=1e-12)
    assert found["same"]["up"]["rank_correlation"] is None
    assert found["some"]["up"]["rank_correlation"] == pytest.approx(1.0)


SEARCH = """
[vary.gain]
parameter = 0
range = [-10, 10]
[vary.other]
parameter = 1
range = [0.01, 100]
scale = "log"
[optimise]
minimise = "cost"
trials = 120
seed = 1
[measures]
cost = "(at_end(P0) - 3) ** 2 + log(at_end(P1)) ** 2"
"""


@pytest.mark.parametrize("key", ["minimise", "maximise"])
def test_a_search_finds_the_minimum_of_a_quadratic(tmp_path: Path, key: str) -> None:
    formula_project(tmp_path / "p")
    text = SEARCH.replace("minimise", key)
    file = sweep_file(tmp_path, text if key == "minimise" else text.replace('"(', '"-(', 1))
    if key == "maximise":
        file.write_text(file.read_text().replace("+ log", "- log"))
    rows = rows_of(file)
    assert len(rows) == 120
    best = min(rows, key=lambda row: abs(row.outcome.measures[0]))
    assert abs(best.outcome.measures[0]) < 0.05
    assert best.point == pytest.approx((3.0, 1.0), abs=0.25)
    for row in rows:
        gain, other = row.point
        assert -10 <= gain <= 10
        assert 0.01 <= other <= 100


def test_a_search_is_the_same_with_any_number_of_workers_and_goes_on(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, SEARCH.replace("trials = 120", "trials = 21"))
    pools: list[Pool] = [Here(), LocalPool(2)]
    few, other = (
        rows_of(file, pool, output=tmp_path / f"{n}.parquet") for n, pool in enumerate(pools)
    )
    assert few == other
    assert len(few) == 21
    file.write_text(file.read_text().replace("trials = 21", "trials = 27"))
    assert rows_of(file, output=tmp_path / "0.parquet")[:16] == few[:16]
