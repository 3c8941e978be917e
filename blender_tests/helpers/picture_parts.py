"""Sessions that render parts of a picture, and what two sessions of one picture must have in common: all bits."""

import contextlib
import dataclasses

import numpy as np
from tiny_scenes import showroom, with_settings

from addon.bindings.digest import scene_digest
from addon.bindings.parts import RANGE
from addon.bindings.session import Scene, Session

# Figures of lancer_statistics that depend on nothing but the samples.
COUNTED = (
    "samples", "camera_rays", "bounce_rays", "shadow_rays", "vertices", "split_lights", "split_paths",
    "invalid_samples", "invalid_x", "invalid_y", "invalid_sample",
)  # fmt: skip
# Values other than the defaults for settings of each kind of structs.SETTINGS; amounts are exact as 32 bits.
OTHER_VALUES = {"choice": 1, "number": 7, "amount": 0.375, "width": 1.75, "switch": True, "bits": 5}


def room(samples=11, size=(21, 18), **settings):
    """Return the showroom for parts; tiles at the right and upper edges are smaller."""
    given = showroom(48)
    camera = dataclasses.replace(given.camera, x=5, y=9, region_width=size[0], region_height=size[1])
    fixed = {"split_lights": 2, "split_paths": 2, "threads": 1, "in_parts": True, "samples": samples}
    return with_settings(dataclasses.replace(given, camera=camera), **{**fixed, **settings})


@contextlib.contextmanager
def opened(snapshot, **settings):
    """Context of a session for parts of a snapshot."""
    with Scene.upload(snapshot) as uploaded:
        uploaded.set_digest(scene_digest(snapshot))
        with Session(uploaded, snapshot.camera, snapshot.settings.replaced(**settings)) as session:
            yield session


def joiner(snapshot, **settings):
    """Return a session that joins parts of a snapshot."""
    return Session.joiner(scene_digest(snapshot), snapshot.camera, snapshot.settings.replaced(**settings))


def rendered(worker, ranges):
    """Return the part of these ranges alone."""
    worker.clear()
    worker.render_ranges(np.array(ranges, RANGE))
    finish(worker)
    return worker.export()


def finish(session):
    while not session.wait(0.05).finished:
        pass


def all_of(session, first, count):
    """Return ranges of the same samples of all tiles."""
    return [(tile, first, count) for tile in range(len(session.tiles()))]


def told(session):
    """Return all that a session tells of its picture: {name: bytes of a pass, part of the error, or count}."""
    facts = {which: session.read(which).tobytes() for which in session.settings.passes}
    facts |= dataclasses.asdict(session.error())
    statistics = session.statistics()
    return facts | {name: getattr(statistics, name) for name in COUNTED}


def different(one, other):
    """Return the names of the facts of told() that differ."""
    assert one.keys() == other.keys()
    return [name for name in one if one[name] != other[name]]
