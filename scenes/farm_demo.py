"""Renders the showcase by a scheduler and two workers on this machine: `make farm-demo` calls it."""

import argparse
import contextlib
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

SNAPSHOT = ROOT / "build" / "farm-demo.npz"
PICTURE = ROOT / "build" / "farm-demo.png"
# Seconds until a program must be there.
PATIENCE = 60.0


def export_showcase():
    """Saves the snapshot of the showcase, by Blender's Python module."""
    import bpy

    import addon
    import scenes
    from addon.engine import render_export

    addon.register()
    try:
        scenes.load("showcase")
        bpy.context.scene.render.engine = "LANCER"
        render_export.export(bpy.context).snapshot.save(SNAPSHOT)
    finally:
        addon.unregister()


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


@contextlib.contextmanager
def running(*command, **environment):
    """Runs a module of this Python in the background, with its output in build/farm-demo.log."""
    with open(ROOT / "build" / "farm-demo.log", "ab") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", *command], env=os.environ | environment, stdout=log, stderr=log, cwd=ROOT
        )
    try:
        yield process
    finally:
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10)
        process.kill()


def wait_for(port):
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
            return
        time.sleep(0.1)
    sys.exit("the scheduler has not started: see build/farm-demo.log")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    (ROOT / "build").mkdir(exist_ok=True)
    export_showcase()
    port, dashboard = free_port(), free_port()
    address = f"tcp://127.0.0.1:{port}"
    threads = str(max(1, (os.cpu_count() or 1) // arguments.workers))
    with contextlib.ExitStack() as stack:
        command = ("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(port))
        stack.enter_context(running(*command, "--dashboard-address", f"127.0.0.1:{dashboard}"))
        wait_for(port)
        for _ in range(arguments.workers):
            stack.enter_context(running("addon.farm", "worker", address, "--threads", threads))
        told = f"== a scheduler at {address} with {arguments.workers} workers; dashboard: http://127.0.0.1:{dashboard}/status\n"
        sys.stdout.write(told)
        sys.stdout.flush()
        render = ("addon.farm", str(SNAPSHOT), "--scheduler", address, "--output", str(PICTURE))
        done = subprocess.run([sys.executable, "-m", *render, "--samples", str(arguments.samples)], cwd=ROOT)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
