"""Metrics for Prometheus: the values of the table as gauges, at `/metrics`."""

from collections.abc import Iterable, Sequence

from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector, CollectorRegistry
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from openacr.bridge.items import Item, Readings
from openacr.bridge.rows import Kind, Unit, Value
from openacr.bridge.settings import Prometheus
from openacr.bridge.setup import Setup
from openacr.bridge.web import WebServer

# Suffixes of names by unit, as the naming rules of Prometheus ask for; speeds have no base unit.
SUFFIXES = {
    Unit.MM: "_mm",
    Unit.DEGREE: "_degrees",
    Unit.MM_PER_S: "_mm_per_second",
    Unit.RPM: "_rpm",
    Unit.PERCENT: "_percent",
    Unit.SECOND: "_seconds",
}


class PrometheusSystem(Collector):
    """The newest values as metrics; a value that is not known now has no sample."""

    name = "prometheus"

    def __init__(self, setup: Setup, settings: Prometheus) -> None:
        self._items, self._machine = setup.items, setup.machine
        self._readings: Readings = (None,) * len(setup.items)
        self._registry = CollectorRegistry()
        self._registry.register(self)
        self._web = WebServer(self.name, settings, setup.secret, [Route("/metrics", self._answer)])

    async def open(self) -> str:
        """Listen; the address of the metrics."""
        return f"{await self._web.open()}/metrics"

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Keep the newest values until they are scraped."""
        self._readings = readings

    async def close(self) -> None:
        """End the web server."""
        await self._web.close()

    async def _answer(self, request: Request) -> Response:
        encode, content_type = choose_encoder(request.headers.get("accept", ""))
        return Response(encode(self._registry), headers={"Content-Type": content_type})

    def collect(self) -> Iterable[Metric]:
        """The families of metrics; those of axes have a label with the letter of the axis."""
        families: dict[str, GaugeMetricFamily] = {}
        for item, value in zip(self._items, self._readings, strict=True):
            name = _name_of(item)
            labels = _labels_of(item)
            if name not in families:
                keys = ["machine", *labels, *_EXTRA.get(item.row.kind, ())]
                families[name] = GaugeMetricFamily(name, _help_of(item), labels=keys)
            for extra, number in dict.fromkeys(_samples(value)):  # the same alarm twice is one
                families[name].add_metric([self._machine, *labels.values(), *extra], number)
        return families.values()


_EXTRA = {
    Kind.TEXT: ("text",),
    Kind.WORD: ("word",),
    Kind.ALARMS: ("code", "text"),
    Kind.TOOLS: ("number", "text"),
}


def _samples(value: Value) -> list[tuple[tuple[str, ...], float]]:
    """The samples of a value: the labels it adds, and a number."""
    if value is None or value == "":
        return []
    if isinstance(value, tuple):
        return [(each.labels, 1.0) for each in value]
    if isinstance(value, str):
        return [((value,), 1.0)]
    return [((), float(value))]


def _name_of(item: Item) -> str:
    name = item.row.name
    if item.chosen is not None:
        return f"openacr_user_{name}"
    of_axis = "" if item.axis is None else "axis_"
    return f"openacr_{of_axis}{name}{SUFFIXES.get(Unit(item.unit), '')}"


def _labels_of(item: Item) -> dict[str, str]:
    return {} if item.axis is None else {"axis": item.axis.name}


def _help_of(item: Item) -> str:
    unit = f" [{item.unit}]" if item.unit else ""
    return f"{item.row.meaning}{unit}"
