"""The add-on inside Blender: data by scene, the main thread, priorities, registration."""
