"""One scene, all renderers: compare the pictures, then time the renderers by turns."""

import hashlib
import os
import tempfile

import numpy as np

from tools.harness import denoised, estimates, pictures
from tools.harness.displayed import Displayed
from tools.harness.kept import kept_picture
from tools.harness.turns import by_turns, middle, middles
from tools.harness.workers import Failed

from . import jobs, plan

# The renderers that denoise, and their engines; the seeds of their curves, and the samples of a short run.
_DENOISES = {"lancer": "LANCER", "cycles": "CYCLES"}
_SEEDS, _QUICK_COUNTS = 3, (8, 16, 32, 64, 128)
# Seeds of the two halves of references: far from the seeds of the rounds.
_REFERENCE_SEEDS = (1001, 1002)


def digest_of_scene(path):
    """Return a digest of the arrays in a snapshot's file, independent of compression. Only the sums of rows of three numbers
    (positions, normals, corners) count: Blender's threads build a mesh's faces, and sum its normals, in any order."""
    result = hashlib.sha256()
    with np.load(path) as arrays:
        for name in sorted(arrays.files):
            array = arrays[name]
            if array.ndim == 2 and array.shape[1] == 3:
                # Normals differ in their last bits, by 1e-6 in their sum; adding zero turns -0 into 0.
                array = np.array([*array.shape, *(np.round(array.sum(axis=0, dtype=float), 2) + 0.0)])
            result.update(name.encode())
            result.update(np.ascontiguousarray(array).tobytes())
    return result.hexdigest()[:16]


