"""Reasons for which Cycles 3 deviates from its own models, where several scenes have the same one."""

WALK3 = "Cycles 3 simulates a random walk between facets; Lancer uses the compensated lobe of Blender 4 instead"
WALK3_TOLD = "Multiscatter GGX is computed as in Blender 4"
CLEAR_COAT3 = (
    "Cycles 3 weights samples of the base by a probability of the clear coat that its sampler does not use, and loses some of "
    "their light under a sky; under a sun both agree (sun_on_principled_coat)"
)
CLEAR_COAT3_TOLD = "Clearcoat leaves the base its light"
CLEAR3 = (
    "Cycles 3 treats the single direction of Transparent as a sampled one and adds the light of the other lobe in that "
    "direction; Lancer keeps them separate, as newer versions of Cycles do"
)
CLEAR3_TOLD = "which Cycles 3 mixes with theirs"
BECKMANN3 = (
    "Cycles 3 samples Beckmann's facets by an interpolated table, with errors up to 0.74 % under a sky; under a sun both "
    "agree (sun_on_beckmann)"
)
