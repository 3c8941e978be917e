"""Workers of Dask that render: one task at a time, with all threads that they are given."""

import os
import subprocess
import sys

# Dask looks at its own threads up to a hundred times a second, to draw where Python spends its time: a tenth of a processor,
# for nothing while C++ renders.
_QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "500ms",
    "distributed.worker.memory.monitor-interval": "1s",
}


def work(address, threads=0):
    """Run a worker with all processors, or that number of threads, until its scheduler ends; return its exit code."""
    variables = {"DASK_" + name.upper().replace(".", "__").replace("-", "_"): str(value) for name, value in _QUIET.items()}
    variables["LANCER_THREADS"] = str(threads or os.cpu_count() or 1)
    command = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nworkers", "1", "--nthreads", "1"]
    return subprocess.run(command, env=os.environ | variables).returncode


def local_cluster(workers=2, threads=0):
    """Return a distributed.LocalCluster of processes on this machine, which share its processors."""
    import dask
    from distributed import LocalCluster

    each = threads or max(1, (os.cpu_count() or 1) // workers)
    dask.config.set(_QUIET)
    return LocalCluster(n_workers=workers, threads_per_worker=each, processes=True)
