"""Single stages of the tracer, vectorised over numpy arrays, for tests.

Inputs broadcast to the common number of rows. Structs are returned as record arrays: hits.t, hits.normal.
"""

import ctypes

import numpy as np

from . import abi
from .abi import check, load_library


def _rows(count, value, dtype, width=None):
    """Return value broadcast to (count,) or (count, width)."""
    shape = (count,) if width is None else (count, width)
    return np.ascontiguousarray(np.broadcast_to(np.asarray(value, dtype), shape))


def _count(*vectors, scalars=()):
    """Return the common number of rows of arrays of vectors and of scalars."""
    lengths = [np.atleast_2d(v).shape[0] for v in vectors] + [np.atleast_1d(s).shape[0] for s in scalars]
    return max(lengths)


class SceneProbes:
    """Methods of a committed scene; require self.library and self.handle."""

    def made(self):
        """Return the abi.Made of the commit: the numbers of the parts that it made, by their names."""
        made = abi.Made()
        check(self.library.lancer_probe_made(self.handle, ctypes.byref(made)), self.library)
        return {name: getattr(made, name) for name, _ in made._fields_}

    def intersect(self, origins, directions, tmin=0.0, tmax=np.inf):
        """Return the closest hits with tmin < t < tmax as records of lancer_hit."""
        count, rays = self._rays(origins, directions, tmin, tmax)
        hits = np.zeros(count, np.dtype(abi.Hit))
        addresses = [a.ctypes.data for a in (*rays, hits)]
        check(self.library.lancer_probe_intersect(self.handle, count, *addresses), self.library)
        return hits.view(np.recarray)

    def occluded(self, origins, directions, tmin=0.0, tmax=np.inf):
        """Return (count,) bool: whether each ray hits anything with tmin < t < tmax."""
        count, rays = self._rays(origins, directions, tmin, tmax)
        occluded = np.zeros(count, np.uint8)
        addresses = [a.ctypes.data for a in (*rays, occluded)]
        check(self.library.lancer_probe_occluded(self.handle, count, *addresses), self.library)
        return occluded.astype(bool)

    def traversal(self, origins, directions, tmin=0.0, tmax=np.inf, any_hit=False):
        """Return the numbers of nodes, triangle blocks, sphere blocks and instances that all rays visit in the wide BVH."""
        count, rays = self._rays(origins, directions, tmin, tmax)
        counts = np.zeros(4, np.uint64)
        addresses = [a.ctypes.data for a in rays]
        check(
            self.library.lancer_probe_traversal(self.handle, count, *addresses, int(any_hit), counts.ctypes.data), self.library
        )
        return dict(zip(("nodes", "triangle_blocks", "sphere_blocks", "instances"), counts.tolist(), strict=True))

    def bsdf(self, material, wo, wi):
        """Return f (count, 3) without cosine and pdf (count,) per solid angle, in the local frame."""
        count = _count(wo, wi)
        wo, wi = (_rows(count, w, np.float32, 3) for w in (wo, wi))
        f, pdf = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)
        addresses = [a.ctypes.data for a in (wo, wi, f, pdf)]
        check(self.library.lancer_probe_bsdf(self.handle, material, count, *addresses), self.library)
        return f, pdf

    def bsdf_sample(self, material, wo, u):
        """Return records of lancer_bsdf_sample for u (count, 3)."""
        count = _count(wo, u)
        wo, u = (_rows(count, w, np.float32, 3) for w in (wo, u))
        samples = np.zeros(count, np.dtype(abi.BsdfSample))
        addresses = [a.ctypes.data for a in (wo, u, samples)]
        check(self.library.lancer_probe_bsdf_sample(self.handle, material, count, *addresses), self.library)
        return samples.view(np.recarray)

    def lobes(self, material, wo=(0.0, 0.0, 1.0)):
        """Return a material's lobes for the local direction wo, as records of lancer_lobe_info, its emission (3,) and its
        transmittance (3,).
        """
        wo = _rows(1, wo, np.float32, 3)
        emission, transmittance = np.zeros(3, np.float32), np.zeros(3, np.float32)
        count = ctypes.c_uint32()

        def ask(lobes):
            addresses = lobes.ctypes.data, len(lobes), ctypes.byref(count), emission.ctypes.data, transmittance.ctypes.data
            check(self.library.lancer_probe_lobes(self.handle, material, wo.ctypes.data, *addresses), self.library)
            return lobes

        ask(np.zeros(0, np.dtype(abi.LobeInfo)))
        lobes = ask(np.zeros(count.value, np.dtype(abi.LobeInfo)))
        return lobes.view(np.recarray), emission, transmittance

    def node(self, material, node, uv):
        """Return values (count, 4) of a material's node at texture coordinates (count, 2)."""
        count = _count(uv)
        uv, values = _rows(count, uv, np.float32, 2), np.zeros((count, 4), np.float32)
        addresses = uv.ctypes.data, values.ctypes.data
        check(self.library.lancer_probe_node(self.handle, material, node, count, *addresses), self.library)
        return values

    def world(self, directions):
        """Return the world's radiance (count, 3) in unit directions, and the pdf per solid angle of sampling them."""
        count = _count(directions)
        directions = _rows(count, directions, np.float64, 3)
        radiance, pdf = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)
        addresses = [a.ctypes.data for a in (directions, radiance, pdf)]
        check(self.library.lancer_probe_world(self.handle, count, *addresses), self.library)
        return radiance, pdf

    def light(self, light, points, u):
        """Return records of lancer_light_sample for points (count, 3) and u (count, 2)."""
        count = _count(points, u)
        points, u = _rows(count, points, np.float64, 3), _rows(count, u, np.float32, 2)
        samples = np.zeros(count, np.dtype(abi.LightSample))
        addresses = [a.ctypes.data for a in (points, u, samples)]
        check(self.library.lancer_probe_light(self.handle, light, count, *addresses), self.library)
        return samples.view(np.recarray)

    def light_pdf(self, light, points, wi):
        """Return the pdf per solid angle with which the light samples wi."""
        count = _count(points, wi)
        points, wi = (_rows(count, a, np.float64, 3) for a in (points, wi))
        pdf = np.zeros(count, np.float32)
        addresses = [a.ctypes.data for a in (points, wi, pdf)]
        check(self.library.lancer_probe_light_pdf(self.handle, light, count, *addresses), self.library)
        return pdf

    @staticmethod
    def _rays(origins, directions, tmin, tmax):
        count = _count(origins, directions, scalars=(tmin, tmax))
        vectors = [_rows(count, v, np.float64, 3) for v in (origins, directions)]
        return count, vectors + [_rows(count, t, np.float64) for t in (tmin, tmax)]


