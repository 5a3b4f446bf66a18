"""Files of the screens: pages at `/`, `/bench` and `/login`, everything else by its own path."""

import gzip
import hashlib
import html
import json
import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from openacr.panel.commands.all import COMMANDS
from openacr.panel.server.modules import with_modules

WEB = Path(__file__).parents[1] / "web"
PART = re.compile(r"^ *<!-- include ([\w/.]+) -->\n", re.MULTILINE)
TITLES = "    <!-- titles -->\n"
PAGES = {"": "index.html", "bench": "bench.html", "login": "login.html"}
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".map": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
    ".wasm": "application/wasm",
    ".txt": "text/plain; charset=utf-8",
    ".webmanifest": "application/manifest+json",
}


def static_file(request: Request, root: Path = WEB) -> Response:
    """The file at a path."""
    path = request.path_params.get("path", "").strip("/")
    name = PAGES.get(path, path)
    place = _place(root, name)
    if place is None:
        text = f"/{path}: there is no such page" if path else "no screens are installed"
        return PlainTextResponse(text, status_code=404)
    body = _body(place)
    if place.suffix == ".html":
        body = _page(body.decode(), root).encode()
    tag = f'"{hashlib.blake2b(body, digest_size=12).hexdigest()}"'
    headers = {"ETag": tag, "Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers=headers)
    if "gzip" in request.headers.get("accept-encoding", ""):
        headers["Content-Encoding"] = "gzip"
        packed = place.with_name(f"{place.name}.gz")
        body = _body(packed) if packed.is_file() else _packed(body)
    return Response(body, media_type=TYPES[place.suffix], headers=headers)


def _page(text: str, root: Path) -> str:
    """A page with the parts and the links that its file leaves out."""

    def read(name: str) -> str:
        return _body(root / name).decode()

    return with_modules(with_titles(with_parts(text, read)), read)


def _place(root: Path, name: str) -> Path | None:
    parts = name.split("/")
    if any(part in ("", ".", "..") or part.startswith(".") for part in parts):
        return None
    place = root.joinpath(*parts)
    if place.suffix not in TYPES or not place.is_file():
        return None
    return place if place.resolve().is_relative_to(root.resolve()) else None


def _body(place: Path) -> bytes:
    """The content of a file, which is kept as long as the file is not changed."""
    stamp = place.stat()
    return _read(place, stamp.st_mtime_ns, stamp.st_size)


@lru_cache(maxsize=512)
def _read(place: Path, _changed_ns: int, _size: int) -> bytes:
    return place.read_bytes()


@lru_cache(maxsize=512)
def _packed(body: bytes) -> bytes:
    return gzip.compress(body, mtime=0)


def with_titles(page: str) -> str:
    """A page with the titles of the commands in each language, for `core/texts.js`."""
    titles = {row.name: row.titles for row in COMMANDS.values() if row.titles}
    text = html.escape(json.dumps(titles))
    return page.replace(TITLES, f'    <meta name="titles" content="{text}">\n')


def with_parts(page: str, read: Callable[[str], str]) -> str:
    """A page with its shared parts: `<!-- include parts/head.html -->` as a line is that file."""
    return PART.sub(lambda found: read(found[1]), page)
