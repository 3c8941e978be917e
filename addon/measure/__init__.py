"""What a render costs and how near it comes, told beforehand and afterwards; numpy, no bpy."""
