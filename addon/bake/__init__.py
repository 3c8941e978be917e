"""Object > Bake: what the texels of an image show of a surface."""
