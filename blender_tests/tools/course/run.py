"""Render and measure the course's report: `make course`."""

import sys

import bpy

from scenes.course.contents import PROSE, make_chapter
from scenes.render import captured_output
from tools.harness.f12 import registered
from tools.harness.terminal import Progress, make_parser

from . import page


def read_arguments():
    only = "a part of the names of the chapters wanted"
    return make_parser(__doc__, quick="smaller pictures and fewer rays", only=only, output="course").parse_args()


def main():
    arguments = read_arguments()
    wanted = [name for name in PROSE if arguments.only in name]
    if not wanted:
        sys.exit(f"no chapter is called {arguments.only}; there are {', '.join(PROSE)}")
    arguments.output.mkdir(parents=True, exist_ok=True)
    chapters = []
    # Messages about the exported scenes do not belong to the report.
    with captured_output() as (terminal, _):
        say = Progress(terminal)
        for place, name in enumerate(wanted, 1):
            say.show(name)
            chapter = make_chapter(name, arguments.quick)
            chapters.append(chapter)
            say(f"{place:2}/{len(wanted)} {name:20}{len(chapter.figures):3} figures")
            for figure in chapter.figures:
                if not figure.ok:
                    say(f"off: {figure.what}: {figure.measured:.6g}, expected {figure.expected}")
        title = f"Blender {bpy.app.version_string}, " + ("a short run" if arguments.quick else "a full run")
        page.write(chapters, arguments.output, title)
        terminal.write(f"{page.summary(chapters)}\n{arguments.output / 'index.html'}\n")
    return int(not all(chapter.ok for chapter in chapters))


if __name__ == "__main__":
    sys.exit(registered(main))
