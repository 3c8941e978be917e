"""The road from Blender: another Python, which has Dask, speaks to the scheduler."""

import contextlib
import os
import queue
import shutil
import subprocess
import threading
import time
from pathlib import Path

import numpy as np

from ..bindings.session import Cancelled
from . import pipe
from .pool import Done, PoolError
from .worker import Decision, Made

# A Python with Dask, from the add-on's preferences; "": the first one on the path.
default_python = ""

_STEP = 0.05
# Seconds that the other process gets to end its work.
_PATIENCE = 5.0
# Blender sets these for its own Python.
_OF_BLENDER = ("PYTHONHOME", "PYTHONPATH", "LD_LIBRARY_PATH", "LD_PRELOAD")


class PipePool:
    """python: path of a Python with Dask, "" for the default; address: a scheduler's, or "local". Methods: as LocalPool."""

    def __init__(self, python, address, poll=None, tell=None):
        self.address = address
        self.trouble = "connecting"
        self.workers = 0
        self.dashboard = ""
        self._waiting = {}
        self._inbox = queue.Queue()
        self._lock = threading.Lock()
        self._process = _started(python, address)
        self._said = b""
        for read in (self._read, self._listen):
            threading.Thread(target=read, daemon=True).start()
        while not self.workers:
            if poll is not None and poll():
                self.close()
                raise Cancelled
            self._take(_STEP)
            if tell is not None:
                tell(self.trouble)

    def open(self, name, data, poll=None):
        self._send({"do": "open", "name": name}, data)

    def decide(self, poll=None):
        self._send({"do": "decide"})
        while True:
            message, _ = self._take(_STEP) or ({}, b"")
            if message.get("is") == "decided":
                return Decision(**{name: message[name] for name in Decision._fields})
            if poll is not None and poll():
                return None

    @property
    def waiting(self):
        return len(self._waiting)

    def submit(self, task, splits):
        self._waiting[task.number] = task
        with self._lock, self._broken():
            pipe.write_task(self._process.stdin, task, splits)

    def ended(self, seconds):
        found, until = [], time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0.0 and not found:
            item = self._take(left)
            while item is not None:
                message, data = item
                task = self._waiting.pop(message.get("number"), None) if message["is"] == "ended" else None
                if task is not None:
                    found.append(_done(task, message, data))
                item = self._take(0.0)
        return found

    def refuse(self, by, why):
        self._send({"do": "refuse", "by": list(by), "why": why})

    def cancel(self):
        if not self._waiting:
            return
        self._waiting.clear()
        self._send({"do": "cancel"})
        until = time.monotonic() + _PATIENCE
        while time.monotonic() < until:
            item = self._take(_STEP)
            if item is not None and item[0]["is"] == "cancelled":
                return

    def close(self):
        with contextlib.suppress(OSError, ValueError):
            self._process.stdin.close()
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _send(self, message, data=b""):
        with self._lock, self._broken():
            pipe.write(self._process.stdin, message, data)

    @contextlib.contextmanager
    def _broken(self):
        """Turn the end of the process into a sentence."""
        try:
            yield
        except OSError:
            raise PoolError(self._last_words()) from None

    def _read(self):
        while (item := pipe.read(self._process.stdout)) is not None:
            self._inbox.put(item)
        self._inbox.put(None)

    def _listen(self):
        """Keep the end of what the process writes to its standard error."""
        for line in self._process.stderr:
            self._said = (self._said + line)[-4000:]

    def _take(self, seconds):
        """Return the next message with its bytes, or None; keep the pool's state."""
        try:
            item = self._inbox.get(timeout=seconds) if seconds > 0.0 else self._inbox.get_nowait()
        except queue.Empty:
            return None
        if item is None:
            self._inbox.put(None)
            raise PoolError(self._last_words())
        message, _ = item
        if message["is"] == "failed":
            raise PoolError(message["text"])
        if message["is"] == "state":
            self.workers, self.trouble, self.dashboard = message["workers"], message["trouble"], message["dashboard"]
        return item

    def _last_words(self):
        self._process.wait(_PATIENCE)
        lines = self._said.decode("utf-8", "replace").strip().splitlines()
        if lines and "No module named" in lines[-1]:
            python = self._process.args[0]
            return f"{python} has no Dask ({lines[-1]}): run `{python} -m pip install distributed numpy`"
        return f"the process that speaks to the scheduler has ended: {lines[-1] if lines else 'it said nothing'}"


def _started(python, address):
    python = python or default_python or shutil.which("python3") or shutil.which("python") or "python3"
    # The package as the add-on has it: it may be named by its installation.
    package = Path(__file__).resolve().parents[1]
    environment = {name: value for name, value in os.environ.items() if name not in _OF_BLENDER}
    environment["PYTHONPATH"] = str(package.parent)
    command = [python, "-m", f"{package.name}.farm", "relay", address]
    streams = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    flags = {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}
    try:
        return subprocess.Popen(command, env=environment, **streams, **flags)
    except OSError as error:
        raise PoolError(
            f"{python} cannot be started ({error}): choose a Python with Dask in the add-on's preferences"
        ) from None


def _done(task, message, data):
    if message["failure"]:
        return Done(task, None, message["failure"], tuple(message["by"]))
    part = np.frombuffer(data, np.uint8)
    return Done(task, Made(part, message["seconds"], tuple(message["made_by"]), message["instruction_set"]))
