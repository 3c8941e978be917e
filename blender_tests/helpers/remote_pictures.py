"""Pictures of a room in parts, by a pool of workers and by one session, which must have the same bits."""

import functools

from picture_parts import different, room, told

from addon.bindings.session import Pass, Session
from addon.farm.remote_session import RemoteSession
from addon.farm.still import render_still
from addon.measure.schedule import SAMPLES, TARGET

PASSES = (Pass.COMBINED, Pass.DEPTH, Pass.OBJECT_INDEX, Pass.DIFFUSE_DIRECT, Pass.HALVES, Pass.ERROR)


def picture(samples=12, **settings):
    """Return a snapshot of 12 tiles, without parts: only its RemoteSession is about those."""
    given = {"in_parts": False, "passes": PASSES, "max_bounces": 3, "split_lights": 0, "split_paths": 0, **settings}
    return room(samples, (36, 20), **given)


# Numbers of samples that are no power of two, one that ends a refinement, and a target.
PICTURES = {
    "samples": (picture(), SAMPLES),
    "splits": (picture(23), SAMPLES),
    "target": (picture(1024, target_error=0.9), TARGET),
    "unreached target": (picture(24, target_error=0.01), SAMPLES),
}


@functools.cache
def expected(name="samples"):
    """Return what one session tells of a picture, and why it ended."""
    with Session.upload(PICTURES[name][0]) as session:
        schedule = render_still(session)
        return told(session), schedule.reason


def rendered_by(pool, name="samples"):
    """Render a picture by a pool, and require the bits of one session."""
    with RemoteSession(PICTURES[name][0], pool) as session:
        schedule = render_still(session)
        assert different(told(session), expected(name)[0]) == []
        assert schedule.reason == expected(name)[1] == PICTURES[name][1]
        assert session.bytes == pool.bytes
        return session
