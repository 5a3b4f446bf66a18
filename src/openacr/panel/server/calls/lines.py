"""Inputs and outputs with their names, and the virtual push buttons."""

import asyncio

from openacr.map.numbers import W_INPUTS
from openacr.mill.card.machine_io import INPUTS, OUTPUTS
from openacr.panel.control.buttons import COUNT, TOGGLE
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, endpoint
from openacr.sysvar.tabs import OFFSETS


@endpoint("GET", "/io")
async def lines(call: Call) -> object:
    """Inputs and outputs of the card with their names; `words` are those of the topic flags."""
    text = call.panel.installation.store.read_text

    def rows(numbers: range, names: range) -> list[dict[str, object]]:
        return [{"number": n, "bit": n, "name": text(names[n])} for n in numbers]

    return {
        "inputs": rows(INPUTS, OFFSETS.input_name),
        "outputs": rows(OUTPUTS, OFFSETS.output_name),
        "words": [W_INPUTS, W_INPUTS + 1],
    }


@endpoint("GET", "/buttons")
async def buttons(call: Call) -> object:
    """The virtual push buttons that have a caption, with the state of their lamps."""
    store = call.panel.installation.store
    shown = [n for n in range(COUNT) if store.read_text(OFFSETS.button_caption[n])]
    flags = {n: int(store.read(OFFSETS.button_show_bit[n])) for n in shown}
    lamps = [flag for flag in flags.values() if flag >= 0]

    def read(station: Station) -> list[bool]:
        return station.machine.card.read_bits(lamps) if lamps else []

    states = await asyncio.wrap_future(call.panel.control.call(read))
    lit = dict(zip(lamps, states, strict=True))
    return {
        "buttons": [
            {
                "number": n,
                "caption": store.read_text(OFFSETS.button_caption[n]),
                "toggle": store.read(OFFSETS.button_mode[n]) == TOGGLE,
                "lit": lit.get(flags[n], False),
                "bit": flags[n],
            }
            for n in shown
        ]
    }
