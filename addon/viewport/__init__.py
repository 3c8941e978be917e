"""Rendered shading of 3D views: one thread and one picture for each."""
