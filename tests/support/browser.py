"""A page in Chromium without a window, driven over the pipes of its debugging protocol."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import threading
from contextlib import contextmanager
from typing import Any

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
QUIET = """--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
--disable-component-update --disable-sync --hide-scrollbars --remote-debugging-pipe""".split()
PATIENCE = 120.0
"""Seconds after which a browser that still runs is ended."""


class Page:
    """A page of a running browser, with what it told and asked for since it was opened."""

    def __init__(self, requests, answers):
        self._requests, self._answers, self._count, self._session = requests, answers, 0, None
        self.errors: list[str] = []
        self.requests: list[str] = []

    def send(self, method: str, **params: Any) -> dict:
        """Send a command; return its answer, and keep the events before it."""
        self._count += 1
        message = {"id": self._count, "method": method, "params": params}
        message |= {"sessionId": self._session} if self._session else {}
        self._requests.write(json.dumps(message).encode() + b"\0")
        self._requests.flush()
        while True:
            answer = self._read()
            if answer.get("id") == self._count:
                assert "error" not in answer, answer
                return answer["result"]

    def _read(self) -> dict:
        """Read a message; keep what it tells of errors and of requests."""
        text = bytearray()
        while (letter := self._answers.read(1)) not in (b"\0", b""):
            text += letter
        assert text, "the browser ended"
        message = json.loads(text)
        event, params = message.get("method"), message.get("params")
        if event == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"]))
        if event == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(json.dumps(params["args"]))
        if event == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        return message

    def open(self, url: str, width: int, height: int = 900, dark: bool = False, still: bool = False) -> None:
        """Open an address in a window of this size, and wait until it is loaded.

        still: the system asks for less motion
        """
        self.errors, self.requests, self._session = [], [], None
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Network", "Page"):
            self.send(f"{domain}.enable")
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.send("Emulation.setDeviceMetricsOverride", **size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        motion = {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}
        self.send("Emulation.setEmulatedMedia", features=[scheme, motion])
        self.send("Page.navigate", url=url)
        while self._read().get("method") != "Page.loadEventFired":
            pass

    def evaluate(self, script: str) -> Any:
        """Return what the body of an asynchronous function returns."""
        body = f"(async () => {{ {script} }})()"
        answer = self.send("Runtime.evaluate", expression=body, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def move(self, left: float, top: float) -> None:
        """Move the mouse to a place in the window."""
        self.send("Input.dispatchMouseEvent", type="mouseMoved", x=left, y=top)

    def turn_wheel(self, left: float, top: float, down: float) -> None:
        """Turn the wheel of the mouse at a place in the window."""
        self.send("Input.dispatchMouseEvent", type="mouseWheel", x=left, y=top, deltaX=0, deltaY=down)


@contextmanager
def browser(folder):
    """Yield a page of a browser that keeps its files in a folder."""
    to_browser, requests = os.pipe()
    answers, from_browser = os.pipe()

    def connect():
        os.dup2(to_browser, 3)
        os.dup2(from_browser, 4)

    command = [CHROMIUM, *QUIET, f"--user-data-dir={folder}"]
    with subprocess.Popen(
        command, preexec_fn=connect, pass_fds=(3, 4), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        os.close(to_browser)
        os.close(from_browser)
        timer = threading.Timer(PATIENCE, process.kill)
        timer.start()
        try:
            with os.fdopen(requests, "wb") as write, os.fdopen(answers, "rb") as read:
                yield Page(write, read)
        finally:
            timer.cancel()
            process.kill()
