"""Time and accuracy of renders: forecasts, reports, costs of features. numpy, no bpy."""
