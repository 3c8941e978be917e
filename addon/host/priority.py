"""Lower priority of render threads, so that Blender's window stays responsive: both use all processors."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import bpy

# With a nice value five higher a thread gets a third of the time of a competing thread, and all idle time. With a higher value
# other programs could stall a render.
_STEPS = 5


def lowered(work):
    """Return work(). Unless in background mode, threads created by work have a lower priority for their whole life."""
    return work() if bpy.app.background else _in_a_low_thread(work)


def lower():
    """Lower the priority of the calling thread and of threads that it creates later; it cannot be raised again."""
    # On Linux each thread has a priority of its own, which threads that it creates inherit.
    if sys.platform.startswith("linux"):
        os.setpriority(os.PRIO_PROCESS, 0, min(19, os.getpriority(os.PRIO_PROCESS, 0) + _STEPS))


def _in_a_low_thread(work):
    # Blender's thread keeps its priority: a temporary thread creates the render threads.
    with ThreadPoolExecutor(1, initializer=lower) as executor:
        return executor.submit(work).result()
