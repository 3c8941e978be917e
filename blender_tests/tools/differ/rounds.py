"""One scene by both engines, in rounds that double the samples until the scene is decided: equal, different, or too noisy."""

import numpy as np

from scenes.parity import figures
from tools.parity import contest, engines

from . import data_passes

# A pass of light is judged against at least this share of the level of Combined, which it adds to.
_LEAST_SHARE = 0.2
# The least level of any picture: of a pixel this dark, a screen shows nothing; the first step of 8 bits is at 3e-4.
_DARK = 1e-4
# The most that noise may add to a limit, in limits: a fault of three times the limit is found.
_MOST_ADDED = 2.0
# The least level of vectors, in pixels, and what Cycles' single precision leaves of what stands still: places of a hundred
# pixels have an error of some 1e-5, in which the matrices of objects may err ten times as much.
_PIXEL, _STILL = 1.0, 2e-3
# The least level of a matte, which is 1 where its object covers a pixel.
_MATTE = 0.2
# No distance in a scene is larger.
_FAR = 1e9
# Samples of a scene that noise may have taken beyond its limits, in those of a scene within them.
_MORE_IN_NOISE = 8


def run(case, folder, most_samples, first_seed, hasty):
    """Return the contest.Outcome of a case; most_samples: of each half of each engine, where noise decides nothing.

    hasty: a difference far beyond the noise of few samples is final."""
    outcome = contest.Outcome(case)
    try:
        _render(case, outcome, folder, most_samples, first_seed, hasty)
    except Exception as error:
        first_line = next(iter(str(error).splitlines()), "")
        outcome.verdict, outcome.note = "error", f"{type(error).__name__}: {first_line}"
    return outcome


def _render(case, outcome, folder, most_samples, first_seed, hasty):
    scene = contest.open_empty()
    baked = case.build(scene)
    render = baked and baked.render
    both = [contest.Halves("LANCER", render), contest.Halves("CYCLES", render)]
    samples, seed = min(case.samples, most_samples), first_seed
    while True:
        for halves in both:
            halves.add(scene, case, samples, seed, folder)
        outcome.samples += 2 * samples
        outcome.seconds = {halves.engine: halves.seconds for halves in both}
        ours, theirs = (halves.pictures for halves in both)
        _complete_mattes(case, ours, theirs)
        _leave_out_invalid(ours, theirs)
        _refuse_unlike(case, ours, theirs)
        if not case.kind.averages:
            _judge_data(case, outcome, scene, ours, theirs)
            return
        _judge_light(case, outcome, ours, theirs)
        if _is_settled(case, outcome, 2 * most_samples, hasty):
            return
        # The next round doubles the samples.
        samples, seed = outcome.samples // 2, seed + 2


def _complete_mattes(case, *pictures):
    """What one engine's manifest does not name, its mattes do not show."""
    names = {name for each in pictures for name in each if name.startswith(tuple(f"{title} of " for title in case.mattes))}
    for each in pictures:
        empty = np.zeros((*next(iter(each.values()))[0].shape[:2], 1))
        each.update({name: (empty, empty) for name in names.difference(each)})


def _leave_out_invalid(ours, theirs):
    """Cycles writes any value that nodes give an AOV; Lancer writes 0 for what is not finite."""
    for name, halves in theirs.items():
        if name in engines.PASSES or name == "Alpha":
            continue
        invalid = np.logical_or(*(~np.isfinite(half) for half in halves))
        if invalid.any() and name in ours:
            theirs[name], ours[name] = (tuple(np.where(invalid, 0.0, half) for half in pair[name]) for pair in (theirs, ours))


