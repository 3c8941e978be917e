"""A scene's verdict by a worker in a Blender of its own: a crash or a hang is a fault of the scene, and a new worker starts."""

import contextlib

from tools.harness.conversation import Conversation, Ended

from .record import to_json
from .shrinker import shrink

# A fault is judged again with other seeds and more samples: of thousands of scenes chance alone makes some look different.
_SECOND_SEED, _MORE = 101, 4
FAULTS = ("fail", "error", "crash", "timeout", "memory")
_MOST_TOLD = 4
# A smaller scene has the same fault if its difference, in limits, is at least this share of the whole scene's.
_LEAST_SHARE, _MOST_SHARE = 0.25, 100.0


class Hunt:
    def __init__(self, command, log, environment, most_samples=128, seconds=120.0, bytes_=4e9):
        self._start = lambda: Conversation(command, log, environment)
        self._worker = None
        self.most_samples, self.seconds, self.bytes = most_samples, seconds, bytes_

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        """Lets the worker leave by itself, so that Blender says what it has not freed. Gives its exit code."""
        if self._worker is None:
            return 0
        worker, self._worker = self._worker, None
        with worker:
            with contextlib.suppress(BrokenPipeError):
                worker.process.stdin.close()
            return worker.process.wait(timeout=60)

    def judge(self, records, most_samples=None, first_seed=1, hasty=True):
        """The answer of judge.judge, or {"verdict": crash, timeout or memory, "text"}."""
        if self._worker is None:
            self._worker = self._start()
        request = {"scene": to_json(records), "most_samples": most_samples or self.most_samples, "first_seed": first_seed}
        request["hasty"] = hasty
        try:
            return self._worker.ask("judge", self.seconds, self.bytes, **request)
        except Ended as ended:
            worker, self._worker = self._worker, None
            worker.__exit__()
            return {"verdict": ended.kind, "text": str(ended), "told": [], "seconds": self.seconds}

    def verdict(self, records):
        """pass, noise, told or a fault: the answer, judged twice where it is none.

        The second time a picture of few lit blocks, whose noise few samples measure badly, gets all its samples."""
        answer = self.judge(records)
        if answer["verdict"] in FAULTS:
            answer = self.judge(records, _MORE * self.most_samples, _SECOND_SEED, hasty=bool(answer["told"]))
        if answer["verdict"] == "fail" and answer["told"]:
            silent = self._beside_told(records, answer)
            answer = silent or {**answer, "verdict": "told"}
        return answer

    def _beside_told(self, records, answer):
        """The answer of the scene without the things that messages name, where that differs without a message; else None.

        A message excuses the difference of its thing, and of no other.
        """
        for _ in range(_MOST_TOLD):
            named = {record.name for record in records for text in answer["told"] if f"'{record.name}'" in text}
            # A message of a node names its material, too, which may well stay.
            nodes = {record.name for record in records if record.verb == "node" and record.name in named}
            gone = nodes or named
            if not gone:
                return None
            records = [record for record in records if record.name not in gone]
            answer = self.judge(records, _MORE * self.most_samples, _SECOND_SEED)
            if answer["verdict"] not in FAULTS:
                return None
            if not answer["told"]:
                return {**answer, "scene": records}
        return None

    def shrink(self, records, answer, tell=lambda text: None):
        """(The smallest scene with a fault of that kind, its answer)."""
        verdict, smallest = answer["verdict"], [answer]
        # As many samples as have shown the fault do so again; most candidates show it at once or never.
        most_samples = min(max(32, answer.get("samples", 0) // 2), 2 * self.most_samples)

        def fails(candidate):
            found = self.judge(candidate, most_samples, _SECOND_SEED, hasty=False)
            if found["verdict"] != verdict or found["told"] or found.get("pass") != answer.get("pass"):
                return False
            if found.get("share", 1.0) < min(answer.get("share", 1.0), _MOST_SHARE) * _LEAST_SHARE:
                return False
            if verdict == "error" and found["text"] != answer["text"]:
                return False
            smallest[0] = found
            return True

        return shrink(records, fails, tell), smallest[0]
