"""Facts about the particle that an instance stands for, as values of the instance table."""

from .hashes import hash_of, unit

# Names of these values begin so; the rest is the identifier of the output of the Particle Info node.
PARTICLE = "particle:"
_FIELDS = {
    "Lifetime": "lifetime", "Location": "location", "Size": "size", "Velocity": "velocity",
    "Angular Velocity": "angular_velocity",
}  # fmt: skip
_NO_PARTICLE = 0  # Cycles' stand-in has this index, and zeros


def particle_value(entry, name, frame):
    """Return (x, y, z, alpha) of an entry of the depsgraph; those of no particle if it stands for none. frame: the scene's."""
    system, index = entry.particle_system, _NO_PARTICLE
    # Numbers from the count of particles on are children, of which Blender tells nothing.
    particle = None
    if system is not None and entry.persistent_id[0] < len(system.particles):
        index = entry.persistent_id[0]
        particle = system.particles[index]
    field = name[len(PARTICLE) :]
    if field == "Index":
        return _spread(float(index))
    if field == "Random":
        return _spread(random_of_particle(index))
    if particle is None:
        return 0.0, 0.0, 0.0, 1.0
    if field == "Age":
        return _spread(frame - particle.birth_time)
    value = getattr(particle, _FIELDS[field])
    return (*map(float, value), 1.0) if hasattr(value, "__len__") else _spread(float(value))


def random_of_particle(index=_NO_PARTICLE):
    return float(unit(hash_of(index, 0)))


def _spread(number):
    return number, number, number, 1.0
