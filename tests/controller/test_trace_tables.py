"""A trace as a table of other packages, and as notebooks show it."""

import sys
from pathlib import Path

import numpy as np
import pytest

from openacr.controller import Controller
from openacr.controller.trace import Trace
from openacr.errors import UserError

SQUARE = Path(__file__).parents[2] / "examples" / "square"


@pytest.fixture(scope="module")
def trace() -> Trace:
    card = Controller.from_project(SQUARE)
    card.record(4)
    card.send("PROG0\rRUN\r")
    card.advance(400)
    return card.trace()


def test_columns_have_the_names_of_a_trace_file(trace: Trace) -> None:
    columns = trace.columns()
    assert list(columns)[:7] == [
        "time_s", "inputs", "outputs", "axis_0_commanded", "axis_0_actual", "axis_0_velocity",
        "axis_0_following_error",
    ]  # fmt: skip
    assert len(columns) == 3 + 4 * len(trace.axes)
    assert np.array_equal(columns["axis_1_velocity"], trace.axes[1].velocity_ups)


def test_a_data_frame_has_every_column_and_time_as_its_index(trace: Trace) -> None:
    pytest.importorskip("pandas")
    frame = trace.to_pandas()
    assert frame.index.name == "time_s"
    assert frame.index.tolist() == trace.time_s.tolist()
    assert list(frame.columns) == list(trace.columns())[1:]
    assert frame["axis_0_actual"].tolist() == trace.axes[0].actual_u.tolist()


def test_an_arrow_table_has_every_column(trace: Trace) -> None:
    pytest.importorskip("pyarrow")
    table = trace.to_arrow()
    assert table.column_names == list(trace.columns())
    assert table["outputs"].to_pylist() == trace.outputs.tolist()


@pytest.mark.parametrize(("name", "method"), [("pandas", "to_pandas"), ("pyarrow", "to_arrow")])
def test_a_package_that_is_missing_is_named_with_its_installation(
    trace: Trace, monkeypatch: pytest.MonkeyPatch, name: str, method: str
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(UserError) as refused:
        getattr(trace, method)()
    assert str(refused.value) == f"{name} is not installed: python -m pip install {name}"


def test_a_notebook_shows_the_axes_that_moved_with_their_extremes(trace: Trace) -> None:
    shown = trace._repr_html_()
    moved = [axis for axis in trace.axes if np.ptp(axis.actual_u) > 0]
    assert moved
    assert shown.startswith(f"<p>Trace: {len(trace.time_s)} rows, ")
    assert shown.count("<tr>") == 1 + len(moved)
    assert f"<td>{moved[0].actual_u.max():.6g}</td>" in shown


def test_an_empty_trace_is_shown_as_such() -> None:
    card = Controller()
    card.record()
    assert "<p>Trace: 0 rows, empty</p>" in card.trace()._repr_html_()
