"""How fast rays could be: what the processor does at best, and what a ray asks of it.

A step through a node of eight boxes keeps the two floating-point ports busy for some 11 cycles, a block of four triangles for
22, so that nodes and blocks a ray bound the rays a second of a core by its clock alone; caches only take from it.
"""

from . import jobs

NODE_CYCLES, LEAF_CYCLES = 11.0, 22.0


def measure(threads):
    """Clock, latencies and bandwidths of this machine."""
    program = jobs.OUTPUT / "machine_limits"
    source = jobs.HERE / "rays" / "machine.cpp"
    # It runs here and now, and is to show what this very processor can do.
    jobs.build("c++", "-O3", "-std=c++20", "-march=native", "-pthread", source, "-o", program)
    return jobs.run([str(program), str(threads)])


def bound(nodes, leaves, clock, threads):
    """Rays a second that so many nodes and leaves a ray allow."""
    return threads * clock / (nodes * NODE_CYCLES + leaves * LEAF_CYCLES)


def rows(limits, rays, threads):
    """A row for each kind of ray whose nodes and leaves the library has counted; none where it counts nothing."""
    result = []
    for kind, counts in rays.get("counts", {}).items():
        roof = bound(counts["nodes"], counts["leaves"], limits["clock"], threads)
        rate = rays["lancer"][kind]["median"]
        result.append({"what": kind, **counts, "bound": roof, "measured": rate, "fraction": rate / roof})
    return result
