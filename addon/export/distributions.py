"""The statistics of a rough surface's facets, as nodes name them."""

from ..bindings.enums import Distribution, Rules
from .sockets import RULES

_DISTRIBUTIONS = {
    "SHARP": Distribution.GGX,
    "BECKMANN": Distribution.BECKMANN,
    "GGX": Distribution.GGX,
    "ASHIKHMIN_SHIRLEY": Distribution.ASHIKHMIN_SHIRLEY,
    "MULTI_GGX": Distribution.MULTI_GGX,
}


def read_distribution(graph, site):
    """Of a node that has the choice; tells where the light between facets is another than the running Blender's."""
    name = site.node.distribution
    if name == "MULTI_GGX" and RULES == Rules.BLENDER_3:
        graph.tell(site, "Multiscatter GGX is computed as in Blender 4, rough surfaces are darker at grazing angles")
    return _DISTRIBUTIONS[name]
