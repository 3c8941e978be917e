"""The snapshot under examination: instances of each mesh, materials of faces, and limits of the quick check."""

import numpy as np

from ..bindings.enums import InstanceKind, Ray
from .traits import look_alike, traits_of

# Limits of F12's quick check, which takes a small part of the time of export and accelerator even for small scenes.
_QUICK_MESH = 4096
_QUICK_ALL = 16384
_QUICK_SAMPLE = 64
_QUICK_MESHES = 128
_QUICK_PARTS = 8192


class Subject:
    """thorough: check the whole scene; else whole small meshes, and samples of large ones.

    poll is called between steps with the share done; an exception from it ends the check.
    """

    def __init__(self, snapshot, thorough=True, poll=None):
        self.snapshot = snapshot
        self.meshes = snapshot.meshes
        self.instances = snapshot.instances
        self.thorough = thorough
        self.traits = [traits_of(material) for material in snapshot.materials]
        self.kinds = self.instances.kinds
        self.doubled = set()  # meshes with reported double faces
        self.parts_left = _QUICK_PARTS  # triangles left whose small flat parts a quick check includes
        self._poll = poll
        self._seen = {}
        self._looks = self._group()
        self.scales, self.volumes = _measure(self.instances.matrices)

    def poll(self, share=None):
        if self._poll is not None:
            self._poll(share)

    def _group(self):
        """Return {mesh: first row of each combination of slots and shading}; store the rows of each mesh."""
        table = self.instances
        rows = np.flatnonzero(table.kinds == InstanceKind.MESH)
        self._rows = rows[np.argsort(table.meshes[rows], kind="stable")]
        self._ends = np.cumsum(np.bincount(table.meshes[rows], minlength=len(self.meshes)))
        starts = table.first_slots[rows].astype(np.uint64) * np.uint64(4) + table.shadings[rows]
        keys = table.meshes[rows].astype(np.uint64) * np.uint64(4 * (len(table.slots) + 1)) + starts
        _, first = np.unique(keys, return_index=True)
        looks = {}
        for row in rows[first].tolist():
            looks.setdefault(int(table.meshes[row]), []).append(row)
        return looks

    def shown_meshes(self, whole=True, where=None):
        """Yield (number, mesh, first row of each look) of instanced meshes with faces; a quick check takes an even sample.

        where(traits): only meshes with such a material. whole: the caller looks at all faces, so that a quick check skips large
        meshes.
        """
        numbers = sorted(self._looks)
        if where is not None:
            wanted = {number for number, traits in enumerate(self.traits) if where(traits)}
            if not wanted:
                return
            numbers = [n for n in numbers if any(not wanted.isdisjoint(self.materials_of(row)) for row in self._looks[n])]
        if not self.thorough:
            numbers = numbers[:: -(-len(numbers) // _QUICK_MESHES) or 1]
        left = _QUICK_ALL
        for number in numbers:
            mesh = self.meshes[number]
            count = len(mesh.triangles)
            if count == 0:
                continue
            if whole and not self.thorough:
                if count > min(left, _QUICK_MESH):
                    continue
                left -= count
            self.poll()
            yield number, mesh, self._looks[number]

    def sample(self, mesh):
        """Return (slice of triangles to check, their number): an even sample in a quick check, else all."""
        count = len(mesh.triangles)
        if self.thorough:
            return slice(None), count
        stride = max(1, count // max(_QUICK_SAMPLE, _QUICK_ALL // min(len(self._looks), _QUICK_MESHES)))
        return slice(None, None, stride), len(range(0, count, stride))

    def cached(self, what, number, make):
        """Return make(), computed once for each (what, number)."""
        key = what, number
        if key not in self._seen:
            self._seen[key] = make()
        return self._seen[key]

    def name(self, row):
        return self.instances.names[self.instances.name_indices[row]]

    def rows_of(self, number):
        """Return all rows of a mesh."""
        return self._rows[self._ends[number - 1] if number else 0 : self._ends[number]]

    def others(self, number):
        """Return the number of rows of a mesh besides the first."""
        return len(self.rows_of(number)) - 1

    def slots(self, row):
        first = int(self.instances.first_slots[row])
        return self.instances.slots[first : first + int(self.instances.slot_counts[row])]

    def materials_of(self, row):
        """Return the numbers of an instance's materials."""
        return self.slots(row).tolist()

    def material(self, row, slot):
        """Return the number of the material in a slot, the last one for a slot beyond; -1 without materials."""
        slots = self.slots(row)
        return int(slots[min(slot, len(slots) - 1)]) if len(slots) else -1

    def faces_with(self, mesh, row, wanted):
        """Return a mask of the triangles whose material's traits satisfy wanted(); True or False if all or none do."""
        slots = self.slots(row)
        if len(slots) == 0:
            return False
        good = np.array([wanted(self.traits[int(slot)]) for slot in slots])
        if good.all() or not good.any():
            return bool(good[0])
        if mesh.material_slots is None:
            return bool(good[0])
        return good[np.minimum(mesh.material_slots, len(slots) - 1)]

    def alike(self, first, second):
        """Whether two materials, by number, look the same."""
        materials = self.snapshot.materials
        return first == second or self.cached("alike", (first, second), lambda: look_alike(materials[first], materials[second]))

    def material_name(self, number):
        return self.snapshot.materials[number].name if 0 <= number < len(self.snapshot.materials) else ""

    def world(self, row, points):
        matrix = self.instances.matrices[row]
        return np.asarray(points, float) @ matrix[:, :3].T + matrix[:, 3]

    def place(self, row, point):
        return tuple(self.world(row, point).tolist())

    def seen_by_camera(self, row):
        return not int(self.instances.hidden_from[row]) & Ray.CAMERA


def _measure(matrices):
    """Return (lengths of the columns, determinants) of 3 x 4 matrices, written out for speed."""
    rows = [[matrices[:, row, column] for column in range(3)] for row in range(3)]
    scales = np.stack([np.sqrt(sum(row[column] ** 2 for row in rows)) for column in range(3)], axis=1)
    (a, b, c), (d, e, f), (g, h, i) = rows
    return scales, a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def step(values):
    """Return the distance between a single-precision number of that magnitude and the next."""
    values = np.abs(np.asarray(values, float))
    return np.spacing(np.maximum(values, np.finfo(np.float32).tiny).astype(np.float32)).astype(float)
