"""Commands of the long record of the scope."""

from typing import Annotated

from msgspec import Meta

from openacr.client.names import named
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.records import Records
from openacr.panel.control.engineer.scope import CHANNELS
from openacr.panel.roles import Role

PeriodMs = Annotated[float, Meta(ge=0.0, le=60_000.0)]
Names = Annotated[tuple[int | str, ...], Meta(min_length=1, max_length=CHANNELS)]


@command("record.begin", Role.SERVICE, needs_control=False, en="RECORD", de="AUFZEICHNEN")
def record_begin(
    client: int, records: Records, *, channels: Names, period_ms: PeriodMs = 1.0, take: bool = False
) -> dict[str, object]:
    """Begin to record up to eight parameters and flags, for hours, into files of the panel.

    They are named by name, P12290, BIT516 or number. One record is kept; one that is under way or
    has a minute and more is dropped only with `take`. `GET /api/record/view` gives any part.
    """
    chosen = [named(str(each)) for each in channels]
    records.begin(client, chosen, period_ms / 1000.0, take=take)
    return records.data()


@command("record.end", Role.SERVICE, needs_control=False)
def record_end(records: Records) -> None:
    """Add no more samples to the record, which stays."""
    records.end()
