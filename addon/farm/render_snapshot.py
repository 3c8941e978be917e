"""Renders a snapshot as its settings say: samples, target error, time limit; on this machine or by a pool of workers."""

import dataclasses
import math
import os
from typing import NamedTuple

import numpy as np

from ..bindings import bug_report
from ..bindings.abi import Pass
from ..bindings.mattes import metadata
from ..bindings.pass_names import NAMES
from ..bindings.session import Session
from ..bindings.snapshot import Camera, SceneSnapshot, Settings
from ..measure import render_report
from ..measure.scene_features import kernel_in_words, used_features
from ..messages.messages import Messages
from . import picture_file
from .remote_session import RemoteSession
from .still import render_still


class Rendered(NamedTuple):
    """A finished picture. Row 0 of each pass is the top row, as in image files; a Session's passes begin at the bottom."""

    passes: dict  # Blender's name of the pass -> (height, width, channels) float32, scene-linear
    statistics: dict  # samples, error, error_low, error_high, seconds and more
    messages: list  # sentences about what differs from the scene
    camera: Camera
    settings: Settings
    named_passes: tuple = ()  # the snapshot.NamedPasses among the passes
    metadata: tuple = ()  # (name, text) of the manifests of mattes

    @property
    def picture(self):
        """Combined: RGBA, colours multiplied by alpha."""
        return self.passes[NAMES[Pass.COMBINED].name]

    @property
    def channels(self):
        """The letters of each pass's channels, by its name."""
        named = (*NAMES.values(), *self.named_passes)
        return {item.name: item.channels for item in named if item.name in self.passes}

    def save(self, path, half=False):
        """Write the passes to an OpenEXR file, or the picture to a PNG file; half: colours with 16 bits. Needs OpenImageIO."""
        picture_file.write(self, path, half)


def load(path):
    """Return the SceneSnapshot in a snapshot or bug report; raise SnapshotError if it has none."""
    return bug_report.load(path)[0]


def adjusted(snapshot, samples=None, threads=None, target_error=None, time_limit=None):
    """Return the snapshot with other settings. samples alone: without its target error and time limit."""
    given = {"samples": samples, "threads": threads, "target_error": target_error, "time_limit": time_limit}
    changes = {} if samples is None else {"target_error": 0.0, "time_limit": 0.0}
    changes |= {name: value for name, value in given.items() if value is not None}
    return dataclasses.replace(snapshot, settings=dataclasses.replace(snapshot.settings, **changes)) if changes else snapshot


def render(scene, samples=None, threads=None, tell=None, pool=None, poll=None):
    """Render a SceneSnapshot, or the one in a file, and return a Rendered; raise LancerError or PoolError if that fails.

    samples, threads: in place of the snapshot's settings. tell(fraction, text) is called during the render. pool: renders
    instead of this machine, as pool.LocalPool. poll(): returns True to end the render with the samples that are there.
    """
    snapshot = adjusted(scene if isinstance(scene, SceneSnapshot) else load(os.fspath(scene)), samples, threads)
    if tell is not None:
        tell(0.0, "building the scene")
    with Session.upload(snapshot) if pool is None else RemoteSession(snapshot, pool, poll) as session:
        return rendered_of(session, render_still(session, tell, poll), snapshot)


def rendered_of(session, schedule, snapshot=None):
    """Return the Rendered of a session whose render has ended. snapshot: has the names of passes beyond those of enums.Pass."""
    passes = {NAMES[which].name: _from_top(session.read(which)) for which in _read(session.settings)}
    named, fields = (), ()
    if snapshot is not None:
        named = snapshot.named_passes
        passes |= {item.name: _from_top(session.read(item.source)) for item in named}
        fields = tuple(metadata(picture_file.LAYER, snapshot, [item.source for item in named]).items())
    messages = Messages.of_library(session.messages()).lines()
    account = render_report.account(session, schedule)
    return Rendered(passes, account, messages, session.camera, session.settings, named, fields)


def _read(settings):
    """Return the passes for files: those of the settings with names, and Combined."""
    wanted = {Pass.COMBINED, *map(Pass, settings.passes)}
    return sorted(which for which in wanted if which in NAMES)


def _from_top(image):
    return np.ascontiguousarray(image[::-1])


def report(snapshot, facts, rendered):
    """Yield sentences about a render. facts: those of its bug report."""
    for name, version in facts.get("versions", {}).items():
        yield f"reported with {name}: {version}"
    for message in facts.get("exported", ()):
        yield f"reported: {message['text']}"
    yield from rendered.messages
    numbers = rendered.statistics
    yield from render_report.lines(numbers, snapshot.settings)
    before = (facts.get("statistics") or {}).get("error", math.inf)
    if math.isfinite(before):
        yield f"reported error: {render_report.percent(before)}"
    yield f"{numbers['rays_per_second'] / 1e6:.2f} million rays/s, {numbers['threads']} threads, {numbers['instruction_set']}"
    yield from (feature.text for feature in used_features(snapshot))
    yield f"shaded by the code for {kernel_in_words(numbers['kernel'])}"
