"""Reasons for refusing an operation: codes for compiled kernels, and their sentences."""

ALLOWED = 0
DEAD_HALFEDGE = 1
BOUNDARY_EDGE = 2
ENDS_COINCIDE = 3
ENDS_JOINED = 4
DEGREE_TOO_LOW = 5
DEGREE_CAP = 6
BOTH_ON_BOUNDARY = 7
TWO_GEOMETRIC = 8
LOSER_LOCKED = 9
LOSER_DESIRED = 10
GEOMETRIC_INSIDE = 11
LINK_CONDITION = 12
NO_ELEMENT_LEFT = 13
SPLITS_AGAIN = 14
NEVER_ENDS = 15
NOT_A_LINE = 16
LINE_LOCKED = 17
LINE_DESIRED = 18
LINE_CROWDED = 19
MERGED_EDGES_MEET = 20
CHORD_CROSSES_ITSELF = 21
CHORD_PINCHES = 22
OTHER_KIND = 23
INTERFACE_EDGE = 24
BOTH_ON_CURVE = 25
INTERFACE_PULLED = 26
INTERFACE_GONE = 27
LINE_ON_INTERFACE = 28
NO_LOOP = 29
LOOP_NOT_CLOSED = 30
INTERFACES_AT_LOOP = 31

# not a refusal: the caller enlarges the arrays and checks again
NEED_ROOM = 99

SENTENCES = {
    DEAD_HALFEDGE: "there is no half-edge {h} in this mesh",
    BOUNDARY_EDGE: "the edge {a}-{b} lies on the boundary",
    ENDS_COINCIDE: "both ends of the turned edge would be the same vertex",
    ENDS_JOINED: "the vertices that it would join are joined already",
    DEGREE_TOO_LOW: "an interior vertex would be left with too few edges",
    DEGREE_CAP: "a vertex would get more edges than the degree cap of {cap}",
    BOTH_ON_BOUNDARY: "the two vertices that would merge both lie on the boundary",
    TWO_GEOMETRIC: "the two vertices that would merge are both geometric",
    LOSER_LOCKED: "a locked vertex would be deleted",
    LOSER_DESIRED: "a vertex with a desired degree of its own would be deleted, which would change"
    " the optimum",
    GEOMETRIC_INSIDE: "the boundary would be pulled to a geometric vertex inside the mesh",
    LINK_CONDITION: "the two vertices that would merge have other neighbours in common",
    NO_ELEMENT_LEFT: "a boundary vertex would be left without an element",
    SPLITS_AGAIN: "the split would come back to where it began",
    NEVER_ENDS: "the split would never reach the boundary",
    NOT_A_LINE: "no line of regular, non-geometric vertices runs through this edge from boundary to"
    " boundary, or round in a ring",
    LINE_LOCKED: "a locked vertex lies on the line",
    LINE_DESIRED: "a vertex on the line has a desired degree of its own",
    LINE_CROWDED: "the line touches the same element twice",
    MERGED_EDGES_MEET: "two vertices would be joined by two edges, or a vertex to itself",
    CHORD_CROSSES_ITSELF: "the strip of quads crosses itself",
    CHORD_PINCHES: "the two sides of the strip both lie on the boundary there",
    INTERFACE_EDGE: "the edge {a}-{b} lies on the interface of two regions",
    BOTH_ON_CURVE: "the two vertices that would merge both lie on the boundary or an interface, and"
    " no edge of it joins them",
    INTERFACE_PULLED: "an interface of two regions would be pulled to a geometric vertex beside it",
    INTERFACE_GONE: "an edge on the interface of two regions would be deleted",
    LINE_ON_INTERFACE: "a part of the line lies on the interface of two regions",
    NO_LOOP: "the edge {a}-{b} lies within a region: a ring goes along the boundary or along an"
    " interface that closes",
    LOOP_NOT_CLOSED: "the interface there does not close in a loop of its own",
    INTERFACES_AT_LOOP: "two interfaces end in the same vertex of the boundary there",
    OTHER_KIND: "{operation} is not an operation of {kind} meshes",
}
