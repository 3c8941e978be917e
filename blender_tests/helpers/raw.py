"""Scenes filled directly through the C interface, for tests of the interface itself."""

import ctypes

import numpy as np

from addon.bindings import abi
from addon.bindings.abi import Status

IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)
# A handle that the library never returns.
FOREIGN = 0xDEADBEEF12345678


def address(array):
    return None if array is None else array.ctypes.data


class Raw:
    """The library's calls with the parts of a small valid scene. Calls return (status, message)."""

    def __init__(self, library):
        self.library = library
        self.kept = []

    def call(self, name, *arguments):
        status = Status(getattr(self.library, name)(*arguments))
        return status, self.library.lancer_last_error().decode("utf-8")

    def keep(self, array):
        self.kept.append(array)
        return array

    def scene(self):
        handle = ctypes.c_uint64(0)
        status, message = self.call("lancer_scene_create", ctypes.byref(handle))
        assert status == Status.OK, message
        return handle.value

    def mesh(self, positions=None, triangles=None, name=b"Cube", **fields):
        if positions is None:
            positions = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]
        if triangles is None:
            triangles = [(0, 1, 2), (1, 3, 2)]
        positions = self.keep(np.ascontiguousarray(positions, np.float32).reshape(-1, 3))
        triangles = self.keep(np.ascontiguousarray(triangles, np.uint32).reshape(-1, 3))
        mesh = abi.Mesh(
            name=name,
            positions=address(positions),
            triangles=address(triangles),
            vertex_count=len(positions),
            triangle_count=len(triangles),
        )
        for field, value in fields.items():
            setattr(mesh, field, value)
        return mesh

    def parameter(self, *value):
        value = tuple(value) * 3 if len(value) == 1 else tuple(value)
        return abi.Parameter((ctypes.c_float * 3)(*value), -1)

    def reference(self, node):
        """Return a parameter that refers to the result of a node."""
        return abi.Parameter((ctypes.c_float * 3)(), node)

    def lobe(self, kind=abi.LobeKind.LAMBERT, principled=None, **fields):
        p = self.parameter
        values = {"weight": 1.0, "color": 0.5, "roughness": 0.1, "ior": 1.5, "shininess": 10.0, "edge": 1.0}
        values |= {
            "anisotropy": 0.0,
            "rotation": 0.0,
            "normal": 0.0,
            "tangent": 0.0,
            "roughness_across": 0.0,
            "offset": 0.0,
            "film_thickness": 0.0,
            "film_ior": 1.33,
            **fields,
        }
        lobe = abi.Lobe(kind=kind, **{name: p(value) for name, value in values.items()})
        if principled is not None:
            lobe.principled = ctypes.pointer(self.keep(principled))
        return lobe

    def principled(self, **fields):
        """Return a Principled with all inputs 0 except the indices of refraction and the given fields."""
        names = [name for name, kind in abi.Principled._fields_ if kind is abi.Parameter]
        values = dict.fromkeys(names, 0.0) | {"ior": 1.5, "coat_ior": 1.5, **fields}
        return abi.Principled(rules=abi.Rules.BLENDER_45, **{name: self.parameter(value) for name, value in values.items()})

    def node(self, kind=abi.NodeKind.COORDINATE, inputs=(), **fields):
        """inputs: parameters; missing ones are 0."""
        inputs = [*inputs, *(self.parameter(0.0) for _ in range(5 - len(inputs)))]
        return abi.Node(kind=kind, inputs=(abi.Parameter * 5)(*inputs), matrix=(ctypes.c_float * 12)(*IDENTITY), **fields)

    def nodes(self, *nodes):
        """Return the fields of a material or world with these nodes."""
        return {"nodes": self.keep((abi.Node * max(len(nodes), 1))(*nodes)), "node_count": len(nodes)}

    def image(self, width=2, height=2, channels=4, name=b"Picture", **fields):
        texels = self.keep(np.zeros(width * height * channels, np.float32))
        image = abi.Image(
            name=name,
            texels=address(texels),
            width=width,
            height=height,
            channels=channels,
            matrix=(ctypes.c_float * 9)(1, 0, 0, 0, 1, 0, 0, 0, 1),
        )
        for field, value in fields.items():
            setattr(image, field, value)
        return image

    def attribute(self, values, name=b"Map", domain=abi.Domain.VERTEX):
        values = self.keep(np.ascontiguousarray(values, np.float32))
        return abi.Attribute(name=name, values=address(values), domain=domain, channels=values.shape[1])

    def attributes(self, *attributes):
        """Return the fields of a mesh with these attributes."""
        array = self.keep((abi.Attribute * max(len(attributes), 1))(*attributes))
        return {"attributes": array, "attribute_count": len(attributes)}

    def world(self, radiance=1.0, **fields):
        world = abi.World(radiance=self.parameter(radiance))
        for field, value in fields.items():
            setattr(world, field, value)
        return world

    def material(self, lobes=None, name=b"Paint", **fields):
        lobes = [self.lobe()] if lobes is None else lobes
        array = self.keep((abi.Lobe * max(len(lobes), 1))(*lobes))
        p = self.parameter
        parameters = ("emission", "transmittance", "holdout", "ambient", "displacement", "normal")
        values = {parameter: p(0.0) for parameter in parameters}
        material = abi.Material(name=name, lobes=array, lobe_count=len(lobes), **values)
        for field, value in fields.items():
            setattr(material, field, value)
        return material

    def light(self, kind=abi.LightKind.POINT, name=b"Lamp", **fields):
        light = abi.Light(
            name=name,
            matrix=(ctypes.c_double * 12)(*IDENTITY),
            kind=kind,
            emission=(1, 1, 1),
            spot_angle=1.0,
            size=(1, 1),
            spread=3.1415927,
            falloff_radius=1.0,
            ambient_color=(1, 1, 1),
            diffuse_color=(1, 1, 1),
            specular_color=(1, 1, 1),
        )
        for field, value in fields.items():
            setattr(light, field, value)
        return light

    def instance(self, matrix=IDENTITY, kind=abi.InstanceKind.MESH, **fields):
        instance = abi.Instance(matrix=(ctypes.c_double * 12)(*matrix), kind=kind, slot_count=1)
        for field, value in fields.items():
            setattr(instance, field, value)
        return instance

    def add_instances(self, scene, instances, slots=(0,), names=b"Thing\0"):
        array = (abi.Instance * max(len(instances), 1))(*instances)
        slots = np.asarray(slots, np.uint32)
        return self.call(
            "lancer_scene_add_instances",
            scene,
            len(instances),
            ctypes.byref(array),
            len(slots),
            address(slots),
            names,
            len(names),
        )

    def camera(self, **fields):
        camera = abi.Camera(
            matrix=(ctypes.c_double * 12)(1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 2),
            width=16,
            height=16,
            region_width=16,
            region_height=16,
            window=(-0.5, 0.5, -0.5, 0.5),
            clip_start=0.1,
            clip_end=100.0,
            aperture_ratio=1.0,
        )
        for field, value in fields.items():
            setattr(camera, field, value)
        return camera

    def settings(self, **fields):
        settings = abi.Settings(
            samples=4, max_bounces=2, filter_width=1.0, passes=1, threads=1, transparent_bounces=8, transparent_shadows=8
        )
        for field, value in fields.items():
            setattr(settings, field, value)
        return settings

    def filled(self):
        """Return a scene with one mesh, one material, one light and one instance, not committed."""
        scene = self.scene()
        for name, piece in (
            ("lancer_scene_add_mesh", self.mesh()),
            ("lancer_scene_add_material", self.material()),
            ("lancer_scene_add_light", self.light(matrix=(ctypes.c_double * 12)(1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 1))),
        ):
            status, message = self.call(name, scene, ctypes.byref(piece))
            assert status == Status.OK, message
        status, message = self.add_instances(scene, [self.instance()])
        assert status == Status.OK, message
        return scene

    def commit(self, scene, accelerator=abi.Accelerator.BVH):
        status, message = self.call("lancer_scene_commit", scene, accelerator, 1)
        assert status == Status.OK, message
        return self.wait("lancer_scene_wait", scene)

    def wait(self, name, *arguments):
        """Wait in steps until the call has ended."""
        status = Status.RUNNING
        while status == Status.RUNNING:
            extra = (None,) if name == "lancer_session_wait" else ()
            status, message = self.call(name, *arguments, 100, *extra)
        return status, message

    def create_session(self, scene, camera=None, settings=None):
        handle = ctypes.c_uint64(0)
        camera, settings = camera or self.camera(), settings or self.settings()
        result = self.call("lancer_session_create", scene, ctypes.byref(camera), ctypes.byref(settings), ctypes.byref(handle))
        return result + (handle.value,)

    def session(self, scene, camera=None, settings=None):
        status, message, handle = self.create_session(scene, camera, settings)
        assert status == Status.OK, message
        return handle

    def committed(self):
        scene = self.filled()
        status, message = self.commit(scene)
        assert status == Status.OK, message
        return scene

    def messages(self, scene):
        needed = ctypes.c_size_t(0)
        status, message = self.call("lancer_scene_messages", scene, None, 0, ctypes.byref(needed))
        assert status == Status.OK, message
        text = ctypes.create_string_buffer(needed.value)
        status, message = self.call("lancer_scene_messages", scene, text, needed.value, None)
        assert status == Status.OK, message
        return text.value.decode("utf-8")

    def read(self, session, which, count, out=None):
        out = np.zeros(count, np.float32) if out is None else out
        status, message = self.call("lancer_session_read", session, which, address(out), count)
        return status, message, out


def refused(result, *words, status=Status.ERROR_ARGUMENT):
    """Assert that a call failed with that status and a message that contains these words."""
    assert result[0] == status, f"{result[0].name}: {result[1]}"
    missing = [word for word in words if word not in result[1]]
    assert result[1] and not missing, f"{missing} not in {result[1]!r}"


def add(raw, scene, kind, piece):
    return raw.call(f"lancer_scene_add_{kind}", scene, ctypes.byref(piece))
