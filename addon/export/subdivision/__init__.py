"""Adaptive subdivision: meshes divided by the size of their faces in the picture, as Cycles does."""
