"""Files of images with 8 bits, as the export reads them and as Blender gives them to scripts."""

import os
import tempfile

import bpy
import numpy as np
import stage
from export_cases import export_told
from image_cases import image, ramp, show

from addon.export import image_sources
from addon.export.decoded import Decoded

_KINDS = {"PNG": ("BW", "RGB", "RGBA"), "JPEG": ("BW", "RGB"), "WEBP": ("RGB", "RGBA"), "BMP": ("RGB",), "TARGA": ("RGBA",)}
_MODES = ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE")


def _files():
    """Yield (name, path) of a file of each kind."""
    scene, item, folder = bpy.context.scene, image("written", ramp()), tempfile.mkdtemp()
    settings = scene.render.image_settings
    for kind, modes in _KINDS.items():
        for mode in modes:
            settings.file_format, settings.color_mode = kind, mode
            path = os.path.join(folder, f"{kind}_{mode}")
            item.save_render(path, scene=scene)
            yield f"{kind} {mode}", path


def _bytes(path, alpha_mode):
    """Return the bytes of a file, without an alpha that is 1 everywhere or ignored."""
    item = bpy.data.images.load(path, check_existing=False)
    item.colorspace_settings.is_data, item.alpha_mode = True, "CHANNEL_PACKED"
    values = np.empty(len(item.pixels), np.float32)
    item.pixels.foreach_get(values)
    texels = np.rint(255.0 * values).astype(int).reshape(item.size[1], item.size[0], -1)
    bpy.data.images.remove(item)
    return texels[:, :, :3] if alpha_mode == "NONE" or (texels[:, :, 3] == 255).all() else texels


def kinds():
    """Return the texels of each kind of file, apart and packed, and those wanted; by the name of the image.

    Return also the names of the images that were read as bytes.

    A packed image that is to be divided by alpha is left out: Blender has divided its bytes.
    """
    stage.empty()
    wanted = {}
    for name, path in _files():
        for mode in _MODES if "RGBA" in name else ("STRAIGHT",):
            for is_packed in (False, True):
                if is_packed and mode == "PREMUL":
                    continue
                item = bpy.data.images.load(path, check_existing=False)
                item.name, item.alpha_mode = f"{name} {mode} {is_packed}", mode
                if is_packed:
                    item.pack()
                    item.buffers_free()
                show(item)
                wanted[item.name] = _bytes(path, mode).tolist()
    decoded, read_texels = [], image_sources.read_texels

    def watched(item, source, *arguments):
        if isinstance(source, Decoded):
            decoded.append(item.name)
        return read_texels(item, source, *arguments)

    image_sources.read_texels = watched
    exported, messages = export_told()
    image_sources.read_texels = read_texels
    texels = {picture.name: picture.texels.tolist() for picture in exported.images}
    told = {"messages": list(messages), "version": list(bpy.app.version)}
    return {"wanted": wanted, "got": texels, "decoded": decoded, **told}
