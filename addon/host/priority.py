"""Threads that render give way to those that draw a window: both want all processors."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import bpy

# A thread five steps lower gets a third of the time of one beside it, and all that nobody else wants. With more steps other
# programs could stop a render.
_STEPS = 5


def lowered(work):
    """What work() gives. In a window the threads that it makes have a lower priority from then on."""
    return work() if bpy.app.background else _in_a_low_thread(work)


def lower():
    """Lowers that of the calling thread and of those that it makes from now on; it cannot be raised again."""
    # On Linux a thread has a priority of its own, which those that it makes inherit.
    if sys.platform.startswith("linux"):
        os.setpriority(os.PRIO_PROCESS, 0, min(19, os.getpriority(os.PRIO_PROCESS, 0) + _STEPS))


def _in_a_low_thread(work):
    # Blender's own thread keeps its priority: a short-lived one makes those that render.
    with ThreadPoolExecutor(1, initializer=lower) as executor:
        return executor.submit(work).result()
