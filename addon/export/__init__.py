"""The only place that reads Blender's data: one file for each kind of thing."""
