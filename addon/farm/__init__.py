"""Renders without Blender, on this machine and on others. No bpy."""
