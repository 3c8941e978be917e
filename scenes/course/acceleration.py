"""Finding the surface that a ray hits without testing all surfaces."""

import dataclasses

import numpy as np
from tiny_scenes import with_settings

from addon.bindings.abi import Accelerator
from addon.bindings.session import Scene, Session

from . import studio
from .chapter import Figure, Picture

_ROUNDS = 3


def _rendered(shot, accelerator):
    """Returns the picture and the highest number of rays per second of three renders."""
    best, picture = 0.0, None
    with Session.upload(with_settings(shot, accelerator=accelerator)) as session:
        session.render_all()
        picture, best = session.read(0), session.statistics().rays_per_second
    for _ in range(_ROUNDS - 1):
        with Session.upload(with_settings(shot, accelerator=accelerator)) as session:
            session.render_all()
            best = max(best, session.statistics().rays_per_second)
    return picture, best


def trees(quick):
    width, height = (120, 90) if quick else (200, 150)
    shot = studio.from_blender("spheres600", width, height)
    shot = with_settings(shot, samples=1, threads=0)
    pictures, rates = {}, {}
    for accelerator in (Accelerator.BRUTE_FORCE, Accelerator.KDTREE, Accelerator.BVH):
        pictures[accelerator], rates[accelerator] = _rendered(shot, accelerator)
    brute = pictures[Accelerator.BRUTE_FORCE]
    figures = [
        Figure.near(
            f"pixels in which {name} and brute force differ by a bit",
            int(np.sum(np.any(pictures[accelerator] != brute, axis=-1))),
            0,
            0,
            "the structure decides which surfaces are tested, never the result",
        )
        for accelerator, name in ((Accelerator.KDTREE, "the kd-tree"), (Accelerator.BVH, "the BVH"))
    ]
    for accelerator, name in ((Accelerator.KDTREE, "kd-tree"), (Accelerator.BVH, "BVH")):
        what = f"{name}: rays per second relative to brute force ({rates[accelerator] / 1e6:.2f} million)"
        why = "the text's own kd-tree: four times, for such a scene of 600 spheres"
        figures.append(Figure.at_least(what, rates[accelerator] / rates[Accelerator.BRUTE_FORCE], 4.0, why))
    spheres = len(shot.instances) - 1
    asked = _asked(shot)
    what = f"blocks of spheres tested per camera ray in the BVH; brute force tests {spheres} spheres"
    figures.append(Figure.at_most(what, asked["sphere_blocks"], spheres / 4, "a quarter of all, as in the text"))
    figures.append(
        Figure.at_most(
            "nodes of the BVH visited per camera ray", asked["nodes"], spheres / 4, "a quarter of all, as in the text"
        )
    )
    size = {"width": 480, "height": 360, "region_width": 480, "region_height": 360}
    large = dataclasses.replace(shot, camera=dataclasses.replace(shot.camera, **size))
    caption = "600 spheres on a plane, each mirroring the others"
    return figures, [Picture("spheres", caption, studio.render(large, samples=1 if quick else 4))]


def _asked(shot):
    """Returns the mean numbers of tests in the BVH per camera ray."""
    camera = shot.camera
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(0, camera.width, 4), np.arange(0, camera.height, 4)))
    with Session.upload(shot) as session:
        origins, directions = session.probe_camera(np.stack([x, y], axis=1))
    with Scene.upload(shot) as scene:
        counts = scene.traversal(origins, directions)
    return {name: count / len(origins) for name, count in counts.items()}


CHAPTERS = (trees,)
