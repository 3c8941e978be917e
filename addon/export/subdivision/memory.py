"""How much memory adaptive subdivision needs."""

from ...host.machine_memory import memory_left

# The bytes of a triangle while it is made, copied into the library and sorted there: 50 in each of two copies, 100 of the
# points from which it is made, and 100 of the accelerator.
BYTES_OF_TRIANGLE = 300


def most_triangles():
    return memory_left() // BYTES_OF_TRIANGLE