def _refuse_unlike(case, ours, theirs):
    # With several views each has a picture of its own, by its name behind that of the pass.
    missing = {name for name in case.passes if not any(each.partition(".")[0] == name for each in theirs)}
    if missing:
        raise ValueError(f"Cycles wrote no pass {', '.join(sorted(missing))}")
    for name, (half, _) in theirs.items():
        if name not in ours:
            raise ValueError(f"Lancer wrote no pass {name}")
        if ours[name][0].shape != half.shape:
            raise ValueError(f"{name}: Lancer's picture is {ours[name][0].shape}, Cycles' is {half.shape}")


def _judge_data(case, outcome, scene, ours, theirs):
    camera = np.array(scene.camera.matrix_world.translation)
    ours, theirs = (
        {name: _moving(halves) if name == "Vector" else halves for name, halves in picture.items()}
        for picture in (ours, theirs)
    )
    found = {
        name: data_passes.differs(
            ours[name], theirs[name], camera if name == "Position" else None, _PIXEL if name == "Vector" else 0.0
        )
        for name in theirs
    }
    outcome.verdict = "fail" if any(found.values()) else "pass"
    outcome.note = "; ".join(f"{name}: {text}" for name, text in found.items() if text)


def _moving(halves):
    """Return vectors without those that are too short to tell from what stands still."""
    return tuple(np.where(np.abs(half) < _STILL, 0.0, half) for half in halves)


def _near(ours, theirs):
    """Return two pictures of depth, each two halves, with 0 where any shows the background, which has no depth of its own."""
    far = np.any([half > _FAR for half in (*ours, *theirs)], axis=0)
    return tuple(tuple(np.where(far, 0.0, half) for half in pair) for pair in (ours, theirs))


def _judge_light(case, outcome, ours, theirs):
    level = float(np.mean(np.abs(theirs["Combined"]))) if "Combined" in theirs else 0.0
    for name, pair in theirs.items():
        one, other = (ours[name], pair) if name != "Denoising Depth" else _near(ours[name], pair)
        least = _least_level(case, name, level)
        numbers = figures.measure(one, other, case.kind)
        if numbers.level < least:
            numbers = figures.measure(one, other, case.kind, np.full((1, 1, 1), least))
        elif numbers.dim and numbers.dim.level < least:
            numbers = numbers._replace(dim=None)
        outcome.parts[name] = numbers, figures.judge(numbers, case.limits)
    names = [verdict.name for _, verdict in outcome.parts.values()]
    outcome.verdict = next(name for name in figures.WORST_FIRST if name in names)


def _least_level(case, name, level):
    """Return the least level of a pass, where the level of Combined is given."""
    if name.startswith(case.mattes):
        return _MATTE
    return max(_DARK, 0.0 if name.partition(".")[0] in ("Combined", "Alpha") else _LEAST_SHARE * level)


def _is_settled(case, outcome, most_samples, hasty):
    """Whether more samples change nothing, or are too many; the verdict of a scene in noise becomes final."""
    every = [n for numbers, _ in outcome.parts.values() for n in (numbers, numbers.dim) if n]
    limit = case.limits
    if hasty and any(figures.hopeless(numbers, limit) for numbers in every):
        return True
    if outcome.verdict == "pass" and all(figures.enough(numbers, limit) for numbers in every):
        return True
    if outcome.verdict in ("pass", "fail"):
        return outcome.samples >= most_samples
    added = max(max(more.mean / limit.mean, more.p99 / limit.p99) for more in map(figures.allowance, every))
    if added <= _MOST_ADDED:
        outcome.verdict, outcome.note = "pass", f"noise adds up to {added:.2f} limits"
        return True
    if outcome.samples < most_samples:
        return False
    # Noise increases a difference and does not hide it: what is measured bounds the fault, too.
    if max(figures.share(numbers, limit) for numbers in every) <= 1.0 + _MOST_ADDED:
        outcome.verdict, outcome.note = "pass", "within the limits and what noise may add to them"
        return True
    # Four times the samples halve the noise.
    most_samples *= _MORE_IN_NOISE
    return outcome.samples >= most_samples or added * (outcome.samples / most_samples) ** 0.5 > _MOST_ADDED
