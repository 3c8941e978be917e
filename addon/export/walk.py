"""Links of node trees, followed to their sources through reroutes, muted nodes and groups, as in Cycles."""

from dataclasses import dataclass

import bpy

from .course_models import model_of

# From 5.0 on a link from a reroute or muted node without input counts as no link; before, its value is 0.
_LOOSE_ENDS_ARE_ZERO = bpy.app.version < (5, 0)
# CUSTOM GROUP is a node of an add-on with a tree of its own.
GROUPS = {"GROUP", "CUSTOM GROUP"}
# Nodes that Cycles does not know: it leaves out their links. CUSTOM is a node of another Blender or of an add-on.
_IGNORED = {"CUSTOM", "EEVEE_SPECULAR", "SHADERTORGB", "SQUEEZE", "UVALONGSTROKE"}
_LONGEST = 10000  # hops: ends the walk in a cycle of reroutes


@dataclass(frozen=True)
class Site:
    """A node and the group nodes around it, outermost first."""

    node: object
    path: tuple = ()

    @property
    def key(self):
        return (self.node.as_pointer(), *(group.as_pointer() for group in self.path))


@dataclass(frozen=True)
class Origin:
    """The source of a socket: an output of site. If site is None, the constant of socket; if that is None too, 0.

    types: the types of all sockets on the way, from the given one on; values are converted at each.
    """

    site: object
    output: object
    socket: object
    types: tuple


def sites(tree, kind):
    """Yield the Sites of all nodes of a type in a tree and in its groups."""
    open_ = [(tree, ())]
    while open_:
        inside, path = open_.pop()
        for node in inside.nodes:
            if node.type == kind:
                yield Site(node, path)
            elif node.type in GROUPS and not node.mute and node.node_tree is not None:
                open_.append((node.node_tree, (*path, node)))


class Walker:
    """Caches the links of each tree, which Blender would search for every socket."""

    def __init__(self, has_scripts):
        """has_scripts: whether Cycles runs scripts."""
        self.ignored = []  # Sites that Cycles ignores, one for each link from them
        self._links = {}
        self._ignored = _IGNORED if has_scripts else _IGNORED | {"SCRIPT"}

    def origin(self, site, socket):
        if not socket.is_linked:
            return Origin(None, None, socket, (socket.type,))
        asked, path, types = socket, site.path, [socket.type]
        constant, depth = socket, 1
        for _ in range(_LONGEST):
            link = self._link(socket)
            if link is None:
                break
            node, output = link.from_node, link.from_socket
            if node.mute or node.type == "REROUTE":
                onward = _passed_through(node, output)
            elif node.type in GROUPS and not _is_closure(node, output):
                onward, path = _group_result(node, output), (*path, node)
                if onward is None:
                    constant, depth = None, len(types)
            elif node.type == "GROUP_INPUT" and path:
                onward, path = _by_identifier(path[-1].inputs, output.identifier), path[:-1]
            elif node.type in self._ignored:
                self.ignored.append(Site(node, path))
                if not _LOOSE_ENDS_ARE_ZERO:
                    constant, depth = asked, 1
                break
            else:
                return Origin(Site(node, path), output, None, tuple(types))
            if onward is None:
                break
            socket = onward
            # Cycles replaces a muted node by a conversion between equal types: those of its output.
            types.append(output.type if node.mute else socket.type)
            if not node.mute and node.type != "REROUTE":
                constant, depth = socket, len(types)
            elif _LOOSE_ENDS_ARE_ZERO:
                constant, depth = None, len(types)
        return Origin(None, None, constant, tuple(types[:depth]))

    def _link(self, socket):
        tree = socket.id_data
        key = tree.as_pointer()
        if key not in self._links:
            usable = (link for link in tree.links if link.is_valid and not link.is_muted)
            self._links[key] = {
                link.to_socket.as_pointer(): link for link in usable if link.from_socket.enabled and link.to_socket.enabled
            }
        return self._links[key].get(socket.as_pointer())


def _is_closure(node, output):
    """Whether a group node is one of the course's models, which are read as closures."""
    return output.type == "SHADER" and model_of(node.node_tree) is not None


def _passed_through(node, output):
    """Return the input that a reroute or muted node passes to an output; None if there is none."""
    if node.type == "REROUTE":
        return node.inputs[0]
    return next((inner.from_socket for inner in node.internal_links if inner.to_socket == output), None)


def _by_identifier(sockets, identifier):
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def _group_result(node, output):
    """Return the socket inside a group that feeds one of its outputs; None if the group is missing or empty."""
    if node.node_tree is None:
        return None
    results = [inner for inner in node.node_tree.nodes if inner.type == "GROUP_OUTPUT"]
    active = next((inner for inner in results if inner.is_active_output), results[0] if results else None)
    return None if active is None else _by_identifier(active.inputs, output.identifier)
