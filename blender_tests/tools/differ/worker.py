"""Judges scenes in one Blender: answers requests, a line of JSON each, until they end; then leaves Blender as F12 would.

start.py differ.worker FD, under a Python that has bpy, and inside Blender: blender -b -P start.py -- differ.worker FD
"""

import json
import os
import sys
import tempfile

import addon

from .judge import judge
from .record import from_json


def serve(answers, folder):
    for line in sys.stdin:
        request = json.loads(line)
        records = from_json(request.pop("scene"))
        del request["task"]
        try:
            answer = judge(records, folder, **request)
        except Exception as error:
            lines = [text for text in str(error).splitlines() if text.strip()] or [""]
            answer = {"verdict": "error", "text": f"{type(error).__name__}: {lines[0][:300]}", "told": [], "seconds": 0.0}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def main():
    addon.register()
    with os.fdopen(int(sys.argv[-1]), "w", encoding="utf-8") as answers, tempfile.TemporaryDirectory() as folder:
        serve(answers, folder)
    addon.unregister()


if __name__ == "__main__":
    main()
