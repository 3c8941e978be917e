"""Renders and measures the course's report: `make course`."""

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The small scenes and closed forms of the tests.
sys.path[:0] = [str(ROOT), str(ROOT / "blender_tests")]

import bpy  # noqa: E402

import addon  # noqa: E402
from scenes.course import page  # noqa: E402
from scenes.course.contents import PROSE, make_chapter  # noqa: E402
from scenes.render import captured_output  # noqa: E402


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="smaller pictures and fewer rays")
    parser.add_argument("--only", default="", help="a part of the names of the chapters wanted")
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "course")
    return parser.parse_args()


def main():
    arguments = read_arguments()
    wanted = [name for name in PROSE if arguments.only in name]
    if not wanted:
        sys.exit(f"no chapter is called {arguments.only}; there are {', '.join(PROSE)}")
    arguments.output.mkdir(parents=True, exist_ok=True)
    chapters = []
    # What Blender says of the scenes that it exports is no part of the report.
    with captured_output() as (terminal, _):
        for place, name in enumerate(wanted, 1):
            terminal.write(f"{place:2}/{len(wanted)} {name:20}")
            terminal.flush()
            started = time.perf_counter()
            chapter = make_chapter(name, arguments.quick)
            chapters.append(chapter)
            terminal.write(f"{len(chapter.figures):3} figures, {time.perf_counter() - started:5.1f} s\n")
            for figure in chapter.figures:
                if not figure.ok:
                    terminal.write(f"      off: {figure.what}: {figure.measured:.6g}, expected {figure.expected}\n")
        title = f"Blender {bpy.app.version_string}, " + ("a short run" if arguments.quick else "a full run")
        page.write(chapters, arguments.output, title)
        terminal.write(f"{page.summary(chapters)}\n{arguments.output / 'index.html'}\n")
    return int(not all(chapter.ok for chapter in chapters))


if __name__ == "__main__":
    addon.register()
    try:
        status = main()
    finally:
        addon.unregister()
    sys.exit(status)
