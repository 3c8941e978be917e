"""Draw panels without a window: a layout that records its calls, and a context like that of a tab."""

import inspect
import operator
import types

import bpy
import gpu

# The panel of displays calls it, and it fails without a window.
gpu.capabilities.hdr_support_get = lambda: False

_FUNCTIONS = bpy.types.UILayout.bl_rna.functions


class Record:
    """The contents of a drawn panel: (type, property) pairs, and all words and names of operators in their order."""

    def __init__(self):
        self.properties = set()
        self.words = []


class Layout:
    """Replaces a UILayout, and raises the errors that Blender would raise, for missing properties or unknown icons."""

    def __init__(self, record):
        object.__setattr__(self, "record", record)

    def __setattr__(self, name, value):
        # active, enabled, scale_y ... change the look, not the contents.
        if name not in bpy.types.UILayout.bl_rna.properties:
            raise AttributeError(f"a layout has no {name}")
        object.__setattr__(self, name, value)

    def __getattr__(self, name):
        if name in bpy.types.UILayout.bl_rna.properties:
            return None
        if name not in _FUNCTIONS:
            raise AttributeError(f"a layout has no {name}")
        return types.MethodType(_call, _Call(self.record, name))


class _Call:
    def __init__(self, record, name):
        self.record, self.name = record, name


class _Operator:
    """Accepts any property of an operator, also of operators within a macro."""

    def __getattr__(self, name):
        return _Operator()


def _call(call, *arguments, **options):
    record, name = call.record, call.name
    parameters = _FUNCTIONS[name].parameters
    for option, value in options.items():
        if option not in parameters and option not in ("text_ctxt", "translate"):
            raise TypeError(f"{name} has no option {option}")
        if option == "icon" and isinstance(value, str) and value not in parameters["icon"].enum_items:
            raise TypeError(f"no icon {value}")
    named = [parameter for parameter in parameters.keys() if parameter in options]
    values = [*arguments, *(options[parameter] for parameter in named)]
    if name in ("operator", "operator_menu_enum", "operator_enum"):
        group, _, operator = values[0].partition(".")
        if operator not in dir(getattr(bpy.ops, group)):
            raise KeyError(values[0])
        record.words.append(values[0])
        return _Operator()
    if name == "template_node_view":
        tree, node, socket = values
        if node is not None and (socket.node != node or node.id_data != tree):
            raise ValueError("the socket is of another node")
        record.words.append("nodes")
    elif name == "template_preview":
        record.words.append("preview")
    elif name == "label":
        record.words.append(options.get("text", ""))
    for owner, identifier in zip(values, values[1:], strict=False):
        if isinstance(owner, bpy.types.bpy_struct) and isinstance(identifier, str):
            _show(record, name, owner, identifier)
    if name in ("panel", "panel_prop"):
        return Layout(record), Layout(record)
    return Layout(record)


def _show(record, name, owner, identifier):
    if identifier.startswith("["):
        return
    if identifier in owner.bl_rna.properties:
        record.properties.add((owner.bl_rna.identifier, identifier))
        record.words.append(identifier)
    elif name == "prop":
        raise KeyError(f"{owner.bl_rna.identifier}.{identifier}")


class _Panel:
    """Replaces a panel's instance, which exists only within a window."""

    def __init__(self, cls, layout):
        self._cls = cls
        self.layout = layout

    def __getattr__(self, name):
        found = inspect.getattr_static(self._cls, name)
        return types.MethodType(found, self) if isinstance(found, types.FunctionType) else getattr(self._cls, name)


def draw(cls, context, record=None):
    """Return the Record of a panel's header, presets and body."""
    record = Record() if record is None else record
    for name in ("draw_header", "draw_header_preset", "draw"):
        method = getattr(cls, name, None)
        if method is not None:
            getattr(_Panel(cls, Layout(record)), name)(context)
    return record


class Context:
    """The context of a tab of the Properties editor, in fields; other attributes are those of Blender's own context."""

    region = None
    space_data = types.SimpleNamespace(pin_id=None, use_pin_id=False, type="PROPERTIES")

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def __getattr__(self, name):
        # Blender returns None for an attribute that a tab lacks, such as the mesh of a camera.
        return getattr(bpy.context, name, None)

    def path_resolve(self, path):
        return operator.attrgetter(path)(self)


def shown_panels(context, tab):
    """Return the panels that a tab of the Properties editor shows, each after its parent."""
    registered = [cls for cls in bpy.types.Panel.__subclasses__() if hasattr(bpy.types, cls.__name__)]
    everything = [cls for cls in registered if cls.bl_space_type == "PROPERTIES"]
    children = {}
    for cls in everything:
        children.setdefault(getattr(cls, "bl_parent_id", ""), []).append(cls)
    waiting = [cls for cls in children.get("", ()) if getattr(cls, "bl_context", "") == tab]
    while waiting:
        cls = waiting.pop(0)
        if not hasattr(cls, "poll") or cls.poll(context):
            yield cls
            waiting[:0] = children.get(getattr(cls, "bl_idname", cls.__name__), ())


def drawn(context, tab):
    """Return {name: Record} of the panels that a tab shows."""
    return {cls.__name__: draw(cls, context) for cls in shown_panels(context, tab)}
