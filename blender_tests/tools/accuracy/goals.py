"""Compare the figures of all scenes together with the goals."""

import math

import numpy as np

from tools.harness.verdicts import Verdict


def judge(scenes):
    """Return the Verdicts. scenes: the figures of each scene, by name."""
    even = [run for scene in scenes.values() for run in scene["even"].values()]
    targets = [run for scene in scenes.values() for run in scene["targets"]]
    if not even:
        return []
    rows = [_coverage(even), _interval(even, "holds", "error inside the interval"), _met(targets)]
    rows += [_whole(targets), _blocks(targets), _whole(even, "even samples, the control: "), _blocks(even, "even samples: ")]
    return rows + _denoised(scenes)


def _denoised(scenes):
    runs = [run for scene in scenes.values() for run in scene.get("denoised", {}).values()]
    if not runs:
        return []
    by_scene = [np.mean([share for share in run["inside_blocks"] if share is not None]) for run in runs]
    value = float(np.mean(by_scene))
    text = f"{100 * value:.1f} %, scenes from {100 * min(by_scene):.1f} to {100 * max(by_scene):.1f} %"
    blocks = Verdict("denoised: means of blocks of 8 x 8 inside their bars", "95 +- 3 %", text, abs(value - 0.95) <= 0.03)
    return [blocks, _interval(runs, "holds", "denoised: error inside the interval")]


def shares(runs):
    """Return the shares of noisy pixels that lie inside their error bar, picture by picture."""
    return [share for run in runs for share in run["inside"] if share is not None]


def _coverage(runs):
    by_scene = [np.mean(of) for of in ([s for s in run["inside"] if s is not None] for run in runs) if of]
    value = float(np.mean(by_scene))
    text = f"{100 * value:.2f} %, scenes from {100 * min(by_scene):.2f} to {100 * max(by_scene):.2f} %"
    return Verdict("noisy pixels inside their error bar", "95 +- 1.5 %", text, abs(value - 0.95) <= 0.015)


def _interval(runs, key, what):
    held = [hit for run in runs for hit in run[key]]
    unmet = [hit for run in runs for hit in run["holds_with_unmet"]]
    text = f"{100 * np.mean(held):.1f} % of {len(held)} pictures, {100 * np.mean(unmet):.1f} % with the bound on missed flashes"
    return Verdict(what, "at least 93 %", text, bool(np.mean(held) >= 0.93))


def _met(runs):
    met = [error <= run["target"] for run in runs for error in run["real"]]
    scaled = sum(run["target"] > run["asked"] for run in runs)
    text = f"{100 * np.mean(met):.1f} % of {len(met)} runs; {scaled} of {len(runs)} targets scaled up to the allowed samples"
    return Verdict("target error met", "at least 95 %", text, bool(np.mean(met) >= 0.95))


def _whole(runs, of=""):
    z = [abs(run["bias"]["whole"]) for run in runs]
    text = f"largest |z| {max(z):.2f}, root mean square {np.sqrt(np.mean(np.square(z))):.2f}, of {len(z)} mean pictures"
    return Verdict(f"{of}bias of whole pictures", "|z| at most 4", text, max(z) <= 4.0)


def allowed(count):
    """Return the most of count Gaussian numbers that lie beyond 4 standard deviations with a probability of 0.001 or more."""
    expected = count * math.erfc(4.0 / math.sqrt(2.0))
    most, term = 0, math.exp(-expected)
    below = term
    while 1.0 - below > 1e-3:
        most += 1
        term *= expected / most
        below += term
    return most


def _blocks(runs, of=""):
    z = np.abs([z for run in runs for z in run["bias"]["blocks"]])
    most, beyond = allowed(len(z)), int((z > 4).sum())
    text = f"{beyond} of {len(z)} beyond 4, largest {z.max():.2f}, root mean square {np.sqrt(np.mean(z**2)):.2f}"
    off = [abs(share) / run["target"] for run in runs if "target" in run for share in _beyond(run["bias"])]
    if off:
        text += f"; these are off by up to {100 * max(off):.1f} % of their target"
    return Verdict(f"{of}bias of blocks of 16 x 16", f"at most {most} beyond |z| 4, by chance", text, beyond <= most)


def _beyond(bias):
    """Return the biases of the blocks beyond |z| 4, which chance does not explain."""
    return [share for z, share in zip(bias["blocks"], bias["off"], strict=True) if abs(z) > 4]
