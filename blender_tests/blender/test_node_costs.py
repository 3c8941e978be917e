"""What the Material tab tells of nodes: how often each runs, and the sentences about them."""

from types import SimpleNamespace

from addon.bindings.enums import Coordinate, MathOperation, NodeKind
from addon.bindings.shading import Lobe, Material, Node, NodeRef
from addon.measure.node_costs import costs_of, nanoseconds
from addon.measure.node_lines import lines

PLACE = Node(NodeKind.COORDINATE, option=Coordinate.OBJECT)


def sine(of):
    return Node(NodeKind.MATH, option=MathOperation.SINE, inputs=(NodeRef(of), 0.0, 0.0))


def bump(of, first):
    return Node(NodeKind.BUMP, inputs=(1.0, 1.0, NodeRef(of), 0.0, 1.0), first=first)


def runs(nodes, **values):
    found = costs_of(Material(nodes=nodes, **values))
    return [cost / nanoseconds(node) for cost, node in zip(found, nodes, strict=True)]


def test_a_bump_runs_its_height_three_times_and_what_precedes_it_once():
    nodes = (PLACE, PLACE, sine(1), bump(2, first=1), sine(0))
    assert runs(nodes, lobes=(Lobe(normal=NodeRef(3), color=NodeRef(4)),)) == [1, 3, 3, 1, 1]
    # A node inside the range that the surface reads, too, runs once more.
    assert runs(nodes, lobes=(Lobe(normal=NodeRef(3), color=NodeRef(2)),)) == [0, 4, 4, 1, 0]
    # A height may read nodes before its own.
    assert runs((PLACE, sine(0), bump(1, first=1)), lobes=(Lobe(normal=NodeRef(2)),)) == [1, 3, 1]


def test_idle_nodes_and_those_of_displacement_cost_no_ray():
    assert runs((PLACE, sine(0), sine(1)), displacement=NodeRef(2), emission=NodeRef(1)) == [1, 1, 0]


def test_sentences():
    def told(total, left, costs, **more):
        nanoseconds = sum(cost for _, cost in costs)
        return lines(SimpleNamespace(total=total, left=left, costs=tuple(costs), nanoseconds=nanoseconds), 2.0, **more)

    assert told(0, 0, ()) == ["No node computes a value"]
    assert told(5, 0, ()) == ["5 nodes: constant, which costs nothing"]
    two = [("Noise", 90.0), ("Math", 10.0)]
    assert told(9, 2, two) == [
        "2 of 9 nodes are left: the others are constant, equal to one of these or change nothing",
        "About 200 ns for a hit of a ray",
        "Noise: 180 ns, 90 % of its nodes",
        "Math: 20 ns, 10 % of its nodes",
    ]
    # A million hits at 200 ns in 2 threads of a second.
    rendered = {"render_seconds": 1.0, "threads": 2, "vertices": 10**6}
    assert told(2, 2, two, statistics=rendered) == [
        "All of its 2 nodes are evaluated",
        "About 200 ns for a hit of a ray, at most 10 % of the picture's time",
        "Noise: 180 ns, 90 % of its nodes, at most 9 % of the picture's time",
        "Math: 20 ns, 10 % of its nodes, at most 1 % of the picture's time",
    ]
    many = told(12, 12, [(f"Node {number}", 600.0) for number in range(12)])
    assert many[1] == "About 14.4 \N{MICRO SIGN}s for a hit of a ray" and many[-1] == "4 more: 4.8 \N{MICRO SIGN}s, 33 %"
