"""Microfacet distributions of shader nodes."""

from ..bindings.enums import Distribution, Rules
from ..bindings.shading import NodeRef
from .arithmetic import is_constant
from .sockets import RULES

_DISTRIBUTIONS = {
    "SHARP": Distribution.GGX,
    "BECKMANN": Distribution.BECKMANN,
    "GGX": Distribution.GGX,
    "ASHIKHMIN_SHIRLEY": Distribution.ASHIKHMIN_SHIRLEY,
    "MULTI_GGX": Distribution.MULTI_GGX,
}


# Cycles' Ashikhmin-Shirley also reflects at back-facing facets. Seen from 5 degrees above the surface, that adds 0.1 % of the
# light at this roughness, 1 % at 0.3 and a third at 0.5.
_ROUGH = 0.25


def read_distribution(graph, site, roughness=0.0, anisotropy=0.0):
    """Return the Distribution of a node; add a message if the running Blender's Cycles shades it differently.

    roughness and anisotropy: the node's exported values, for nodes that offer all distributions.
    """
    name = site.node.distribution
    if name == "ASHIKHMIN_SHIRLEY" and (isinstance(roughness, NodeRef) or roughness > _ROUGH):
        told = "Ashikhmin-Shirley follows its model, under a sky a rough surface is darker at grazing angles than in Cycles"
        graph.tell(site, told)
    stretched = not is_constant(roughness, 0.0) and not is_constant(anisotropy, 0.0)
    if name == "BECKMANN" and stretched and RULES == Rules.BLENDER_3:
        # Cycles 3 samples facets from another distribution than it evaluates: it loses or gains light, depending on the view.
        told = "anisotropic Beckmann follows its model, under a sky the surface is darker or brighter than in Cycles 3"
        graph.tell(site, told)
    if name == "MULTI_GGX" and RULES == Rules.BLENDER_3:
        graph.tell(site, "Multiscatter GGX is computed as in Blender 4, rough surfaces are darker at grazing angles")
    return _DISTRIBUTIONS[name]
