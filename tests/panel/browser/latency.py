"""A slow link between browser and server, to find tests and screens that look too early.

    OPENACR_TEST_LATENCY_MS=500 python -m pytest tests/panel/browser

Each answer over HTTP comes later by a time drawn from 0 to this one, so that they overtake each
other; messages of the control stay in their order and come later by less than the time after which
a jog key that is not kept is let go.
"""

import os

LATENCY_MS = float(os.environ.get("OPENACR_TEST_LATENCY_MS", "0"))
MESSAGE_MS = min(LATENCY_MS, 100.0)
_SLOW = """(() => {
  const late = (value) => new Promise((done) => setTimeout(() => done(value), Math.random() * LATENCY));
  const fetchNow = window.fetch.bind(window);
  window.fetch = (...request) => fetchNow(...request).then(late);
  window.WebSocket = class extends WebSocket {
    set onmessage(heard) {
      super.onmessage = (message) => setTimeout(() => heard(message), MESSAGE);
    }
    set onclose(closed) {
      super.onclose = (event) => setTimeout(() => closed(event), MESSAGE);
    }
  };
})()"""  # noqa: E501


def slow_link() -> str:
    """The script of a page whose link is slow; empty without a latency."""
    if not LATENCY_MS:
        return ""
    return _SLOW.replace("LATENCY", str(LATENCY_MS)).replace("MESSAGE", str(MESSAGE_MS))
