"""Flat parts of two objects in one plane: where they overlap only one of them is rendered, possibly the wrong one.

If they look alike, the choice does not matter in Lancer. But in Cycles a ray that leaves one may hit the other, which darkens
both.
"""

import numpy as np

from ..bindings.enums import CameraKind, InstanceKind
from .edges import corner_keys, edge_faults
from .finding import IN_ONE_PLANE, SHADOWED, Finding, Severity, told_number
from .framing import LEAST_SHARE, share_of_plane
from .overlap import overlapping_triangles
from .planes import gather, in_one_plane, pairs_of

_MOST_FACETS = 2_000_000, 20_000  # thorough, quick
_MOST_PAIRS = 64_000_000, 200_000
_MOST_ASKED = 1024, 64  # pairs whose triangles are compared
_MOST_ALIKE = 65536, 128  # pairs that look alike, usually the most, for which the camera's view is tested
_MOST_TRIANGLES = 8_000_000


def flat_parts(subject, duplicates=frozenset()):
    """Return (facets, world) of planes.gather. duplicates: rows of exact copies, which have their own check."""
    return gather(subject, duplicates, _MOST_FACETS[not subject.thorough])


def check_coincident(subject, facets, world):
    """Yield findings of overlapping flat parts in one plane. facets, world: of flat_parts."""
    quick = not subject.thorough
    if world is None or len(world) < 2:
        return
    i, j = pairs_of(subject, world, _MOST_PAIRS[quick])
    # At the border of two cells of directions a part can be paired with itself.
    keep = in_one_plane(world, i, j) & (i != j)
    i, j = i[keep], j[keep]
    hurts = _Hurts(subject, facets, world)
    # Test the largest first, and each pair of objects once, however many instances they have.
    area = np.sort(np.minimum(world.high[i], world.high[j]) - np.maximum(world.low[i], world.low[j]), axis=1)[:, 1:].prod(
        axis=1
    )
    asked, alike, told = 0, 0, set()
    for number in np.argsort(-area, kind="stable").tolist():
        one, other = int(i[number]), int(j[number])
        both = tuple(sorted(subject.name(int(world.rows[part])) for part in (one, other)))
        if not hurts.may(one, other):
            continue
        alike += hurts.alike(one, other)
        if hurts.alike(one, other) and alike > _MOST_ALIKE[quick]:
            continue
        words = hurts.words(one, other)
        if words is None or (both, words[0]) in told:
            continue
        subject.poll()
        asked += 1
        if asked > _MOST_ASKED[quick]:
            return
        place, count = _meeting(subject, facets, world, one, other)
        if count:
            told.add((both, words[0]))
            yield _finding(subject, world, one, other, words, place, count, float(area[number]))


def is_plain(traits):
    """Whether a material scatters light but neither refracts, transmits nor emits it."""
    return traits.scatters and not (traits.refracts or traits.passes or traits.emits)


