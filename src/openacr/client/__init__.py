"""Client for any ACR card: virtual or real, in this process, over TCP or a serial line.

    from openacr.client import Card

    with Card.open("192.168.10.40") as card:
        print(card.p["axis0.actual position"], card.bit["master0.in motion"])

`AsyncCard` is the same for asyncio.
"""

from openacr.client.async_card import AsyncCard
from openacr.client.card import Card
from openacr.client.errors import (
    ClientError,
    ConnectionLostError,
    DownloadError,
    GarbledError,
    NoReplyError,
    RefusedError,
    RestoreError,
    VerificationError,
)
from openacr.client.moves import MoveStream
from openacr.client.objects import Axis, Master
from openacr.client.options import Options
from openacr.client.requests import Level
from openacr.client.status_feed import StatusFeed
from openacr.client.transfer import Remark, Report

__all__ = [
    "AsyncCard",
    "Axis",
    "Card",
    "ClientError",
    "ConnectionLostError",
    "DownloadError",
    "GarbledError",
    "Level",
    "Master",
    "MoveStream",
    "NoReplyError",
    "Options",
    "RefusedError",
    "Remark",
    "Report",
    "RestoreError",
    "StatusFeed",
    "VerificationError",
]
