"""A Dask scheduler and workers on this machine, each a process that a test can kill."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time

from conftest import ROOT
from distributed import Client

# Seconds until a program must be there.
PATIENCE = 30.0


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class SmallCluster:
    """folder: for logs. Workers render with one thread each."""

    def __init__(self, folder):
        self.folder = folder
        self.port = free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes = []
        self.start_scheduler()

    def start_scheduler(self):
        options = ("--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard", "--no-show")
        self.scheduler = self._start("scheduler", "-m", "distributed.cli.dask_scheduler", *options)
        until = time.monotonic() + PATIENCE
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            except OSError:
                assert self.scheduler.poll() is None and time.monotonic() < until, self.said("scheduler")
                time.sleep(0.05)

    def start_worker(self, code=None):
        """Start a worker and return its process; code: run in it before, to change how it works."""
        options = (self.address, "--nworkers", "1", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory")
        preload = ()
        if code is not None:
            path = self.folder / f"preload_{len(self.processes)}.py"
            path.write_text(code)
            preload = ("--preload", str(path))
        return self._start("worker", "-m", "distributed.cli.dask_worker", *options, str(self.folder), *preload)

    def wait_for_workers(self, count):
        with Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=PATIENCE)

    def stop(self, process, how=signal.SIGKILL):
        process.send_signal(how)
        process.wait(PATIENCE)

    def said(self, name):
        return "\n".join(path.read_text() for path in sorted(self.folder.glob(f"{name}*.log")))

    def close(self):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
                process.wait()

    def _start(self, name, *command):
        environment = os.environ | {
            "PYTHONPATH": ROOT,
            "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "5s",
            "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False",
        }
        with open(self.folder / f"{name}_{len(self.processes)}.log", "wb") as log:
            process = subprocess.Popen([sys.executable, *command], env=environment, cwd=self.folder, stdout=log, stderr=log)
        self.processes.append(process)
        return process


@contextlib.contextmanager
def cluster(folder, workers=2):
    made = SmallCluster(folder)
    try:
        for _ in range(workers):
            made.start_worker()
        yield made
    finally:
        made.close()
