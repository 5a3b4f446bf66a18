"""Inputs and outputs with their names, and the virtual push buttons."""

from collections.abc import Sequence

from openacr.map import numbers as n
from openacr.mill.card.machine_io import line_numbers
from openacr.models import MODELS
from openacr.panel.control.operator.buttons import COUNT, TOGGLE
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, endpoint
from openacr.sysvar.tabs import CONTROL, GENERAL, OFFSETS

BITS = 32  # of a flag word


@endpoint("GET", "/io")
async def lines(call: Call) -> object:
    """Inputs and outputs of card and modules with names; `words` are those of the topic flags."""
    store = call.panel.installation.store
    model = MODELS[store.read_text(GENERAL.card_model)]
    inputs, outputs = line_numbers(model.lines, int(store.read(CONTROL.io_expansion_modules)))

    def rows(numbers: list[int], names: Sequence[int]) -> list[dict[str, object]]:
        return [
            {"number": line, "bit": line, "name": store.read_text(names[line])} for line in numbers
        ]

    return {
        "inputs": rows(inputs, OFFSETS.input_name),
        "outputs": rows(outputs, OFFSETS.output_name),
        "words": sorted({n.FLAG_WORD_BASE + bit // BITS for bit in [*inputs, *outputs]}),
    }


@endpoint("GET", "/buttons")
async def buttons(call: Call) -> object:
    """The virtual push buttons that have a caption, with the state of their lamps."""
    store = call.panel.installation.store
    shown = [k for k in range(COUNT) if store.read_text(OFFSETS.button_caption[k])]
    flags = {k: int(store.read(OFFSETS.button_show_bit[k])) for k in shown}
    lamps = [flag for flag in flags.values() if flag >= 0]

    def read(station: Station) -> list[bool]:
        return station.link.required.card.read_bits(lamps) if lamps else []

    states = await call.panel.ask(read)
    lit = dict(zip(lamps, states, strict=True))
    return {
        "buttons": [
            {
                "number": k,
                "caption": store.read_text(OFFSETS.button_caption[k]),
                "toggle": store.read(OFFSETS.button_mode[k]) == TOGGLE,
                "lit": lit.get(flags[k], False),
                "bit": flags[k],
            }
            for k in shown
        ]
    }
