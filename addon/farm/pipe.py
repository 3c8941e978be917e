"""Messages between Blender and the process that speaks to the scheduler: a line of JSON's length, the JSON, then bytes.

Blender's Python has no Dask, and an add-on cannot bring it: its parts are compiled for each Python, and two add-ons with
different copies would share one folder. So another Python runs the client, and the two talk through its standard streams.
"""

import json
import struct

import numpy as np

from ..bindings.parts import RANGE
from .cut import Task

_HEAD = struct.Struct("<IQ")
# The most bytes of a message's JSON: a message that claims more is no message.
_MOST_TEXT = 1 << 24


def write(stream, message, data=b""):
    """Write a dict for JSON and bytes."""
    text = json.dumps(message).encode()
    data = memoryview(data).cast("B")
    stream.write(_HEAD.pack(len(text), len(data)))
    stream.write(text)
    stream.write(data)
    stream.flush()


def read(stream):
    """Return (message, bytes), or None at the end of the stream."""
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    size, count = _HEAD.unpack(head)
    if size > _MOST_TEXT:
        raise ValueError("the other process writes no messages")
    text, data = stream.read(size), stream.read(count)
    return (json.loads(text), data) if len(text) == size and len(data) == count else None


def write_task(stream, task, splits):
    message = {"do": "submit", "number": task.number, "pieces": task.pieces, "samples": task.samples, "splits": list(splits)}
    write(stream, message, np.ascontiguousarray(task.ranges).view(np.uint8))


def task_of(message, data):
    """Return (Task, splits) of a message that write_task has written."""
    task = Task(message["number"], np.frombuffer(data, RANGE), message["pieces"], message["samples"])
    return task, tuple(message["splits"])
