"""Thin films on glass, metal and the Principled BSDF, whose interference colours their reflections."""

from ..bindings.shading import NodeRef
from .colorspace import luminance_weights
from .sockets import PRINCIPLED, SMALLEST_IOR

_THINNEST = 0.10000000149011612  # nanometres, 0.1 in single precision; Cycles ignores films up to this
_DEFAULT_IOR = 1.33
# The luminance of Rec. 709: the core computes the colours of films in its primaries.
_LUMINANCE = (0.2126, 0.7152, 0.0722)
_NEAR = 1e-3
_OUTSIDE = "feature:thin film outside Rec. 709"


def read_film(surface, site):
    """Return the values of film_thickness and film_ior of a lobe or a Principled; none if the node has no film."""
    graph = surface.graph
    thickness = graph.parameter(site, PRINCIPLED["film_thickness"], 0.0, low=0.0)
    if not isinstance(thickness, NodeRef) and thickness <= _THINNEST:
        return {}
    if any(abs(a - b) > _NEAR for a, b in zip(luminance_weights(), _LUMINANCE, strict=True)):
        graph.tell(site, "the colours of its film are those of Rec. 709, and not of the working space", _OUTSIDE)
    ior = graph.parameter(site, PRINCIPLED["film_ior"], _DEFAULT_IOR, low=SMALLEST_IOR)
    return {"film_thickness": thickness, "film_ior": ior}
