"""The C library's interface for numpy arrays. No bpy."""
