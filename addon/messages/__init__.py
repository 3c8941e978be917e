"""What is told of a scene, and how much it hurts the picture. No bpy."""
