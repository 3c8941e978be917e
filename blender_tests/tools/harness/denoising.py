"""Denoised pictures by F12, of Lancer and of Cycles."""

import bpy

from tools.harness.f12 import press_f12


def denoise(scene, on=True):
    """Let both engines denoise with their own guides, by the best network."""
    scene.lancer.use_denoising = scene.cycles.use_denoising = on
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    if hasattr(scene.cycles, "denoising_use_gpu"):
        scene.cycles.denoising_use_gpu = False
    bpy.context.view_layer.update()


def curve(scene, engine, counts, seed, set_samples):
    """Return [(samples, seconds of F12, picture)]; the first render, which fills the caches, is left out."""
    scene.render.engine = engine
    found = []
    for count in (counts[0], *counts):
        set_samples(scene, count, seed)
        rendered = press_f12(scene)
        found.append((count, rendered.wall, rendered.picture[..., :3]))
    return found[1:]
