"""Threads that render give way to those that draw a window: both want all processors."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import bpy

# A thread ten steps lower gets a tenth of the time of one beside it, and all that nobody else wants.
_STEPS = 10


def lowered(work):
    """What work() gives. In a window the threads that it makes have a lower priority from then on."""
    # On Linux a thread has a priority of its own, which those that it makes inherit.
    if bpy.app.background or not sys.platform.startswith("linux"):
        return work()
    return _in_a_low_thread(work)


def _in_a_low_thread(work):
    # None may raise its priority again: it is that of a thread which ends here.
    with ThreadPoolExecutor(1, initializer=_lower) as executor:
        return executor.submit(work).result()


def _lower():
    os.setpriority(os.PRIO_PROCESS, 0, min(19, os.getpriority(os.PRIO_PROCESS, 0) + _STEPS))
