"""Base of Lancer's panels."""

from ..engine.render_engine import LancerRenderEngine
from ..operators import measuring

ID = LancerRenderEngine.bl_idname


class LancerPanel:
    """A panel of the Properties editor that is shown while Lancer is the engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ID}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def _column(self, animated=False):
        """Return a column with labels at the left; animated: with dots for keyframes, where Cycles has them."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = animated
        return self.layout.column()


class LancerRenderPanel(LancerPanel):
    """A panel of the Render tab, where panels appear in the order of registration, before those that Lancer adopts."""

    bl_context = "render"


def uses_classic(scene):
    return scene.lancer.integrator == "CLASSIC"


def setting(column, name, *owners, **options):
    """Draw a setting of the first owner that has it; return whether any owner has it.

    Versions of Blender differ in the owner, and the Cycles add-on may be disabled.
    """
    for owner in owners:
        if owner is not None and name in owner.bl_rna.properties:
            column.prop(owner, name, **options)
            return True
    return False


def light_group(column, owner, layer):
    """Draw the light group of an object or a world: a name, which may also be one that the view layer does not have yet."""
    row = column.row(align=True)
    row.prop_search(owner, "lightgroup", layer, "lightgroups", text="Light Group", results_are_suggestions=True)
    button = row.row(align=True)
    button.enabled = bool(owner.lightgroup) and owner.lightgroup not in layer.lightgroups
    button.operator("scene.view_layer_add_lightgroup", icon="ADD", text="").name = owner.lightgroup


def nodes_of(column, tree, kind):
    """Draw the node linked to an input of Cycles' output node; an error if there is no output node."""
    output = None if tree is None else tree.get_output_node("CYCLES")
    if output is None:
        column.label(text="No output node", icon="ERROR")
    else:
        column.template_node_view(tree, output, output.inputs[kind])


def draw_measuring(column, scene, operator, doing="Measuring"):
    """Draw the progress of a running operator instead of its button; return False if it does not run."""
    what, fraction, text = measuring.running.get(scene.name, ("", 0.0, ""))
    if what != operator:
        return False
    column.label(text=f"{doing}, {fraction * 100:.0f} % (Esc stops)", icon="TIME")
    column.label(text=text)
    return True
