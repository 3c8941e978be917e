"""All checks of one snapshot."""

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
    """Return a list of Finding, the most severe first.

    thorough: run all checks in full. Otherwise run only the quick checks of a render, and return a hint only if it means a
    difference from Cycles. poll(share) is called between steps with the share done, or None; an exception from it ends the
    check.
    """
    # The core leaves out geometry that is not finite, with a message; here NaN compares as false.
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
