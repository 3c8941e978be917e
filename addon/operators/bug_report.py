"""Save Bug Report: the data for reproducing a faulty render, in one .zip."""

import os
import platform

import bpy
from bpy_extras.io_utils import ExportHelper

from .. import engine
from ..bindings import bug_report
from ..bindings.abi import LancerError, load_library
from ..engine import render_export
from ..engine.render_engine import LancerRenderEngine
from ..host.registering import add_all
from ..messages.messages import Messages
from ..messages.severity import Severity

_HOLDS = "It contains the geometry and the images of the scene"


def _settings(owner):
    """Return the numbers, switches and enums that are set; no strings, which may be paths."""
    kinds = {"BOOLEAN", "INT", "FLOAT", "ENUM"}
    names = [field.identifier for field in owner.bl_rna.properties if field.type in kinds]
    values = {name: getattr(owner, name) for name in names if owner.is_property_set(name)}
    return {name: value if isinstance(value, (int, float, str)) else list(value) for name, value in sorted(values.items())}


def _processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.partition(":")[2].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor()


def versions():
    """Return the versions of Lancer, Blender and the system."""
    import numpy

    from .. import VERSION

    try:
        library = load_library().lancer_version().decode()
    except LancerError as error:
        library = str(error)
    return {
        "Lancer": VERSION,
        "library": library,
        "Blender": f"{bpy.app.version_string} {bpy.app.build_hash.decode()}",
        "Python": platform.python_version(),
        "numpy": numpy.__version__,
        "system": platform.platform(),
        "processor": _processor(),
        "processors": os.cpu_count(),
    }


def _plain(messages):
    return [message._asdict() | {"severity": message.severity.name} for message in messages.told()]


def facts(scene, exported):
    """Return the report's facts as a dict for JSON. exported: the Messages of the export for this report."""
    told = engine.last_messages.get(scene.name)
    return {
        "versions": versions(),
        "settings": {
            "lancer": _settings(scene.lancer),
            "render": _settings(scene.render),
            "cycles": _settings(scene.cycles) if hasattr(scene, "cycles") else {},
            "view": _settings(scene.view_settings),
        },
        "messages": [] if told is None else _plain(told),
        "exported": _plain(exported),
        "statistics": engine.last_statistics.get(scene.name),
    }


def _exported(context):
    """Return (snapshot, Messages); if the export fails, (None, Messages with the error), which is worth a report too."""
    try:
        export = render_export.export(context)
        return export.snapshot, export.messages
    except LancerError as error:
        return None, Messages([str(error)], Severity.FAILED)
    except Exception as error:
        return None, Messages([f"the export failed ({type(error).__name__}: {error})"], Severity.FAILED)


def _size(size):
    return f"{size / 2**20:.1f} MB" if size >= 2**20 / 10 else f"{size / 2**10:.1f} kB"


class LANCER_OT_save_bug_report(bpy.types.Operator, ExportHelper):
    """Save the exported scene, its settings, messages and statistics in one file, from which a fault can be reproduced"""

    bl_idname = "lancer.save_bug_report"
    bl_label = "Save Bug Report"
    filename_ext = ".zip"

    filter_glob: bpy.props.StringProperty(default="*.zip", options={"HIDDEN"})
    use_scene: bpy.props.BoolProperty(
        name="Geometry and Images",
        description="Without them the report has only settings, versions, messages and statistics, and cannot be rendered",
        default=True,
    )

    @classmethod
    def poll(cls, context):
        if bpy.app.is_job_running("RENDER"):
            cls.poll_message_set("A render is running")
            return False
        return context.scene is not None

    def invoke(self, context, event):
        if not self.filepath:
            stem = os.path.splitext(bpy.data.filepath)[0] or "untitled"
            self.filepath = f"{stem}-lancer-report{self.filename_ext}"
        return super().invoke(context, event)

    def draw(self, context):
        column = self.layout.column()
        column.prop(self, "use_scene")
        if self.use_scene:
            # The side of a file selector is narrow.
            for line in ("It contains the geometry", "and images of the scene"):
                column.label(text=line)
            numbers = engine.last_statistics.get(context.scene.name)
            if numbers is not None:
                size = _size(numbers["geometry_bytes"] + numbers["texture_bytes"])
                column.label(text=f"About {size} uncompressed")

    def execute(self, context):
        manager, scene = context.window_manager, context.scene
        path = bpy.path.abspath(self.filepath)
        manager.progress_begin(0.0, 1.0)
        try:
            snapshot, messages = _exported(context) if self.use_scene else (None, Messages())
            bug_report.save(path, facts(scene, messages), snapshot, manager.progress_update)
        except OSError as error:
            self.report({"ERROR"}, f"Lancer: the report could not be written: {error}")
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        size = _size(os.path.getsize(path))
        if self.use_scene and snapshot is None:
            self.report({"WARNING"}, f"Lancer: saved a report of {size} without the scene: {messages.lines()[0]}")
        else:
            told = f". {_HOLDS}: do not publish it if these are secret" if self.use_scene else ", without the scene"
            self.report({"INFO"}, f"Lancer: saved a report of {size}{told}")
        return {"FINISHED"}


class LANCER_RENDER_PT_bug_report(bpy.types.Panel):
    bl_label = "Bug Report"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    # Below the messages of the last render.
    bl_parent_id = "LANCER_RENDER_PT_messages"
    bl_options = {"HIDE_HEADER"}

    @classmethod
    def poll(cls, context):
        return context.engine == LancerRenderEngine.bl_idname

    def draw(self, _context):
        self.layout.operator(LANCER_OT_save_bug_report.bl_idname, icon="URL")


_CLASSES = (LANCER_OT_save_bug_report, LANCER_RENDER_PT_bug_report)


def register():
    add_all(_CLASSES, bpy.utils.register_class, bpy.utils.unregister_class)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
