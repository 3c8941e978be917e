"""The road from arrays to the C library; knows neither bpy nor Blender."""
