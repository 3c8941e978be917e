"""What all of Lancer's panels share."""

from ..engine.render_engine import LancerRenderEngine

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
        """A column with labels at the left; animated: with dots that set keys, as Cycles has them for things of the scene."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = animated
        return self.layout.column()


def uses_classic(scene):
    return scene.lancer.integrator == "CLASSIC"


def setting(column, name, *owners, **options):
    """Shows a setting of the first owner that has it, and tells whether any has.

    Versions of Blender differ in where they keep it, and Cycles, an add-on, may be off.
    """
    for owner in owners:
        if owner is not None and name in owner.bl_rna.properties:
            column.prop(owner, name, **options)
            return True
    return False


def nodes_of(column, tree, kind):
    """Shows the node that is linked to that input of Cycles' output node; an error where there is no such node."""
    output = None if tree is None else tree.get_output_node("CYCLES")
    if output is None:
        column.label(text="No output node", icon="ERROR")
    else:
        column.template_node_view(tree, output, output.inputs[kind])
