"""Names of inputs and outputs, and the lamps of virtual push buttons, over HTTP."""

import httpx
from tests.panel.bench import LIMIT_S, Served


def test_inputs_and_outputs_have_their_names_and_buttons_their_lamps(panel: Served) -> None:
    store = panel.panel.installation.store
    store.write_text(960_003, "Door")
    store.write_text(970_040, "Lamp")
    store.write_text(980_020, "Light")
    store.write(980_022, 40)
    store.write(980_023, 1)
    panel.call(lambda station: station.link.machine.machine.set_flag(40, True))
    with httpx.Client(base_url=panel.url, timeout=LIMIT_S) as web:
        found = web.get("/api/io").json()
        assert found["inputs"][3] == {"number": 3, "bit": 3, "name": "Door"}
        assert found["outputs"][8] == {"number": 40, "bit": 40, "name": "Lamp"}
        assert (len(found["inputs"]), len(found["outputs"])) == (32, 32)
        assert found["words"] == [4096, 4097]
        light = {"number": 1, "caption": "Light", "toggle": True, "lit": True, "bit": 40}
        assert web.get("/api/buttons").json() == {"buttons": [light]}
