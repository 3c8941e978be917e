"""Exact duplicates in the same place: whole objects, and faces of a mesh."""

import numpy as np

from ..bindings.enums import InstanceKind
from .edges import corner_keys, mixed
from .finding import IN_ONE_PLANE, SHADOWED, Finding, Severity, told_number
from .framing import LEAST_SHARE, share_of_triangles


def duplicate_rows(subject):
    """Return (row, earlier equal row) of instances with equal geometry, transform and ray visibility."""
    table = subject.instances
    if len(table) < 2:
        return []
    bits = (table.matrices + 0.0).reshape(-1, 12).view(np.uint64)
    key = mixed(table.kinds.astype(np.uint64) * np.uint64(256) + table.hidden_from)
    for column in range(12):
        key = mixed(key + bits[:, column])
    order = np.argsort(key, kind="stable")
    again = np.flatnonzero(key[order[1:]] == key[order[:-1]])
    if len(again) == 0:
        return []
    # Among instances with equal keys look for equal meshes.
    found, seen = [], {}
    for row in np.unique(np.concatenate((order[again], order[again + 1]))).tolist():
        earlier = seen.setdefault((int(key[row]), _glance(subject, row)), [])
        first = next((other for other in earlier if _same_thing(subject, row, other)), None)
        if first is None:
            earlier.append(row)
        else:
            found.append((row, first))
    return found


def _glance(subject, row):
    """Return a cheap key of a mesh's content: objects that were never moved all have the same transform."""
    if not _is_mesh(subject, row):
        return None
    mesh = subject.meshes[int(subject.instances.meshes[row])]
    count = len(mesh.positions)
    return count, len(mesh.triangles), mesh.positions[:: max(1, count // 4)].tobytes()


def _same_thing(subject, row, other):
    one, two = int(subject.instances.meshes[row]), int(subject.instances.meshes[other])
    if not _is_mesh(subject, row) or one == two:
        return True
    first, second = subject.meshes[one], subject.meshes[two]
    return np.array_equal(first.positions, second.positions) and np.array_equal(first.triangles, second.triangles)


def check_duplicates(subject, rows):
    """Yield a finding for each object with exact duplicates. rows: of duplicate_rows."""
    told = set()
    for row, first in rows:
        if first in told:
            continue
        told.add(first)
        ours, theirs = subject.materials_of(row), subject.materials_of(first)
        traits = [subject.traits[number] for number in ours + theirs]
        same = len(ours) == len(theirs) and all(map(subject.alike, ours, theirs))
        harmless = same and not any(trait.passes or trait.emits for trait in traits)
        darker = harmless and subject.seen_by_camera(row) and all(trait.scatters for trait in traits)
        copies = sum(1 for _, other in rows if other == first)
        name, other = subject.name(row), subject.name(first)
        what = f"stands exactly where object '{other}' does, with the same faces"
        yield Finding(
            "coincident",
            Severity.DIFFERENT if darker else Severity.WASTE if harmless else Severity.WRONG,
            (what if copies == 1 else f"{what}, like {copies - 1} more") + (f": {SHADOWED}" if darker else ""),
            "delete the copy",
            object=name,
            faces=_face_count(subject, row),
            place=subject.place(row, _middle(subject, row)),
            weight=float(_face_count(subject, row)),
            key=IN_ONE_PLANE if darker else "",
        )


def _face_count(subject, row):
    return len(subject.meshes[int(subject.instances.meshes[row])].triangles) if _is_mesh(subject, row) else 0


def _middle(subject, row):
    if not _is_mesh(subject, row):
        return np.zeros(3)
    mesh = subject.meshes[int(subject.instances.meshes[row])]
    return mesh.positions[mesh.triangles[0]].astype(float).mean(axis=0) if len(mesh.triangles) else np.zeros(3)


def _is_mesh(subject, row):
    return subject.kinds[row] == InstanceKind.MESH


def check_double_faces(subject):
    """Yield findings of triangles with the same three corners as another triangle of their mesh."""
    for number, mesh, looks in subject.shown_meshes():
        keys = corner_keys(mesh)
        # A sum does not depend on the order of corners.
        whole = mixed(keys[:, 0] + keys[:, 1] + keys[:, 2])
        order = np.argsort(whole)
        again = np.flatnonzero(whole[order[1:]] == whole[order[:-1]])
        if len(again) == 0:
            continue
        one, other = order[again], order[again + 1]
        keys_one, keys_other = np.sort(keys[one], axis=1), np.sort(keys[other], axis=1)
        real = (keys_one == keys_other).all(axis=1) & (np.diff(keys_one.view(np.int64), axis=1) != 0).all(axis=1)
        one, other = one[real], other[real]
        if len(one) == 0:
            continue
        row = looks[0]
        opposite = ~_same_turn(keys[one], keys[other])
        hurts = _hurts(subject, mesh, row, one, other, opposite)
        # Without harmful pairs report all of them; game meshes often have a second face for the back of each face.
        shown = np.flatnonzero(hurts) if hurts.any() else np.arange(len(one))
        share = len(shown) / len(mesh.triangles)
        subject.doubled.add(number)
        corners = mesh.positions[mesh.triangles[one[shown]]].astype(float)
        places = subject.world(row, corners.reshape(-1, 3)).reshape(-1, 3, 3)
        darker = subject.seen_by_camera(row) and any(subject.traits[number].scatters for number in subject.materials_of(row))
        felt = darker and share_of_triangles(subject.snapshot.camera, places) >= LEAST_SHARE
        severity = Severity.WRONG if hurts.any() else Severity.DIFFERENT if felt else Severity.HINT
        what = f"{told_number(len(shown), 'face')} lie exactly on other faces of the mesh"
        yield Finding(
            "coincident",
            severity,
            f"{what}: {SHADOWED}" if darker else what,
            "in Edit Mode, Mesh > Merge > By Distance, then delete the remaining double faces",
            object=subject.name(row),
            mesh=mesh.name,
            others=subject.others(number),
            faces=len(shown),
            place=tuple(places[0].mean(axis=0).tolist()),
            weight=share,
            key=IN_ONE_PLANE if severity > Severity.WASTE or darker else "",
        )


def _same_turn(one, other):
    """Return (n,) bool: whether two triangles have the same orientation, whichever corner comes first."""
    return np.stack([(one == np.roll(other, turn, axis=1)).all(axis=1) for turn in range(3)]).any(axis=0)


def _hurts(subject, mesh, row, one, other, opposite):
    """Return (n,) bool, the visible pairs: materials differ, transmit or emit light, or refract with opposite orientation."""
    passes = subject.faces_with(mesh, row, lambda traits: traits.passes or traits.emits)
    clear = subject.faces_with(mesh, row, lambda traits: traits.refracts)
    count = len(mesh.triangles)
    hurts = np.broadcast_to(passes, count)[one] | (np.broadcast_to(clear, count)[one] & opposite)
    if mesh.material_slots is not None:
        last = max(0, len(subject.slots(row)) - 1)
        pairs = np.minimum(mesh.material_slots, last)[np.stack((one, other))].T
        kinds, which = np.unique(pairs, axis=0, return_inverse=True)
        differ = [not subject.alike(subject.material(row, a), subject.material(row, b)) for a, b in kinds.tolist()]
        hurts = hurts | np.array(differ)[which.reshape(-1)]
    return hurts
