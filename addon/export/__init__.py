"""The only room that reads Blender's scenes: one file for each kind of data."""
