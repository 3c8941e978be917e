"""The options that measuring programs have in common, and the choice of what they measure."""

import argparse
from fnmatch import fnmatchcase
from pathlib import Path

from .places import BUILD, ROOT, TABLES


def parser(text, *, quick, only="", threads=0, readme=False, output=""):
    """A parser with --quick and, where something is given for them, --only, --threads, --readme, --output in build/."""
    made = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--quick", action="store_true", help=quick)
    if only:
        made.add_argument("--only", default="", help=only)
    if threads:
        made.add_argument("--threads", type=int, default=threads)
    if readme:
        made.add_argument("--readme", action="store_true", help=f"put the figures into {TABLES.relative_to(ROOT)}")
    if output:
        made.add_argument("--output", type=Path, default=BUILD / output)
    return made


def wanted(only, *names):
    """Whether one of the names matches one of the comma-separated patterns; without any, all do. Capitals are small letters."""
    patterns = [pattern.strip().lower() for pattern in only.split(",") if pattern.strip()]
    return not patterns or any(fnmatchcase(name.lower(), pattern) for name in names for pattern in patterns)
