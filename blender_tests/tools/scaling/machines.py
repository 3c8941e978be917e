"""A Dask scheduler and its workers on this machine, each in a process of its own, so that their processor times are apart."""

import contextlib
import os
import socket
import subprocess
import sys
import time

import psutil

from tools.harness import workers
from tools.harness.places import BUILD, ROOT

# Seconds until a program must be there.
_PATIENCE = 60.0
_STEP = 0.05


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Machines:
    """address: the scheduler's; processes: the scheduler, then the workers' processes."""

    def __init__(self, folder):
        self.port = free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self._log = folder / "dask.log"
        self.processes = []
        options = ("--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard", "--no-show")
        self._start("-m", "distributed.cli.dask_scheduler", *options)
        self._wait_for_scheduler()

    def add_renderer(self, threads):
        """Start a worker as users do."""
        self._start("-m", "addon.farm", "worker", self.address, "--threads", str(threads))

    def add_no_op(self, count=1):
        """Start a process of that many workers that render nothing."""
        self._start(workers.START, "scaling.no_op", self.address, str(count))

    def cpu_seconds(self):
        """Return the processor's seconds of each process so far, children included."""
        return [sum(_seconds(one) for one in _family(process)) for process in self.processes]

    def close(self):
        # The command of a worker does not end what it has started.
        members = [one for process in reversed(self.processes) for one in _family(process)]
        for one in members:
            with contextlib.suppress(psutil.NoSuchProcess):
                one.terminate()
        for one in psutil.wait_procs(members, 10)[1]:
            one.kill()
        for process in self.processes:
            process.wait()

    def _start(self, *words):
        paths = os.pathsep.join(str(path) for path in (ROOT, ROOT / "blender_tests"))
        with open(self._log, "ab") as log:
            command = [sys.executable, *(str(word) for word in words)]
            made = subprocess.Popen(command, cwd=ROOT, env=os.environ | {"PYTHONPATH": paths}, stdout=log, stderr=log)
        self.processes.append(made)

    def _wait_for_scheduler(self):
        until = time.monotonic() + _PATIENCE
        while time.monotonic() < until:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1):
                return
            time.sleep(_STEP)
        raise workers.Failed(f"the scheduler has not started: see {self._log}")


def _family(process):
    with contextlib.suppress(psutil.NoSuchProcess):
        found = psutil.Process(process.pid)
        return [found, *found.children(recursive=True)]
    return []


def _seconds(process):
    with contextlib.suppress(psutil.NoSuchProcess):
        times = process.cpu_times()
        return times.user + times.system
    return 0.0


@contextlib.contextmanager
def started():
    """Context of Machines; their output is in build/scaling/dask.log."""
    folder = BUILD / "scaling"
    folder.mkdir(parents=True, exist_ok=True)
    made = Machines(folder)
    try:
        yield made
    finally:
        made.close()


def wait_for_workers(pool, count):
    """Wait until a DaskPool has that many workers."""
    until = time.monotonic() + _PATIENCE
    while pool.workers < count:
        if time.monotonic() > until:
            raise workers.Failed(f"{pool.workers} of {count} workers have started")
        time.sleep(_STEP)