class Contest:
    """The measurement of scenes: the renderers, their versions, and the number of threads."""

    def __init__(self, versions, missing, threads, limit, say):
        self.versions, self.missing, self.threads, self.limit, self.say = versions, missing, threads, limit, say
        self.snapshots = {}
        self.halves = {}  # of references, by scene and renderer

    def measure(self, scene):
        """Return all figures of one scene, for the JSON."""
        result = {"title": scene.title, "size": [scene.width, scene.height], "samples": scene.samples, "renderers": {}}
        result["reference_samples"], result["group"] = scene.reference, scene.group
        snapshot = str(jobs.OUTPUT / "scenes" / f"{scene.name}-{scene.width}.npz")
        self.snapshots[scene.name] = snapshot
        try:
            result.update(jobs.in_blender("snapshot", path=snapshot, **self._settings(scene)))
        except Failed as reason:
            self.say(f"{scene.name}: cannot be built: {reason}")
            return {**result, "failed": str(reason)}
        able = []
        for renderer, reason in self._able(scene, snapshot):
            if reason is None:
                able.append(renderer)
                result["renderers"][renderer.key] = {}
            else:
                result["renderers"][renderer.key] = {"cannot": reason}
        found = self._references(scene, snapshot, able, result["renderers"])
        self._compare(scene, {key: picture for key, (picture, _) in found.items()}, result["renderers"])
        shown = self._rounds(scene, able, result["renderers"])
        if not found:
            self._compare(scene, shown, result["renderers"])
        for renderer in able:
            self._conclude(renderer, found, result["renderers"][renderer.key])
        result["denoised"] = self._denoised(scene)
        return result

    def _denoised(self, scene):
        """Return the curves of Lancer's and Cycles' denoised pictures, and their comparison; None without both references."""
        if any((scene.name, key) not in self.halves for key in _DENOISES):
            return None
        counts = _QUICK_COUNTS if scene.rounds < _SEEDS else denoised.COUNTS
        points = {key: [] for key in _DENOISES}
        for seed in range(1, min(scene.rounds, _SEEDS) + 1):
            for key, engine in _DENOISES.items():
                points[key].append(self._denoised_curve(scene, engine, counts, seed))
                self.say(f"{scene.name}: denoised by {engine}, seed {seed}")
        curves = {key: denoised.measured(found, Displayed.of(self.halves[scene.name, key])) for key, found in points.items()}
        return {"curves": curves, "compared": denoised.compared(*curves.values())}

    def _denoised_curve(self, scene, engine, counts, seed):
        settings = {"name": scene.name, "threads": self.threads, "width": scene.width, "height": scene.height}
        with tempfile.TemporaryDirectory() as folder:
            walls = jobs.in_blender("denoised", engine=engine, counts=counts, seed=seed, folder=folder, **settings)
            return [(count, seconds, np.load(os.path.join(folder, f"{count}.npy"))) for count, seconds in walls]

    def _settings(self, scene):
        settings = {"name": scene.name, "threads": self.threads, "width": scene.width, "height": scene.height}
        return {**settings, "samples": scene.samples}

    def _able(self, scene, snapshot):
        """Yield each renderer of the scene, with the reason why it cannot render the scene, or None."""
        chosen = [plan.BY_KEY[key] for key in scene.renderers]
        modules = sorted({renderer.module for renderer in chosen if renderer.module and renderer.key not in self.missing})
        reasons = jobs.with_peer("check", modules=modules, snapshot=snapshot) if modules else {}
        for renderer in chosen:
            if renderer.key in self.missing:
                yield renderer, f"missing: {self.missing[renderer.key]}"
            elif scene.exact and renderer.key == "cycles":
                yield renderer, "it has no exact spheres, and would trace the meshes that stand in for them"
            else:
                yield renderer, reasons.get(renderer.module)

    def render(self, renderer, scene, samples, seed, picture=None, first_look=True):
        arguments = {"threads": self.threads, "samples": samples, "seed": seed, "picture": picture, "first_look": first_look}
        if renderer.engine:
            size = {"width": scene.width, "height": scene.height}
            return jobs.in_blender("render", engine=renderer.engine, name=scene.name, **size, **arguments)
        snapshot = self.snapshots[scene.name]
        return jobs.with_peer(
            "render", module=renderer.module, option=renderer.option, snapshot=snapshot, limit=self.limit, **arguments
        )

    def _references(self, scene, snapshot, able, records):
        """Return {key of a renderer: (reference, variance)}."""
        found = {}
        if not scene.reference:
            return found
        for renderer in able:
            if renderer.same_picture_as in found:
                found[renderer.key] = found[renderer.same_picture_as]
                continue
            self.say(f"{scene.name}: reference of {renderer.title}")
            try:
                found[renderer.key] = self._reference(scene, snapshot, renderer)
            except Failed as reason:
                records[renderer.key]["failed"] = str(reason)
                self.say(f"{scene.name}: {renderer.title} failed: {reason}")
        return found

    def _reference(self, scene, snapshot, renderer):
        """Return a renderer's own converged picture, from which its errors are measured, and the variance of its pixels."""
        key = f"{self.versions[renderer.key]} {digest_of_scene(snapshot)} {scene.reference}"
        name = f"{scene.name}-{renderer.key}-{hashlib.sha256(key.encode()).hexdigest()[:16]}"
        halves = []
        for number, seed in enumerate(_REFERENCE_SEEDS):
            settings = {"samples": scene.reference // 2, "seed": seed, "first_look": False}

            def render(path, settings=settings):
                self.render(renderer, scene, picture=str(path), **settings)

            halves.append(kept_picture(jobs.OUTPUT / "references" / f"{name}-{number}.npy", render))
        self.halves[scene.name, renderer.key] = halves
        return estimates.join_halves(*halves)

    def _compare(self, scene, shown, records):
        """Compare each picture with ours; a renderer whose picture differs is marked and left out of all ratios."""
        if "lancer" not in shown:
            return
        # The brightest hundredth of our picture is white in all of them.
        white = float(np.percentile(shown["lancer"], 99)) or 1.0
        for key, picture in shown.items():
            path = jobs.OUTPUT / "pictures" / f"{scene.name}-{key}.png"
            pictures.write_picture(path, picture, white)
            if key == "lancer":
                continue
            figures = pictures.difference(shown["lancer"], picture)
            tolerance = plan.BY_KEY[key].tolerance
            records[key]["difference"] = {**figures, "tolerance": tolerance, "same": pictures.is_same(figures, tolerance)}

    def _rounds(self, scene, able, records):
        """Run each renderer once per round, with the round's seed. Return the mean picture of each."""
        by_turns(scene.rounds, able, lambda renderer, number: self._round(scene, renderer, number, records[renderer.key]))
        rendered = {key: record.get("pictures", []) for key, record in records.items()}
        return {key: sum(found) / scene.rounds for key, found in rendered.items() if found}

    def _round(self, scene, renderer, number, record):
        if "failed" in record or not record.get("difference", {"same": True})["same"]:
            return
        path = jobs.OUTPUT / "pictures" / f"{scene.name}-{renderer.key}-{number}.npy"
        try:
            figures = self.render(renderer, scene, scene.samples, seed=number + 1, picture=str(path))
        except Failed as reason:
            record["failed"] = str(reason)
            self.say(f"{scene.name}: {renderer.title} failed: {reason}")
            return
        figures["samples_per_second"] = figures["samples"] / figures["render_seconds"]
        record.setdefault("rounds", []).append(figures)
        record.setdefault("pictures", []).append(np.load(path))
        path.unlink()
        self.say(f"{scene.name}: {renderer.title} {figures['samples_per_second'] / 1e6:.3f} million samples/s")

    def _conclude(self, renderer, found, record):
        """Store the medians over the rounds, and the error of the pictures."""
        rounds, rendered = record.get("rounds", []), record.pop("pictures", [])
        if not rounds:
            return
        names = ("samples_per_second", "setup_seconds", "first_pixel_seconds", "peak_bytes", "render_seconds")
        record.update(middles(rounds, names))
        record["clock"] = rounds[0]["clock"]
        if "rays" in rounds[0]:
            seconds = [figures["render_seconds"] for figures in rounds]
            record["rays_per_second"] = {
                kind: middle(f["rays"][kind] / s for f, s in zip(rounds, seconds, strict=True)) for kind in rounds[0]["rays"]
            }
        if renderer.key not in found:
            return
        reference, variance = found[renderer.key]
        errors = [estimates.squared_error(picture, reference, variance) for picture in rendered]
        seconds = [figures["render_seconds"] for figures in rounds]
        record["mse"] = middle(errors)
        record["reference_variance"] = variance
        record["errors"], record["seconds"] = errors, seconds
        record["efficiency"] = estimates.efficiency(errors, seconds)
