"""The commands `part` and `merge`: a still on farms that only run programs and share files."""

import os
import tempfile
from pathlib import Path

from ..bindings import bug_report
from ..bindings.abi import LancerError
from ..bindings.digest import scene_digest
from ..bindings.parts import describe_part
from ..bindings.session import Scene, Session
from ..measure.schedule import SAMPLES
from .cut import whole_range
from .render_snapshot import rendered_of

_STEP = 0.1
# The most bytes of a part that is read.
_MOST_BYTES = 1 << 36


def add_parsers(subparsers):
    part = subparsers.add_parser("part", help="render some samples of a snapshot into a file", description=render_part.__doc__)
    part.add_argument("snapshot", type=Path, help="a snapshot (.npz) or a bug report (.zip)")
    part.add_argument("--samples", type=int, required=True, help="of the whole picture, per pixel")
    part.add_argument("--part", type=_share, required=True, metavar="I/N", help="the I-th of N parts, from 1")
    part.add_argument("--output", type=Path, required=True)
    part.add_argument("--threads", type=int, default=0)
    part.set_defaults(run=render_part)
    merge = subparsers.add_parser("merge", help="join parts to a picture", description=merge_parts.__doc__)
    merge.add_argument("parts", type=Path, nargs="+")
    merge.add_argument("--output", type=Path, required=True, help="a picture (.exr, .png), or a part (.lancer) to join later")
    merge.set_defaults(run=merge_parts)


def _share(text):
    number, _, count = text.partition("/")
    number, count = int(number), int(count)
    if not 1 <= number <= count:
        raise ValueError
    return number, count


def render_part(arguments):
    """Render samples (I - 1) / N to I / N of the picture; a file that has them already is left as it is."""
    number, count = arguments.part
    begin, end = (arguments.samples * i // count for i in (number - 1, number))
    snapshot, _ = bug_report.load(arguments.snapshot)
    digest = scene_digest(snapshot)
    settings = snapshot.settings.replaced(in_parts=True, samples=arguments.samples, threads=arguments.threads)
    snapshot.set("settings", settings)
    if arguments.output.exists() and _holds(arguments.output, digest, begin, end):
        return 0
    with Scene.upload(snapshot, release=True) as scene:
        scene.set_digest(digest)
        with Session(scene, snapshot.camera, settings) as session:
            session.render_ranges(whole_range(begin, end - begin, len(session.tiles())))
            while not session.wait(_STEP).finished:
                pass
            write_whole(arguments.output, session.export())
    return 0


def _holds(path, digest, begin, end):
    """Whether a file is a part of this scene with these samples."""
    try:
        info = describe_part(path.read_bytes())
    except LancerError:
        return False
    return (info.digest, info.first, info.end) == (digest, begin, end)


def merge_parts(arguments):
    """Join parts in any order, and write the picture when no samples are missing."""
    session = None
    for path in arguments.parts:
        if path.stat().st_size > _MOST_BYTES:
            raise LancerError(f"{path} is larger than any part")
        part = path.read_bytes()
        try:
            if session is None:
                info = describe_part(part)
                session = Session.joiner(info.digest, info.camera, info.settings)
            session.add(part)
        except LancerError as error:
            raise LancerError(f"{path}: {error}") from error
    error = session.error()
    if arguments.output.suffix == ".lancer":
        write_whole(arguments.output, session.export())
        return 0
    planned = session.settings.samples
    if error.least_samples < planned:
        raise LancerError(f"{planned - error.least_samples} of {planned} samples are missing: give all parts")
    rendered_of(session, Joined(session)).save(arguments.output)
    return 0


class Joined:
    """What render_report.account asks of a Schedule, of parts that other processes have rendered."""

    reason, of_denoised = SAMPLES, False

    def __init__(self, session):
        self.pixels = session.camera.region_width * session.camera.region_height


def write_whole(path, data):
    """Write a file that is complete or not there: another machine may look at it at any time."""
    descriptor, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise
