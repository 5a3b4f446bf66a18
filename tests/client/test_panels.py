"""Panels of status: every row is something of the card, under the names of `openacr monitor`."""

import pytest

from openacr.client.panels import AXES, PANELS, Row, StatusPanel, panel_named, record_of
from openacr.errors import UserError
from openacr.map import Flag, Parameter


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.name)
def test_every_row_of_a_panel_is_there_for_each_of_its_objects(panel: StatusPanel) -> None:
    rows = [row for group in panel.groups for row in group.rows]
    missing = [(o, row.name) for o in panel.objects for row in rows if record_of(row, o) is None]
    assert missing == []
    assert len({row.name for row in rows}) == len(rows)


def test_rows_are_parameters_and_flags_of_their_object() -> None:
    position, motion = (
        record_of(Row("Current Position"), "AXIS1"), record_of(Row("In Motion"), "MASTER2"),
    )  # fmt: skip
    assert isinstance(position, Parameter)
    assert position.number == 12288 + 256
    assert isinstance(motion, Flag)
    assert motion.number == 516 + 64
    count = record_of(Row("{object} Line Buffer Count"), "COM2")
    assert count is not None
    assert (count.name, count.object) == ("COM2 Line Buffer Count", "COM2")
    assert record_of(Row("Line Buffer Count"), "AXIS0") is None


def test_columns_of_monitor_are_rows_of_the_axes() -> None:
    assert [row.column for row in AXES.columns] == [
        "position", "actual", "following_error", "enabled", "killed", "jogging",
    ]  # fmt: skip


def test_a_panel_is_found_by_its_name() -> None:
    assert panel_named("axes") is AXES
    with pytest.raises(UserError, match=r"no panel 'axis': there are axes, masters, programs"):
        panel_named("axis")
