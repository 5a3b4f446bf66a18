"""Links opened beside the control thread: a host that does not answer takes seconds."""

import threading
from concurrent.futures import Future
from contextlib import suppress

from openacr.client.links import Link, ProcessLink


def opened(link: Link) -> "Future[None]":
    """Open a link, in a thread of its own unless the card is in this process; done at its end."""
    future: Future[None] = Future()

    def run() -> None:
        try:
            link.open()
        except Exception as error:
            future.set_exception(error)
        else:
            future.set_result(None)

    if isinstance(link, ProcessLink):
        run()
    else:
        threading.Thread(target=run, name="card", daemon=True).start()
    return future


def close(link: Link, opening: "Future[None] | None" = None) -> None:
    """Close a link; one that is still being opened is closed as soon as it is open."""

    def end() -> None:
        with suppress(Exception):
            link.close()

    if opening is None:
        end()
    else:
        opening.add_done_callback(lambda _done: end())
