"""Rendered shading of 3D views; each view has a scene and a picture of its own."""
