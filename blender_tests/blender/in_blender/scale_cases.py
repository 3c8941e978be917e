"""The same scenes of several sizes and at several places."""

import bpy
import numpy as np
import stage


def _resize(factor):
    """Multiply all lengths by the factor, and the lamps' power so that the picture stays the same."""
    for item in bpy.context.scene.objects:
        item.location *= factor
        data = item.data
        if item.type == "CAMERA":
            data.clip_start, data.clip_end = factor * data.clip_start, factor * data.clip_end
            data.dof.focus_distance *= factor
            # The lens has the diameter focal length / f-stop.
            data.dof.aperture_fstop /= factor
        elif item.type == "LIGHT":
            if data.type != "SUN":
                data.energy *= factor * factor
            for name in ("shadow_soft_size", "size", "size_y"):
                if hasattr(data, name):
                    setattr(data, name, factor * getattr(data, name))
        elif item.type == "MESH":
            item.scale *= factor


def _move(offset):
    for item in bpy.context.scene.objects:
        item.location += offset


def _compare(build):
    from addon.engine import render_engine as engine

    def picture(change=None):
        scene = build()
        if change is not None:
            change()
        bpy.context.view_layer.update()
        return stage.picture(scene).astype(float)

    def far_apart(other):
        def squares(p):
            return p.reshape(4, 8, 4, 8, 4).mean(axis=(1, 3))

        return float(np.max(np.abs(squares(other) - squares(here)) / squares(here)))

    here = picture()
    messages = [str(text) for texts in engine.last_messages.values() for text in texts]
    powers = {f"2^{power}": picture(lambda p=power: _resize(2.0**p)) for power in (-10, 10)}
    sizes = {str(factor): picture(lambda f=factor: _resize(f)) for factor in (0.001, 1000)}
    sizes["moved"] = picture(lambda: _move(stage.Vector((8192.0, -4096.0, 2048.0))))
    return {
        "mean": float(here[..., :3].mean()),
        "messages": messages,
        "equal": {name: bool(np.array_equal(here, other)) for name, other in powers.items()},
        "squares": {name: far_apart(other) for name, other in sizes.items()},
    }


def _workshop():
    """Smooth and exact balls, glass, lamps with extent, a lens."""
    scene = stage.empty(samples=16)
    stage.plane(material=stage.shader(Color=(0.6, 0.6, 0.6)))
    stage.ball(material=stage.shader(Color=(0.8, 0.3, 0.1)), segments=24, location=(-1.25, 0, 1))
    exact = stage.cube(2.0, stage.shader("ShaderNodeBsdfGlass", IOR=1.5), location=(1.25, 0, 1))
    exact.lancer.shape = "SPHERE"
    stage.light("POINT", 300.0, (2, -2, 4), shadow_soft_size=0.25)
    stage.light("AREA", 200.0, (-3, -1, 4), (0.5, -0.5, 0), size=1.5)
    stage.sky((0.3, 0.3, 0.4))
    eye = stage.camera((0, -6, 3), (0, 0, 0.5), clip_start=0.125, clip_end=256.0)
    eye.data.dof.use_dof, eye.data.dof.focus_distance, eye.data.dof.aperture_fstop = True, 6.0, 0.5
    return scene


def _terrace():
    """Copies of one mesh, turned and mirrored, under a sun, with a spot."""
    scene = stage.empty(samples=16)
    stage.plane(material=stage.shader("ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.5, 0.45), Roughness=0.6))
    look = stage.shader("ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.2, 0.1), Metallic=0.5, Roughness=0.3)
    first = stage.ball(0.5, look, segments=16, location=(0, 0, 0.5))
    for i in range(8):
        copy = stage.link(f"Copy {i}", first.data, (0.5 * i - 2, i % 3 - 1, 0.25 + 0.125 * i), (0.3 * i, 0.2, 0.1))
        copy.scale = (0.5, -0.75 if i % 2 else 0.75, 1.0)
    stage.light("SUN", 3.0, (0, 0, 5), (0.8, 0.2, 0))
    stage.light("SPOT", 400.0, (0, -2, 5), (0.35, 0, 0), spot_size=0.9, shadow_soft_size=0.125)
    stage.sky((0.2, 0.25, 0.4))
    stage.camera((0, -6, 3), (0, 0, 0.5), clip_start=0.125, clip_end=256.0)
    return scene


def workshop():
    return _compare(_workshop)


def terrace():
    return _compare(_terrace)
