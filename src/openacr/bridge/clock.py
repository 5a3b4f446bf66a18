"""The date of readings: the only place of a bridge that reads it."""

from datetime import UTC, datetime


def now() -> datetime:
    """The present time in UTC."""
    return datetime.now(UTC)


def stamp() -> str:
    """The present time in UTC, as MTConnect writes it."""
    return f"{now():%Y-%m-%dT%H:%M:%S.%f}"[:-3] + "Z"


def epoch_ms() -> int:
    """Milliseconds since 1970."""
    return int(now().timestamp() * 1000.0)
