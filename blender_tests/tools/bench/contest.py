"""One scene, all renderers: the pictures compared, then timed by turns."""

import numpy as np

from . import chart, compare, estimates, jobs, plan, references


class Contest:
    """What all scenes share: who takes part, in which version, on how many threads."""

    def __init__(self, versions, missing, threads, limit, say):
        self.versions, self.missing, self.threads, self.limit, self.say = versions, missing, threads, limit, say
        self.snapshots = {}

    def measure(self, scene):
        """All figures of one scene, as they go into the JSON."""
        result = {"title": scene.title, "size": [scene.width, scene.height], "samples": scene.samples, "renderers": {}}
        result["reference_samples"] = scene.reference
        snapshot = str(jobs.OUTPUT / "scenes" / f"{scene.name}-{scene.width}.npz")
        self.snapshots[scene.name] = snapshot
        try:
            result.update(jobs.in_blender("snapshot", path=snapshot, **self._settings(scene)))
        except jobs.Failed as reason:
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
        pictures = self._rounds(scene, able, result["renderers"])
        if not found:
            self._compare(scene, pictures, result["renderers"])
        for renderer in able:
            self._conclude(renderer, found, result["renderers"][renderer.key])
        return result

    def _settings(self, scene):
        settings = {"name": scene.name, "threads": self.threads, "width": scene.width, "height": scene.height}
        return {**settings, "samples": scene.samples}

    def _able(self, scene, snapshot):
        """Each renderer of the scene, with the reason why it cannot render it, or None."""
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
        """By key: (reference, variance) of those that have one."""
        found = {}
        if not scene.reference:
            return found
        for renderer in able:
            if renderer.same_picture_as in found:
                found[renderer.key] = found[renderer.same_picture_as]
                continue
            self.say(f"{scene.name}: reference of {renderer.title}")
            try:
                found[renderer.key] = references.find(renderer, self.versions[renderer.key], scene, snapshot, self.render)
            except jobs.Failed as reason:
                records[renderer.key]["failed"] = str(reason)
                self.say(f"{scene.name}: {renderer.title} failed: {reason}")
        return found

    def _compare(self, scene, pictures, records):
        """Everyone's picture with ours; another one is marked, and counts nowhere."""
        if "lancer" not in pictures:
            return
        # The brightest hundredth is white, in all of them alike.
        white = float(np.percentile(pictures["lancer"], 99)) or 1.0
        for key, picture in pictures.items():
            path = jobs.OUTPUT / "pictures" / f"{scene.name}-{key}.png"
            chart.write_picture(path, picture, white)
            if key == "lancer":
                continue
            figures = compare.difference(pictures["lancer"], picture)
            tolerance = plan.BY_KEY[key].tolerance
            records[key]["difference"] = {**figures, "tolerance": tolerance, "same": compare.is_same(figures, tolerance)}

    def _rounds(self, scene, able, records):
        """Everyone once a round, with the round's seed; gives the mean picture of each."""
        folder = jobs.OUTPUT / "pictures"
        sums = {}
        for number in range(scene.rounds):
            for renderer in able:
                record = records[renderer.key]
                if "failed" in record or not record.get("difference", {"same": True})["same"]:
                    continue
                path = folder / f"{scene.name}-{renderer.key}-{number}.npy"
                try:
                    figures = self.render(renderer, scene, scene.samples, seed=number + 1, picture=str(path))
                except jobs.Failed as reason:
                    record["failed"] = str(reason)
                    self.say(f"{scene.name}: {renderer.title} failed: {reason}")
                    continue
                figures["samples_per_second"] = figures["samples"] / figures["render_seconds"]
                record.setdefault("rounds", []).append(figures)
                picture = np.load(path)
                path.unlink()
                sums[renderer.key] = sums.get(renderer.key, 0.0) + picture / scene.rounds
                record.setdefault("pictures", []).append(picture)
                self.say(f"{scene.name}: {renderer.title} {figures['samples_per_second'] / 1e6:.3f} million samples/s")
        return sums

    def _conclude(self, renderer, found, record):
        """Medians over the rounds, and what the pictures say of the error."""
        rounds, pictures = record.get("rounds", []), record.pop("pictures", [])
        if not rounds:
            return
        for name in ("samples_per_second", "setup_seconds", "first_pixel_seconds", "peak_bytes", "render_seconds"):
            record[name] = estimates.middle(figures[name] for figures in rounds)
        record["clock"] = rounds[0]["clock"]
        if "rays" in rounds[0]:
            seconds = [figures["render_seconds"] for figures in rounds]
            record["rays_per_second"] = {
                kind: estimates.middle(f["rays"][kind] / s for f, s in zip(rounds, seconds, strict=True))
                for kind in rounds[0]["rays"]
            }
        if renderer.key not in found:
            return
        reference, variance = found[renderer.key]
        errors = [estimates.squared_error(picture, reference, variance) for picture in pictures]
        seconds = [figures["render_seconds"] for figures in rounds]
        record["mse"] = estimates.middle(errors)
        record["reference_variance"] = variance
        record["errors"], record["seconds"] = errors, seconds
        record["efficiency"] = estimates.efficiency(errors, seconds)
