"""Pictures without their noise, by the library that Blender brings."""
