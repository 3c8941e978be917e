"""Messages about a scene and their severity. No bpy."""
