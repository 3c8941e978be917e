"""All checks over one snapshot."""

import numpy as np

from .closures import check_closures
from .coincident import check_coincident, flat_parts
from .duplicates import check_double_faces, check_duplicates, duplicate_rows
from .finding import by_severity
from .glass import check_glass
from .laid_over import check_laid_over
from .lamps_in_faces import check_lamps_in_faces
from .lights import check_lights
from .normals import check_normals
from .precision import check_precision
from .round_faces import check_round_faces
from .subject import Subject


def check_snapshot(snapshot, thorough=True, poll=None):
    """A list of Finding, what hurts most first.

    thorough: all of it. Else what costs next to nothing beside a render, and of hints those by which Cycles' picture differs:
    F12 does so by itself. poll(share) is called on the way, with the share that is done or None; what it raises ends the check.
    """
    # What is not finite is left out by the core, which tells of it; here it compares as false.
    with np.errstate(all="ignore"):
        found = _all_findings(Subject(snapshot, thorough, poll))
    return by_severity(finding for finding in found if thorough or finding.severity or finding.key)


def _all_findings(subject):
    duplicates = duplicate_rows(subject)
    steps = (
        check_closures(subject),
        check_lights(subject),
        check_precision(subject),
        check_glass(subject),
        check_normals(subject),
        check_round_faces(subject),
        check_duplicates(subject, duplicates),
        check_double_faces(subject),
        check_laid_over(subject),
        _check_planes(subject, frozenset(row for row, _ in duplicates)),
    )
    found = []
    for number, findings in enumerate(steps):
        subject.poll(number / len(steps))
        found.extend(findings)
    return found


def _check_planes(subject, duplicates):
    facets, world = flat_parts(subject, duplicates)
    yield from check_coincident(subject, facets, world)
    yield from check_lamps_in_faces(subject, facets, world)
