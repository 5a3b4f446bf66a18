"""A slow link between browser and server, to find tests and screens that look too early.

    OPENACR_TEST_LATENCY_MS=300 python -m pytest tests/panel/browser

Every message and answer reaches the page later by this time, in its order.
"""

import os

LATENCY_MS = float(os.environ.get("OPENACR_TEST_LATENCY_MS", "0"))
_SLOW = """(() => {
  const late = (value) => new Promise((done) => setTimeout(() => done(value), LATENCY));
  const fetchNow = window.fetch.bind(window);
  window.fetch = (...request) => fetchNow(...request).then(late);
  window.WebSocket = class extends WebSocket {
    set onmessage(heard) {
      super.onmessage = (message) => setTimeout(() => heard(message), LATENCY);
    }
    set onclose(closed) {
      super.onclose = (event) => setTimeout(() => closed(event), LATENCY);
    }
  };
})()"""


def slow_link() -> str:
    """The script of a page whose link is slow; empty without a latency."""
    return _SLOW.replace("LATENCY", str(LATENCY_MS)) if LATENCY_MS else ""
