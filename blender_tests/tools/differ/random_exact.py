"""Objects that Lancer traces as exact surfaces: their meshes become so fine that Cycles shows nearly the same."""

from .record import Record, is_link

# The exact surface by the shape of a mesh, and the shape of its fine mesh.
_EXACT = {
    "ball": ("SPHERE", "fine ball"),
    "cone": ("CONE", "fine cone"),
    "torus": ("CYLINDER", "fine cylinder"),
    "plane": ("PLANE", "vast plane"),
}
_SHARE = 0.25
# Nodes and outputs that read what an exact surface lacks; on an infinite plane some more.
_UNFIT = {
    "ShaderNodeUVMap", "ShaderNodeAttribute", "ShaderNodeVertexColor", "ShaderNodeTangent", "ShaderNodeNormalMap",
    "ShaderNodeDisplacement", "ShaderNodeVectorDisplacement",
}  # fmt: skip
_UNFIT_OUTPUTS = {"UV", "Parametric"}
_UNFIT_ON_PLANES = {"ShaderNodeEmission", "ShaderNodeBackground", "ShaderNodeTexCoord", "ShaderNodeBsdfPrincipled"}
_READS_UV = ("ShaderNodeTexImage",)


def make_exact(dice, records):
    """Return the records, some of whose objects are exact surfaces; none where the pass UV shows their own coordinates."""
    if any("UV" in record.fields.get("passes", ()) for record in records if record.verb == "frame"):
        return records
    named = {record.name: record for record in records if record.verb in ("mesh", "object")}
    users = [record.fields.get("data") for record in records if record.verb == "object"]
    changed = {record.fields["object"] for record in records if record.verb == "modifier"}
    nodes = _nodes_by_tree(records)
    result = list(records)
    for at, record in enumerate(records):
        mesh = named.get(record.fields.get("data", "@")[1:]) if record.verb == "object" else None
        if mesh is None or mesh.verb != "mesh" or mesh.fields["shape"] not in _EXACT or not dice.chance(_SHARE):
            continue
        exact, fine = _EXACT[mesh.fields["shape"]]
        if users.count(f"@{mesh.name}") > 1 or f"@{record.name}" in changed or 0.0 in record.fields["scale"]:
            continue
        materials = {*mesh.fields["materials"][:1], record.fields.get("material")} - {None}
        if len(mesh.fields["materials"]) > 1 or not all(_fits(nodes, name[1:], exact) for name in materials):
            continue
        fields = {key: value for key, value in mesh.fields.items() if key in ("materials", "uv_maps")}
        result[records.index(mesh)] = Record(
            "mesh", mesh.name, {"shape": fine, "smooth": "no" if exact == "PLANE" else "yes", **fields}
        )
        result[at] = Record("object", record.name, {**record.fields, "exact": exact})
    return result


def _nodes_by_tree(records):
    trees = {}
    for record in records:
        if record.verb == "node":
            trees.setdefault(record.fields["tree"], []).append(record.fields)
    return trees


def _fits(nodes, tree, exact):
    """Whether an exact surface has everything that a material's nodes read."""
    for fields in nodes.get(tree, []):
        kind, inputs = fields["kind"], fields.get("inputs", {})
        group = fields.get("props", {}).get("node_tree")
        if kind in _UNFIT or (exact == "PLANE" and kind in _UNFIT_ON_PLANES):
            return False
        if kind in _READS_UV and "Vector" not in inputs:
            return False
        if any(is_link(value) and value[1] in _UNFIT_OUTPUTS for value in inputs.values()):
            return False
        if group is not None and not _fits(nodes, group[1:], exact):
            return False
    return True
