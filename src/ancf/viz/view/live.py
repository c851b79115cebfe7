"""A page that follows a results file while a run writes it, from a server on this machine alone."""

from __future__ import annotations

import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from ...errors import ModelError
from ...results.result import Result, load
from .page import page, page_data
from .write import shown_of

HOST = "127.0.0.1"
#: Names by which a browser on this machine may ask; others are pages of somebody else.
OWN = ("127.0.0.1", "localhost")


class LiveView:
    """Server of the page of a results file, which may grow.

    Parameters
    ----------
    path : Path
        Results file; it has to be there, with a first state.
    options : dict
        As for :func:`ancf.viz.view.shown_of`.
    port : int
        0 takes a free one.

    Raises
    ------
    ModelError
        As :func:`ancf.load`; plotly is missing, an option is wrong, or the port is taken.
    """

    def __init__(self, path: Path, options: dict[str, Any], port: int = 0) -> None:
        self._path, self._options = path, {**options, "file": path.name, "live": True}
        self._reading = threading.Lock()
        self._page = self._whole().encode("utf-8")
        try:
            self._server = ThreadingHTTPServer((HOST, port), self._handler())
        except OSError as error:
            hint = "leave --port out for a free one"
            raise ModelError("--port", f"{port} cannot be taken: {error.strerror}", hint) from None
        self._server.daemon_threads = True

    @property
    def url(self) -> str:
        """Where the page is."""
        return f"http://{HOST}:{self._server.server_address[1]}/"

    def serve(self) -> None:
        """Answer until :meth:`close` is called from another thread, or Ctrl-C is pressed."""
        try:
            self._server.serve_forever(poll_interval=0.2)
        finally:
            self._server.server_close()

    def close(self) -> None:
        """Stop answering."""
        self._server.shutdown()

    def _whole(self) -> str:
        part, how = shown_of(load(self._path), **self._options)
        return page(part, part.scene.title or self._path.name, how)

    def news(self, known: str) -> str | None:
        """What the page is to show now, as JSON; None if it knows that already."""
        with self._reading:
            result = load(self._path)
            now = stamp(result)
            if now == known or len(result.t) == 0:
                return None
            part, how = shown_of(result, **self._options)
        return json.dumps({**page_data(part, how), "known": now}, separators=(",", ":"))

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        view = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                asked = urlsplit(self.path)
                if self.headers.get("Host", "").rsplit(":", 1)[0] not in OWN:
                    self._send(403, b"only for this machine")
                elif asked.path == "/":
                    self._send(200, view._page, "text/html; charset=utf-8")
                elif asked.path == "/data":
                    self._data(parse_qs(asked.query).get("known", [""])[0])
                else:
                    self._send(404, b"not here")

            def _data(self, known: str) -> None:
                try:
                    text = view.news(known)
                except ModelError as error:  # written anew, or gone
                    self._send(503, str(error).encode("utf-8"))
                    return
                self._send(204 if text is None else 200, (text or "").encode("utf-8"), "application/json")

            def _send(self, status: int, body: bytes, kind: str = "text/plain; charset=utf-8") -> None:
                self.send_response(status)
                self.send_header("Content-Type", kind)
                self.send_header("Cache-Control", "no-store")
                if status != 204:
                    self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                if status != 204:
                    self.wfile.write(body)

            def log_message(self, format: str, *args: Any) -> None:
                """Nothing is printed for each request."""

        return Handler


def stamp(result: Result) -> str:
    """What changes when a result has more, or its run has ended."""
    try:
        steps = len(result.sensors.t)
    except ModelError:
        steps = 0
    created = result.provenance.get("created", "")
    return f"{created} {result.status} {len(result.t)} {steps}"
