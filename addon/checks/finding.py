"""A fault that a check has found, described for artists; and short lists of findings."""

from dataclasses import dataclass

from ..messages.severity import Severity

_LINES_OF_A_KIND = 3


@dataclass(frozen=True)
class Finding:
    kind: str  # one of KINDS
    severity: Severity
    what: str  # the sentence without its subject and place
    advice: str
    object: str = ""
    mesh: str = ""
    material: str = ""
    light: str = ""
    others: int = 0  # further objects that share it
    faces: int = 0
    place: tuple | None = None  # world coordinates
    weight: float = 0.0  # extent of the fault, for sorting findings of one kind
    key: str = ""  # key of its message if the picture differs from Cycles'

    @property
    def who(self):
        if self.light:
            return f"light '{self.light}'"
        if not self.object:
            return f"material '{self.material}'" if self.material else "scene"
        text = f"object '{self.object}'"
        if self.others:
            text += f" and {self.others} more"
        parts = [f"{what} '{name}'" for what, name in (("mesh", self.mesh), ("material", self.material)) if name]
        return f"{text} ({', '.join(parts)})" if parts else text

    @property
    def text(self):
        where = "" if self.place is None else f" near {told_place(self.place)}"
        return f"{self.who}{where}: {self.what}; {self.advice}"


KINDS = {
    "glass": "Glass",
    "coincident": "Coincident Faces",
    "normals": "Normals",
    "precision": "Precision",
    "closures": "Materials",
    "lights": "Lights",
}


# Key and text for opaque surfaces that overlap in one plane and look alike.
IN_ONE_PLANE = "feature:faces in one plane"
SHADOWED = "Cycles would show them darker, down to black, because each shadows the other there"


def told_place(place):
    return f"({', '.join(f'{value:.6g}' for value in place)})"


def told_number(count, one):
    """Return a count with its noun: "3 faces", "1 face"."""
    return f"{count} {one}" if count == 1 else f"{count} {one}s"


def by_severity(findings):
    """Sort findings by severity, then kind, then weight."""
    order = list(KINDS)
    return sorted(findings, key=lambda f: (-f.severity, order.index(f.kind), -f.weight, f.who))


def shortened(findings):
    """Return (Finding, number of further ones omitted after it): a few of each kind and severity, sorted."""
    kept, left = [], {}
    for finding in by_severity(findings):
        key = finding.kind, finding.severity
        shown = [number for number, other in enumerate(kept) if (other.kind, other.severity) == key]
        if len(shown) < _LINES_OF_A_KIND:
            kept.append(finding)
        else:
            left[shown[-1]] = left.get(shown[-1], 0) + 1 + finding.others
    return [(finding, left.get(number, 0)) for number, finding in enumerate(kept)]


def told(finding, left):
    """Return the line of a finding."""
    if not left:
        return finding.text
    what = "object" if finding.object else "light" if finding.light else "material"
    return f"{finding.text} (and {told_number(left, 'more ' + what)})"


def lines(findings):
    return [told(finding, left) for finding, left in shortened(findings)]
