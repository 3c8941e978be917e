"""Settings: properties, presets, preferences, links to the manual."""
