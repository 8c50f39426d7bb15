"""CGNS: one structured zone for each block, one-to-one connectivity, boundary families.

The nodes are laid out as the SIDS and their HDF5 mapping prescribe: each is a group with its name,
label and data type as attributes and its data in the dataset " data". Written with h5py, an
optional package.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.grid_quality import block_sides
from meshwright_core.blocks.patches import plain_name, unlike
from meshwright_core.errors import MeshError

_VERSION = 3.4
_LONGEST = 28
"""Letters of a family, so that a number can stand behind them: names have at most 32."""
_TYPES = {"float64": "R8", "float32": "R4", "int32": "I4", "int64": "I8", "int8": "C1"}


def require_h5py() -> None:
    """Raise MeshError if h5py is not installed."""
    if importlib.util.find_spec("h5py") is None:
        raise MeshError(
            "CGNS files need the package h5py, which is not installed (pip install h5py)"
        )


def write_cgns(path: Path, grid: BlockGrid) -> None:
    """Write the grid to a new file. Raises MeshError without h5py."""
    require_h5py()
    import h5py

    # in memory first: where the disk is full, HDF5 does not survive closing its file
    with h5py.File(
        path, "w", libver=("earliest", "v108"), track_order=True, driver="core",
        backing_store=False,
    ) as file:  # fmt: skip
        root = file["/"]
        root.attrs.create("name", np.bytes_("HDF5 MotherNode"), dtype="S33")
        root.attrs.create("label", np.bytes_("Root Node of HDF5 File"), dtype="S33")
        root.attrs.create("type", np.bytes_("MT"), dtype="S3")
        root.create_dataset(" format", data=_characters("IEEE_LITTLE_32", 15))
        root.create_dataset(" hdf5version", data=_characters(h5py.version.hdf5_version, 33))
        _node(root, "CGNSLibraryVersion", "CGNSLibraryVersion_t", np.array([_VERSION], np.float32))
        base = _node(root, "Base", "CGNSBase_t", np.array([2, 3], np.int32))
        labels = families(grid)
        _add_families(base, *labels)
        joints = _joints(grid)
        for block in range(len(grid.shapes)):
            _add_zone(base, grid, block, joints[block], labels)
        file.flush()
        image = file.id.get_file_image()
    path.write_bytes(image)


def _add_families(base: Any, sides: dict[str, str], regions: dict[str, str]) -> None:
    for name in sides.values():
        family = _node(base, name, "Family_t")
        _node(family, "FamilyBC", "FamilyBC_t", _text("UserDefined"))
    for name, label in regions.items():
        family = _node(base, label, "Family_t")
        _node(family, "Description", "Descriptor_t", _text(f"region {name}"))


def families(grid: BlockGrid) -> tuple[dict[str, str], dict[str, str]]:
    """The families of patches and of regions by their names: no two are called the same, nor as a
    zone is, and none has more than 32 letters. One region alone is no family.
    """
    structure = grid.structure
    taken = {_zone_name(block) for block in range(len(grid.shapes))}

    def label(name: str) -> str:
        found = unlike((plain_name(name) or "region")[:_LONGEST], taken)
        taken.add(found)
        return found

    sides = {patch.name: label(patch.name) for patch in structure.patches}
    names = dict.fromkeys(structure.region_names)
    if len(structure.region_names) == 1:
        return sides, {}
    return sides, {
        name: label(f"{name}_region" if plain_name(name) in sides else name) for name in names
    }


def _zone_name(block: int) -> str:
    return f"Block{block + 1:05d}"


def _add_zone(
    base: Any,
    grid: BlockGrid,
    block: int,
    joints: list[tuple[Any, ...]],
    labels: tuple[dict[str, str], dict[str, str]],
) -> None:
    structure = grid.structure
    sides, regions = labels
    n, m = grid.shapes[block].tolist()
    size = np.array([[n + 1, m + 1], [n, m], [0, 0]], np.int32)
    zone = _node(base, _zone_name(block), "Zone_t", size)
    _node(zone, "ZoneType", "ZoneType_t", _text("Structured"))
    if regions:
        family = regions[structure.region_names[structure.region[block]]]
        _node(zone, "FamilyName", "FamilyName_t", _text(family))
    coordinates = _node(zone, "GridCoordinates", "GridCoordinates_t")
    points = grid.block_points(block)
    for axis, letter in enumerate("XYZ"):
        values = np.ascontiguousarray(points[:, :, axis])
        _node(coordinates, f"Coordinate{letter}", "DataArray_t", values)
    links = _node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t")
    for number, (donor, own, theirs, transform) in enumerate(joints, start=1):
        joint = _node(links, f"Joint{number}", "GridConnectivity1to1_t", _text(_zone_name(donor)))
        _node(joint, "PointRange", "IndexRange_t", own)
        _node(joint, "PointRangeDonor", "IndexRange_t", theirs)
        _node(joint, "Transform", '"int[IndexDimension]"', np.array(transform, np.int32))
    conditions = _node(zone, "ZoneBC", "ZoneBC_t")
    for patch in structure.patches:
        for side in np.flatnonzero(np.isin(structure.sides[block], patch.edges)).tolist():
            if structure.neighbours[structure.sides[block, side]].min() >= 0:
                continue
            label = f"{sides[patch.name]}_{side + 1}"
            condition = _node(conditions, label, "BC_t", _text("FamilySpecified"))
            _node(condition, "PointRange", "IndexRange_t", _range(n, m, side, True))
            _node(condition, "FamilyName", "FamilyName_t", _text(sides[patch.name]))


def _joints(grid: BlockGrid) -> list[list[tuple[Any, ...]]]:
    """For each block and joint: the other block, both ranges of points, and the transform."""
    structure = grid.structure
    found: list[list[tuple[Any, ...]]] = [[] for _ in grid.shapes]
    for block, side, other, across in block_sides(structure).tolist():
        if other < 0:
            continue
        same = structure.forward[block, side] == structure.forward[other, across]
        for b, s, o, t in ((block, side, other, across), (other, across, block, side)):
            (n, m), (p, q) = grid.shapes[[b, o]].tolist()
            own, theirs = _range(n, m, s, True), _range(p, q, t, bool(same))
            found[b].append((o, own, theirs, _transform(s, t, bool(same))))
    return found


def _transform(side: int, donor: int, same: bool) -> tuple[int, int]:
    """The axis of the donor, from 1 and negative where it runs backwards, along each own axis.

    Along the side the axes agree or not; across it, leaving one block enters the other.
    """
    along = (donor % 2 + 1) * (1 if same else -1)
    leaves, enters = side in (1, 2), donor in (0, 3)
    through = (2 - donor % 2) * (1 if leaves == enters else -1)
    return (along, through) if side % 2 == 0 else (through, along)


def _range(n: int, m: int, side: int, ahead: bool) -> np.ndarray:
    """(2, 2) first and last point of a side, as (i, j) from 1."""
    ends = {
        0: ((1, 1), (n + 1, 1)), 1: ((n + 1, 1), (n + 1, m + 1)),
        2: ((1, m + 1), (n + 1, m + 1)), 3: ((1, 1), (1, m + 1)),
    }[side]  # fmt: skip
    return np.array(ends if ahead else ends[::-1], np.int32)


def _text(text: str) -> np.ndarray:
    return np.frombuffer(text.encode(), np.int8)


def _characters(text: str, size: int) -> np.ndarray:
    return np.frombuffer(text.encode().ljust(size, b"\0")[:size], np.int8)


def _node(parent: Any, name: str, label: str, data: np.ndarray | None = None) -> Any:
    """A node of the tree; the data of (n, m) arrays in Fortran's order is the transposed one, as
    HDF5 counts its axes.
    """
    node = parent.create_group(name, track_order=True)
    node.attrs.create("name", np.bytes_(name[:32]), dtype="S33")
    node.attrs.create("label", np.bytes_(label), dtype="S33")
    kind = "MT" if data is None else _TYPES[str(data.dtype)]
    node.attrs.create("type", np.bytes_(kind), dtype="S3")
    node.attrs.create("flags", np.array([1], np.int32))
    if data is not None:
        node.create_dataset(" data", data=data)
    return node
