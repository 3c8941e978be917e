"""Blender's names of the film's passes and their channels, by which files and compositors refer to them. No bpy."""

from typing import NamedTuple

from .enums import Pass, PassKind


class PassName(NamedTuple):
    name: str  # from Blender 5 on
    short: str  # before
    channels: str  # a letter each


# Passes that only the denoiser reads have no names.
NAMES = {
    Pass.COMBINED: PassName("Combined", "Combined", "RGBA"),
    Pass.DEPTH: PassName("Depth", "Depth", "Z"),
    Pass.MIST: PassName("Mist", "Mist", "Z"),
    Pass.POSITION: PassName("Position", "Position", "XYZ"),
    Pass.NORMAL: PassName("Normal", "Normal", "XYZ"),
    Pass.UV: PassName("UV", "UV", "UVA"),
    Pass.VECTOR: PassName("Vector", "Vector", "XYZW"),
    Pass.OBJECT_INDEX: PassName("Object Index", "IndexOB", "X"),
    Pass.MATERIAL_INDEX: PassName("Material Index", "IndexMA", "X"),
    Pass.DIFFUSE_DIRECT: PassName("Diffuse Direct", "DiffDir", "RGB"),
    Pass.DIFFUSE_INDIRECT: PassName("Diffuse Indirect", "DiffInd", "RGB"),
    Pass.DIFFUSE_COLOR: PassName("Diffuse Color", "DiffCol", "RGB"),
    Pass.GLOSSY_DIRECT: PassName("Glossy Direct", "GlossDir", "RGB"),
    Pass.GLOSSY_INDIRECT: PassName("Glossy Indirect", "GlossInd", "RGB"),
    Pass.GLOSSY_COLOR: PassName("Glossy Color", "GlossCol", "RGB"),
    Pass.TRANSMISSION_DIRECT: PassName("Transmission Direct", "TransDir", "RGB"),
    Pass.TRANSMISSION_INDIRECT: PassName("Transmission Indirect", "TransInd", "RGB"),
    Pass.TRANSMISSION_COLOR: PassName("Transmission Color", "TransCol", "RGB"),
    Pass.EMISSION: PassName("Emission", "Emit", "RGB"),
    Pass.ENVIRONMENT: PassName("Environment", "Env", "RGB"),
    Pass.AMBIENT_OCCLUSION: PassName("Ambient Occlusion", "AO", "RGB"),
    Pass.DENOISING_NORMAL: PassName("Denoising Normal", "Denoising Normal", "XYZ"),
    Pass.ALBEDO: PassName("Denoising Albedo", "Denoising Albedo", "RGB"),
    Pass.DENOISING_DEPTH: PassName("Denoising Depth", "Denoising Depth", "Z"),
    Pass.SPECULAR_ALBEDO: PassName("Denoising Specular Albedo", "Denoising Specular Albedo", "RGB"),
    Pass.ROUGHNESS: PassName("Denoising Roughness", "Denoising Roughness", "X"),
    Pass.ERROR: PassName("Lancer Error", "Lancer Error", "X"),
}
# The beginnings of the names of Cryptomatte's passes, which two digits follow. OpenEXR keeps channels with small letters as
# they are where it compresses others with losses.
CRYPTOMATTES = {
    PassKind.OBJECT_MATTES: "CryptoObject",
    PassKind.MATERIAL_MATTES: "CryptoMaterial",
    PassKind.ASSET_MATTES: "CryptoAsset",
}
CRYPTOMATTE_CHANNELS = "rgba"
