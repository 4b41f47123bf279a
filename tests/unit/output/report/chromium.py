"""Headless Chromium by its debugging pipe: JSON messages, a null byte after each, on file descriptors 3 and 4."""

import fcntl
import json
import os
import select
import shutil
import subprocess
import time

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
]
_TIMEOUT_S = 60.0


def _pipe():
    """Both ends of a pipe, above the numbers that the browser uses."""
    low = os.pipe()
    high = tuple(fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in low)
    for end in low:
        os.close(end)
    return high


class Browser:
    """A browser with one tab; `events` holds everything it told besides its answers."""

    def __init__(self, profile):
        self.events, self._number, self._received = [], 0, b""
        from_us, self._write = _pipe()
        self._read, to_us = _pipe()

        def as_the_browser_expects():
            os.dup2(from_us, 3)
            os.dup2(to_us, 4)

        self._process = subprocess.Popen(
            [CHROMIUM, *FLAGS, f"--user-data-dir={profile}"],
            preexec_fn=as_the_browser_expects,
            pass_fds=(3, 4),
            stderr=subprocess.DEVNULL,
        )
        os.close(from_us)
        os.close(to_us)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = None
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    _session = None

    def call(self, method, **parameters):
        """The answer to a command."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method):
        """Return when the browser has told this event."""
        while not self.told(method):
            self.events.append(self._next())

    def told(self, method):
        """What the browser told by this event so far."""
        return [event["params"] for event in self.events if event.get("method") == method]

    def evaluate(self, expression):
        """The value of a JavaScript expression in the page."""
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)["result"][
            "value"
        ]

    def close(self):
        """End the browser."""
        self._session = None
        try:
            self.call("Browser.close")
        finally:
            self._process.wait(timeout=_TIMEOUT_S)
            os.close(self._read)
            os.close(self._write)

    def _next(self):
        end = time.monotonic() + _TIMEOUT_S
        while b"\0" not in self._received:
            ready, _, _ = select.select([self._read], [], [], max(end - time.monotonic(), 0.0))
            chunk = os.read(self._read, 1 << 20) if ready else b""
            assert chunk, "the browser fell silent"
            self._received += chunk
        message, self._received = self._received.split(b"\0", 1)
        return json.loads(message)
