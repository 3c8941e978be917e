"""How the add-on lives inside Blender: data by scene, the main thread, priorities, registration."""
