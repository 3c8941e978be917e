"""Rendered shading of 3D views: each has a scene and a picture of its own."""
