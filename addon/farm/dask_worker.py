"""A worker of Dask that renders with all processors of its machine, one task at a time."""

import os
import subprocess
import sys


def work(address, threads=0):
    """Run a worker until its scheduler ends; return its exit code."""
    environment = os.environ | {"LANCER_THREADS": str(threads or os.cpu_count() or 1)}
    command = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nworkers", "1", "--nthreads", "1"]
    return subprocess.run(command, env=environment).returncode
