"""Renders without Blender, on this machine and on many others. No bpy."""
