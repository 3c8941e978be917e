"""The page of `make accuracy`, from accuracy.json alone."""

import numpy as np

from tools.harness import page, verdicts
from tools.harness.page import element, percent

_EVEN = ["scene", "samples", "reference: samples", "its share of the error's square", "pixels inside, of the noisy", "of all"]
_EVEN += ["error inside interval", "with the bound on missed flashes", "reported / actual", "high / actual"]
_EVEN += ["actual error", "bias z", "blocks beyond 4"]
_TARGET = ["scene", "requested", "target", "met", "actual error", "samples", "even samples needed", "bias", "bias z"]
_TARGET += ["blocks beyond 4", "reference's share"]
_DENOISED = ["scene", "samples", "pixels inside, of the noisy", "blocks of 8 x 8 inside", "error inside interval"]
_DENOISED += ["with the bound on missed flashes", "told / actual", "actual error", "before denoising, as told"]
_CYCLES = ["scene", "noise threshold", "actual error: median", "least", "most", "share at or below the threshold"]
_CYCLES += ["bias", "bias z", "blocks beyond 4", "reference's share"]


def write(figures, folder):
    scenes = figures["scenes"].items()
    parts = [
        describe(figures),
        page.table(verdicts.HEAD, [verdicts.row(goal) for goal in figures["goals"]]),
        element("h2", "Even samples: bars and intervals"),
        page.table(_EVEN, [row for name, scene in scenes for row in _even(name, scene)]),
        element("h2", "Target errors"),
        "Targets that need more samples than this program allows are scaled up.",
        page.table(_TARGET, [_target(name, run) for name, scene in scenes for run in scene["targets"]]),
        element("h2", "Denoised pictures"),
        page.table(_DENOISED, [row for name, scene in scenes for row in _denoised(name, scene)]),
        element("h2", "Cycles, noise threshold, for comparison"),
        "Cycles' noise threshold is not an error as defined here, and Cycles reports neither error bars nor intervals: the"
        " table has the actual errors of its pictures against its own reference, and the bias of their mean.",
        page.table(_CYCLES, [row for name, scene in figures["cycles"].items() for row in _cycles(name, scene)]),
    ]
    page.write(folder, "accuracy", figures, f"Is the error that renders report true? {figures['commit']}", parts)


def describe(figures):
    plan, machine = figures["plan"], figures["machine"]
    text = f"{plan['seeds']} seeds a scene, {machine['processor']}; " + ("a short run; " if figures["quick"] else "")
    return text + (
        "error: root mean square over pixels of (luminance - truth) / (truth + 1 % of its mean), less the noise of the"
        " reference, which is added to error bars. z: difference of the mean of all pictures from the reference in standard"
        " errors of both."
    )


def _bias(bias):
    beyond = int((np.abs(bias["blocks"]) > 4).sum())
    whole, blocks = f"{bias['whole']:+.2f}", f"{beyond} of {len(bias['blocks'])}"
    return (whole, "no" if abs(bias["whole"]) > 4 else ""), (blocks, "no" if beyond else "")


def _even(name, scene):
    for count, run in scene["even"].items():
        inside = [share for share in run["inside"] if share is not None]
        real, share = np.array(run["real"]), float(np.mean(inside)) if inside else None
        yield [
            name,
            count,
            scene["reference"]["samples"],
            percent(run["reference_share"]),
            (percent(share, 2), "" if abs(share - 0.95) <= 0.015 else "no") if inside else "no noise",
            percent(np.mean(run["inside_all"]), 2),
            (percent(np.mean(run["holds"])), "" if np.mean(run["holds"]) >= 0.93 else "no"),
            percent(np.mean(run["holds_with_unmet"])),
            f"{np.mean(np.array(run['told']) / real):.3f}" if real.all() else "",
            f"{np.mean(np.array(run['high']) / real):.3f}" if real.all() else "",
            f"{np.mean(real):.4f}",
            *_bias(run["bias"]),
        ]


def _denoised(name, scene):
    for count, run in scene.get("denoised", {}).items():
        inside, of_blocks = ([share for share in run[key] if share is not None] for key in ("inside", "inside_blocks"))
        real = np.array(run["real"])
        yield [
            name,
            count,
            percent(np.mean(inside), 1) if inside else "no noise",
            (percent(np.mean(of_blocks), 1), "" if abs(np.mean(of_blocks) - 0.95) <= 0.03 else "no")
            if of_blocks
            else "no noise",
            percent(np.mean(run["holds"])),
            percent(np.mean(run["holds_with_unmet"])),
            f"{np.mean(np.array(run['told']) / real):.2f}" if real.all() else "",
            f"{np.mean(real):.4f}",
            f"{np.mean(run['noisy']):.4f}",
        ]


def _target(name, run):
    return [
        name,
        f"{run['asked']:g}",
        f"{run['target']:g}",
        (percent(run["met"]), "" if run["met"] >= 0.95 else "no"),
        f"{np.mean(run['real']):.4f}",
        f"{run['samples']:.0f}",
        f"{run['samples'] * run['even_samples_ratio']:.0f}",
        f"{percent(run['bias']['relative'], 3)} +- {percent(run['bias']['relative_error'], 3)}",
        *_bias(run["bias"]),
        percent(run["reference_share"]),
    ]


def _cycles(name, scene):
    if "failed" in scene:
        yield [name, (scene["failed"], "absent")]
        return
    for run in scene["thresholds"]:
        real = run["real"]
        yield [
            name,
            f"{run['threshold']:g}",
            f"{np.median(real):.4f}",
            f"{min(real):.4f}",
            f"{max(real):.4f}",
            percent(np.mean(np.array(real) <= run["threshold"])),
            f"{percent(run['bias']['relative'], 3)} +- {percent(run['bias']['relative_error'], 3)}",
            *_bias(run["bias"]),
            percent(run["reference_share"]),
        ]
