"""Why Cycles 3 shows another picture than its own models say, where more than one scene meets it."""

WALK3 = "Cycles 3 walks from facet to facet at random; the compensated lobe of Blender 4 stands in"
WALK3_TOLD = "Multiscatter GGX is computed as in Blender 4"
CLEAR_COAT3 = (
    "Cycles 3 weighs what the base throws by a chance of the clear coat that its sampler does not have, and loses a part of it "
    "under a sky; under a sun both agree (sun_on_principled_coat)"
)
CLEAR_COAT3_TOLD = "Clearcoat leaves the base its light"
CLEAR3 = (
    "Cycles 3 takes the one direction of Transparent for one of many and adds what the other lobe sends there; ours keeps them "
    "apart, as newer Cycles does"
)
CLEAR3_TOLD = "which Cycles 3 mixes with theirs"
BECKMANN3 = (
    "Cycles 3 draws Beckmann's facets by a table that it interpolates, up to 0.74 % off under a sky; under a sun both agree "
    "(sun_on_beckmann)"
)