class _Hurts:
    """The effect on the picture of two parts in one plane."""

    def __init__(self, subject, facets, world):
        self.subject = subject
        self.facets = facets
        self.world = world
        self.camera = subject.snapshot.camera
        self._sheets = {}

    def alike(self, one, other):
        """Whether two parts have plain materials that look the same."""
        first, second = int(self.world.materials[one]), int(self.world.materials[other])
        return is_plain(self.subject.traits[first]) and self.subject.alike(first, second)

    def may(self, one, other):
        """Whether the pair can hurt the picture, judged by materials and visibility alone."""
        world, traits = self.world, self.subject.traits
        first, second = int(world.materials[one]), int(world.materials[other])
        if first < 0 or second < 0:
            return False
        row = int(world.rows[one])
        if row == world.rows[other]:
            doubled = int(self.subject.instances.meshes[row]) in self.subject.doubled
            if doubled or (self.subject.alike(first, second) and not self.alike(one, other)):
                return False
        if traits[first].refracts or traits[second].refracts:
            return True
        if not all(self.subject.seen_by_camera(int(world.rows[part])) for part in (one, other)):
            return False
        return traits[first].scatters or traits[first].emits or traits[first].passes or not self.subject.alike(first, second)

    def words(self, one, other):
        """Return (Severity, what, advice); None if the pair does not show in the camera's view."""
        world, traits = self.world, self.subject.traits
        first, second = int(world.materials[one]), int(world.materials[other])
        if self._rests(one, other) or self._rests(other, one):
            return (
                Severity.HINT,
                "touch exactly where one is glass: it stands on the other as if glued, without air between them",
                "move it away a little if there should be air",
            )
        if traits[first].refracts or traits[second].refracts:
            return (
                Severity.WRONG,
                "touch exactly where one is glass: only one of the two surfaces is rendered, an opaque one before glass",
                "move one of them a little, or let them overlap",
            )
        if not self._fight(one, other):
            return None
        if self.alike(one, other):
            if self._share(one, other) < LEAST_SHARE:
                return None
            return (
                Severity.DIFFERENT,
                f"lie in the same plane and look alike: {SHADOWED}",
                "delete one of them, or move it a little",
            )
        if self.subject.alike(first, second):
            return (
                Severity.WRONG,
                "lie in the same plane, and their light counts twice",
                "delete one of them, or move it a little",
            )
        return Severity.WRONG, "lie in the same plane, and only one of them is seen", "move one of them a little"

    def _rests(self, glass, ground):
        """Whether glass rests on an opaque surface, which rightly replaces the glass surface: light in the glass ends there."""
        traits, normals = self.subject.traits, self.world.normals
        above, below = (traits[int(self.world.materials[part])] for part in (glass, ground))
        if not above.refracts or below.refracts or below.passes:
            return False
        return float(normals[glass] @ normals[ground]) < 0.0 or self._is_sheet(ground)

    def _fight(self, one, other):
        """Whether both parts are visible from the camera's side: faces of closed bodies by their outside, sheets by either."""
        normal = self.world.normals[one]
        matrix = self.camera.matrix
        if self.camera.kind == CameraKind.ORTHOGRAPHIC:
            side = float(normal @ matrix[:, 2])
        else:
            side = float(normal @ (matrix[:, 3] - self.world.points[one]))
        toward = [side * float(normal @ self.world.normals[part]) > 0.0 or self._is_sheet(part) for part in (one, other)]
        return side != 0.0 and all(toward)

    def _share(self, one, other):
        """Return the share of the picture that shows the intersection of both parts' boxes."""
        world = self.world
        low, high = np.maximum(world.low[one], world.low[other]), np.minimum(world.high[one], world.high[other])
        return share_of_plane(self.camera, world.points[one], world.normals[one], low, high)

    def _is_sheet(self, part):
        """Whether a part has open edges, so that its back is visible too."""
        row, number = int(self.world.rows[part]), int(self.world.parts[part])
        kind, mesh = InstanceKind(int(self.subject.kinds[row])), int(self.subject.instances.meshes[row])
        if kind != InstanceKind.MESH:
            return kind == InstanceKind.PLANE
        key = mesh, number
        if key not in self._sheets:
            faults = self.subject.cached("faults", mesh, lambda: edge_faults(corner_keys(self.subject.meshes[mesh])))
            self._sheets[key] = bool(np.isin(self.facets[kind, mesh].faces[number], faults.open).any())
        return self._sheets[key]


def _meeting(subject, facets, world, one, other):
    """Return (a point where two parts overlap, number of overlapping triangles of the first); (None, 0) if they only touch."""
    sets = [corners_of(subject, facets, world, part, world.points[one]) for part in (one, other)]
    axes = np.delete(np.arange(3), np.argmax(np.abs(world.normals[one])))
    endless = [not np.isfinite(corners).all() for corners in sets]
    if all(endless):
        return tuple(world.points[one].tolist()), 1
    if any(endless):
        corners = sets[0] if endless[1] else sets[1]
        return tuple((corners[0].mean(axis=0) + world.points[one]).tolist()), len(corners)
    i, _ = overlapping_triangles(*(corners[:, :, axes] for corners in sets), _MOST_TRIANGLES)
    if len(i) == 0:
        return None, 0
    # The centre of the boxes' intersection is covered by both parts, or close to such a point.
    low, high = np.maximum(world.low[one], world.low[other]), np.minimum(world.high[one], world.high[other])
    middle = 0.5 * (low + high) - world.points[one]
    centers = sets[0][i].mean(axis=1)
    nearest = np.argmin(np.linalg.norm(centers - middle, axis=1))
    return tuple((centers[nearest] + world.points[one]).tolist()), len(np.unique(i))


def corners_of(subject, facets, world, part, origin):
    """Return the corners of a part's triangles, (triangles, 3, 3), in world space relative to origin."""
    row, number = int(world.rows[part]), int(world.parts[part])
    kind = InstanceKind(int(subject.kinds[row]))
    matrix = subject.instances.matrices[row]
    if kind == InstanceKind.MESH:
        mesh = subject.meshes[int(subject.instances.meshes[row])]
        faces = facets[kind, int(subject.instances.meshes[row])].faces[number]
        corners = mesh.positions.astype(float)[mesh.triangles[faces]]
    else:
        corners = facets[kind, 0].faces[number]
        if kind == InstanceKind.PLANE:
            return corners
    return corners @ matrix[:, :3].T + (matrix[:, 3] - origin)


def _finding(subject, world, one, other, words, place, count, weight):
    first, second = int(world.rows[one]), int(world.rows[other])
    severity, what, advice = words
    partner = f"object '{subject.name(second)}'" if first != second else "other faces of it"
    material = subject.material_name(int(world.materials[one]))
    return Finding(
        "coincident",
        severity,
        f"{told_number(count, 'face')} and {partner} {what}",
        advice,
        object=subject.name(first),
        material=material,
        faces=count,
        place=place,
        weight=weight,
        key=IN_ONE_PLANE if severity > Severity.WASTE else "",
    )
