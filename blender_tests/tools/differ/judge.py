"""One scene by both engines: whether they differ, as `make parity` judges, and what Lancer has told of it."""

import time

import bpy

from addon.engine import results
from addon.messages.severity import Severity
from scenes.parity import figures
from scenes.parity.catalogue import Case

from . import rounds
from .builder import build

_SAMPLES = 32  # of each half of each engine, at first
_NO_PASSES = "these passes are not supported"


def make_case(records):
    frame = next((record.fields for record in records if record.verb == "frame"), {})
    passes = tuple(frame.get("passes", ("Combined",)))
    if bpy.app.version < (4, 0):
        # Lancer reports its passes for denoising as other than Cycles 3's; the message would excuse all other passes.
        passes = tuple(name for name in passes if not name.startswith("Denoising")) or ("Combined",)
    fields = {"passes": passes, "dark": (*passes, "Alpha"), "size": tuple(frame.get("size", (48, 32))), "samples": _SAMPLES}
    fields |= {name: frame[name] for name in ("bounces", "transparent_bounces", "filter_width") if name in frame}
    fields["passes"] += tuple(name for record in records for name in _made_passes(record))
    verbs = {record.verb for record in records}
    fields["limited"] = {**frame.get("limited", {}), **({"use_fast_gi": True} if "fast_gi" in verbs else {})}
    fields["simplify"] = not verbs.isdisjoint(("culling", "texels"))
    fields["mattes"] = tuple(frame.get("mattes", ()))
    if not verbs.isdisjoint(("bake", "eyes")):
        fields |= {"passes": ("Combined",), "mattes": ()}
    kind = frame.get("kind", "LOBES")
    if kind == "DATA":
        fields |= {"kind_name": "PIXELS", "filter_width": 0.01, "samples": _SAMPLES // 2}
    else:
        fields["kind_name"] = kind
    return Case("scene", "differ", lambda scene: _build(scene, records), **fields)


def _made_passes(record):
    """The passes that a record makes."""
    if record.verb == "light_group":
        return (f"Combined_{record.name}",)
    return (record.name,) if record.verb == "aov" else ()


def _build(scene, records):
    # What the check before a render finds is of a scene's faults, which both engines show.
    scene.lancer.use_check = False
    # Small pictures, and several workers beside one another.
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    return build(scene, records)


def judge(records, folder, most_samples, first_seed=1, hasty=True):
    """{"verdict": pass, fail, noise or error; "note"; "figures": of the worst pass; "told": messages of another picture}"""
    started = time.perf_counter()
    results.last_messages.clear()
    case = make_case(records)
    outcome = rounds.run(case, folder, most_samples, first_seed, hasty)
    answer = {
        "verdict": outcome.verdict,
        "note": outcome.note,
        "samples": outcome.samples,
        "told": _told(),
        "engines": outcome.seconds,
    }
    if outcome.worst is not None:
        numbers = figures.decisive(outcome.parts[outcome.worst][0], case.limits)
        answer |= {"pass": outcome.worst, "mean": numbers.mean, "p99": numbers.p99, "noise": numbers.noise_mean}
        answer["share"] = figures.share(numbers, case.limits)
        answer["text"] = f"{outcome.worst}: mean {numbers.mean:.3%} of {case.limits.mean:.2%}, worst block {numbers.p99:.3%}"
        answer["text"] += f" of {case.limits.p99:.2%}, noise {numbers.noise_mean:.3%}; {outcome.samples} samples"
    else:
        answer["text"] = outcome.note or f"equal: {', '.join(case.passes)}"
    return {**answer, "seconds": time.perf_counter() - started}


def _told():
    """Sentences that say that the picture is another than Cycles'."""
    messages = results.last_messages.get("Scene") or ()
    if not messages:
        return []
    # A picture that is missing is as magenta in Cycles. A pass that is missing is noticed, and excuses no other.
    texts = [item.text for item in messages.told() if item.key or Severity.DIFFERENT <= item.severity < Severity.WRONG]
    return [text for text in texts if _NO_PASSES not in text]
