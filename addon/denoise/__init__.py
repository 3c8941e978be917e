"""Denoising by the library that Blender contains."""