class SessionProbes:
    """Methods of a session; require self.library and self.handle."""

    def probe_camera(self, raster, lens=(0.5, 0.5)):
        """Return origins and directions (count, 3) for raster positions and lens points (count, 2)."""
        count = _count(raster, lens)
        raster, lens = (_rows(count, a, np.float64, 2) for a in (raster, lens))
        origins, directions = np.zeros((count, 3)), np.zeros((count, 3))
        addresses = [a.ctypes.data for a in (raster, lens, origins, directions)]
        check(self.library.lancer_probe_camera(self.handle, count, *addresses), self.library)
        return origins, directions


def microfacet(cos_nh, cos_lh, cos_nv, alpha, ior, library=None):
    """Return D, F and G1 of BECKMANN, each (count,)."""
    library = library or load_library()
    inputs = (cos_nh, cos_lh, cos_nv, alpha, ior)
    count = _count(scalars=inputs)
    inputs = [_rows(count, value, np.float32) for value in inputs]
    outputs = [np.zeros(count, np.float32) for _ in range(3)]
    check(library.lancer_probe_microfacet(count, *(a.ctypes.data for a in inputs + outputs)), library)
    return tuple(outputs)


def sampler(seed, x, y, sample, dimensions, library=None):
    """Return the random numbers of one sample for dimensions 0 to dimensions - 1."""
    library = library or load_library()
    out = np.zeros(dimensions, np.float32)
    check(library.lancer_probe_sampler(seed, x, y, sample, dimensions, out.ctypes.data), library)
    return out


def pixel_filter(kind, width, u, library=None):
    """Return the offsets from the pixel's centre, in pixels, that the filter samples for u (count,)."""
    library = library or load_library()
    u = np.ascontiguousarray(np.atleast_1d(u), np.float32)
    offset = np.zeros_like(u)
    check(library.lancer_probe_filter(int(kind), ctypes.c_float(width), len(u), u.ctypes.data, offset.ctypes.data), library)
    return offset
