"""How much memory adaptive subdivision needs."""

from ...host.machine_memory import memory_left

# The bytes of a triangle while it is made, copied into the library and sorted there: 50 in each of two copies, 100 of the
# points from which it is made, and 100 of the accelerator.
BYTES_OF_TRIANGLE = 300


# The bytes of a corner of the mesh that is divided: 100 of a patch of 16 points for four of them, 200 of its edges and half of
# an edge across, and three times as much while they are split. Measured: 800 for a grid of a million squares.
_BYTES_OF_CORNER = 900


def most_triangles(corners):
    """Return how many triangles fit into memory besides a mesh of that many corners of faces."""
    return max(0, memory_left() - corners * _BYTES_OF_CORNER) // BYTES_OF_TRIANGLE
