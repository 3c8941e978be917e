"""The commands `part` and `merge`: a still on farms that only run programs and share files."""

import argparse
import contextlib
import os
import tempfile
from pathlib import Path

from ..bindings.abi import LancerError, Status
from ..bindings.digest import scene_digest
from ..bindings.parts import describe_part
from ..bindings.session import Scene, Session
from ..measure.schedule import SAMPLES, Schedule
from . import picture_file
from .arguments import count, loaded, require_folder, threads
from .cut import whole_range
from .exit_codes import DONE, WrongUse
from .render_snapshot import rendered_of

# Ending of files of parts that `merge` writes.
_PART = ".lancer"
# Seconds between looks at a running range.
_STEP = 0.1


def add_parsers(subparsers):
    """Add both commands, as render_command.add_parser does."""
    part = subparsers.add_parser("part", help="render some samples of a snapshot into a file", description=render_part.__doc__)
    part.add_argument("snapshot", type=Path, help="a snapshot (.npz) or a bug report (.zip)")
    part.add_argument("--samples", type=count, required=True, help="of the whole picture, per pixel")
    part.add_argument("--part", type=_share, required=True, metavar="I/N", help="the I-th of N parts, from 1")
    part.add_argument("--output", type=Path, required=True, help="file of the part")
    part.add_argument("--threads", type=threads, default=0, help="default: one per processor")
    part.set_defaults(run=render_part)
    merge = subparsers.add_parser("merge", help="join parts to a picture", description=merge_parts.__doc__)
    merge.add_argument("parts", type=Path, nargs="+", help="files of parts, in any order")
    merge.add_argument("--output", type=Path, required=True, help="a picture (.exr, .png), or a part (.lancer) to join later")
    merge.set_defaults(run=merge_parts)


def _share(text):
    """Return (I, N) of "I/N"."""
    number, _, of = text.partition("/")
    if count(number) > count(of):
        raise argparse.ArgumentTypeError(f"{text} is no part from 1/{of} to {of}/{of}")
    return int(number), int(of)


def render_part(arguments):
    """Render samples (I - 1) / N to I / N of the picture; a file that has them already is left as it is."""
    number, parts = arguments.part
    if parts > arguments.samples:
        raise WrongUse(f"{arguments.samples} samples are too few for {parts} parts")
    begin, end = (arguments.samples * i // parts for i in (number - 1, number))
    require_folder(arguments.output)
    snapshot, _ = loaded(arguments.snapshot)
    digest = scene_digest(snapshot)
    settings = snapshot.settings.replaced(in_parts=True, samples=arguments.samples, threads=arguments.threads)
    snapshot.set("settings", settings)
    if _is_rendered(arguments.output, Session.joiner(digest, snapshot.camera, settings), begin, end):
        return DONE
    with Scene.upload(snapshot, release=True) as scene:
        scene.set_digest(digest)
        with Session(scene, snapshot.camera, settings) as session:
            session.render_ranges(whole_range(begin, end - begin, len(session.tiles())))
            while not session.wait(_STEP).finished:
                pass
            write_whole(arguments.output, session.export())
    return DONE


def _is_rendered(path, joiner, begin, end):
    """Whether a file has exactly these samples of the joiner's picture."""
    with joiner:
        try:
            part = path.read_bytes()
            about = describe_part(part)
            joiner.add(part)
        except (FileNotFoundError, LancerError):
            return False
        samples = int(joiner.tiles().sum()) * (end - begin)
        # Other parts of the picture ask for the same number of samples: it decides whether numbers of lights are searched.
        planned = about.settings.samples == joiner.settings.samples
        return planned and (about.first, about.end, about.samples) == (begin, end, samples)


def merge_parts(arguments):
    """Join parts in any order, and write the picture when no samples are missing."""
    # Learn before the work that its file cannot be written.
    is_part = arguments.output.suffix.lower() == _PART
    require_folder(arguments.output)
    if not is_part:
        what = picture_file.fault(arguments.output)
        if what:
            raise WrongUse(what)
        picture_file.library()
    with contextlib.ExitStack() as stack:
        session = None
        for path in arguments.parts:
            with _told_of(path):
                part = path.read_bytes()
                about = describe_part(part)
                if session is None:
                    session = stack.enter_context(Session.joiner(about.digest, about.camera, about.settings))
                _require_planned(about, session.settings.samples)
                session.add(part)
        if is_part:
            write_whole(arguments.output, session.export())
            return DONE
        missing = session.settings.samples - session.error().least_samples
        if missing:
            raise WrongUse(f"{missing} of {session.settings.samples} samples are missing: give all parts")
        schedule = Schedule(session)
        schedule.reason = SAMPLES
        rendered_of(session, schedule).save(arguments.output)
    return DONE


@contextlib.contextmanager
def _told_of(path):
    """Context in which errors are about a file; a wrong file is wrong use."""
    try:
        yield
    except FileNotFoundError:
        raise WrongUse(f"{path}: there is no such file") from None
    except LancerError as error:
        kind = LancerError if error.status is Status.ERROR_MEMORY else WrongUse
        raise kind(f"{path}: {error}") from error


def _require_planned(about, samples):
    """Raise LancerError for a part of a picture of another number of samples: joined to others it would leave gaps."""
    if about.settings.samples != samples:
        raise LancerError(f"part: its picture has {about.settings.samples} samples, that of the first part {samples}")
    if about.end > samples:
        raise LancerError(f"part: it has sample {about.end - 1} of a picture of {samples} samples")


def write_whole(path, data):
    """Write a file that is complete or not there: another machine may look at it at any time."""
    with tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as place:
        whole = Path(place, path.name)
        whole.write_bytes(data)
        os.replace(whole, path)
