"""Projects, policies and levels whose contents are changed, for :mod:`file_fuzz`.

Bytes changed at random rarely get past checksums, so here the values inside are changed: numbers of
arrays, weights, and any field of the JSON, which gets a value of another type or size.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.document.document import Document
from meshwright.puzzles import level
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import of_kind

Mutation = Callable[[bytes, np.random.Generator], bytes]

VALUES: tuple[Any, ...] = (
    *(-1, 0, 1, 7, 255, 1 << 31, 1 << 53, 1 << 63, 10**30, 0.5, 1e308, float("nan"), float("inf")),
    *(None, True, "", "x", "\n", "x" * 2000, [], {}, [[]], [1, 2], {"a": 1}),
)
"""What a field of JSON is replaced by."""


@dataclass(frozen=True)
class Kind:
    """One kind of file that is not a mesh or a drawing."""

    sources: list[bytes]
    read: Callable[[Path], None]
    """Reads and uses a file; ValueError or MeshError if it is refused."""
    mutated: Mutation


def kinds(folder: Path, by_bytes: Mutation) -> dict[str, Kind]:
    """The kinds by ending; ``by_bytes`` changes bytes of files."""
    return {
        ".meshwright": Kind(_projects(folder), read_project, project_mutated),
        ".safetensors": Kind(_policies(folder), read_policy, policy_mutated),
        "level.json": Kind(_levels(), read_level, partial(level_mutated, by_bytes)),
    }


# projects


def _projects(folder: Path) -> list[bytes]:
    files = []
    for kind in ("quad", "tri"):
        document = Document(meshing.mesh_domain(gallery.shape("l-shape"), kind), "a")
        document.auto_smooth = kind == "tri"
        _wander(document, 10, 1)
        document.go_to(6)
        _wander(document, 4, 2)
        document.go_to(4)
        _wander(document, 5, 3)
        document.go_to(6)
        path = folder / "a.meshwright"
        document.save(path)
        files.append(path.read_bytes())
    document = Document(_two_regions(), "b")
    _wander(document, 8, 4)
    document.go_to(3)
    document.save(path)
    return [*files, path.read_bytes()]


def _two_regions() -> HalfEdgeMesh:
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    first = np.array([i + 5 * j for j in range(4) for i in range(4)])
    elements = np.column_stack([first, first + 1, first + 6, first + 5])
    regions = [int(i % 4 > 1) for i in range(16)]
    return HalfEdgeMesh.from_elements(np.column_stack([x, y]), elements, regions=regions)


def _wander(document: Document, steps: int, seed: int) -> None:
    """Apply operations at random."""
    mesh = document.need_mesh()
    rng = np.random.default_rng(seed)
    operations = [info.operation for info in of_kind(mesh.kind)]
    until = document.history.cursor + steps
    while document.history.cursor < until:
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        operation = operations[rng.integers(len(operations))]
        if document.check(operation, h):
            document.submit(operation, h)


def read_project(path: Path) -> None:
    """Open a project and check the mesh in every state that undo, redo and branches reach."""
    document = Document()
    document.open(path)
    document.need_mesh().validate()
    taken = set()
    while True:
        _walk(document)
        left = [
            (number, branch)
            for number, branch in enumerate(document.history.branches)
            if branch.rows[-1].serial not in taken
        ]
        if not left:
            return
        number, branch = left[0]
        taken.add(branch.rows[-1].serial)
        document.take_branch(number)


def _walk(document: Document) -> None:
    while document.history.can_undo:
        document.undo()
        _require(document)
    while document.history.can_redo:
        document.redo()
        _require(document)


def _require(document: Document) -> None:
    mesh, last = document.need_mesh(), document.history.last
    try:
        mesh.validate()
    except MeshError as error:
        raise AssertionError(f"a state that undo or redo reaches: {error}") from error
    if last is not None and (last.after, last.optimum) != (mesh.score, mesh.optimum):
        raise AssertionError("a row of the history has another score than its mesh")


def project_mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """A project with one to three changes in its arrays, or one in its header."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    if rng.random() < 0.3:
        header = json.loads(members["project.json"])
        members["project.json"] = json.dumps(json_mutated(header, rng)).encode()
    else:
        steps = (".rows", ".places", ".whole", ".coordinates", ".parameters")
        names = [
            name
            for name in members
            if name.endswith(".npy")
            and (name.removesuffix(".npy").endswith(steps) or rng.random() < 0.3)
        ]
        for _ in range(int(rng.integers(1, 4))):
            name = names[int(rng.integers(len(names)))]
            array = np.load(io.BytesIO(members[name]))
            stream = io.BytesIO()
            np.lib.format.write_array(stream, _array_mutated(array, rng), (1, 0))
            members[name] = stream.getvalue()
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def _array_mutated(array: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """An array with another number at one place, one row more or less, or of another type."""
    choice = rng.random()
    if choice < 0.05:
        return array[: int(rng.integers(0, len(array) + 1))]
    if choice < 0.1:
        return np.concatenate([array, array[-3:]])
    if choice < 0.12:
        return array.astype(np.float64)
    changed = array.copy()
    flat = changed.reshape(-1)
    if not flat.size:
        return changed
    at, other = int(rng.integers(flat.size)), int(rng.integers(flat.size))
    if flat.dtype.kind == "f":
        values: tuple[Any, ...] = (flat[other], -flat[at], flat[at] * rng.random(), np.nan, 1e300)
    else:
        small = int(rng.integers(0, 100))
        limits = np.iinfo(flat.dtype if flat.dtype.kind in "iu" else np.uint8)
        values = (flat[other], small, limits.max, limits.min, int(flat[at]) ^ 1, int(flat[at]) ^ 8)
    flat[at] = values[int(rng.integers(len(values)))]
    return changed


# policies


def _policies(folder: Path) -> list[bytes]:
    import torch  # imported late: it takes a second

    from meshwright_agent.env.task import Task
    from meshwright_agent.policy.network import Architecture, PolicyNetwork
    from meshwright_agent.policy.policy_files import Policy, save_policy

    files = []
    shapes = Architecture(width=8, embedding=4, value_width=8)
    for kind, selection in (("quad", "shortlist"), ("tri", "template")):
        torch.manual_seed(0)
        task = Task(kind, selection=selection, candidates=8, blocks=2, channels=6)
        point = {"decisions": 1.0, "mean": 0.1, "std": 0.1, "at_optimum": 0.0}
        header = {"training": {"sides": [10, 30]}, "progress": {"curve": [point, point]}}
        path = folder / "a.safetensors"
        save_policy(Policy("a", PolicyNetwork(task, shapes), header), path)
        files.append(path.read_bytes())
    return files


def read_policy(path: Path) -> None:
    """Load a policy, let it make five decisions on a mesh, and read what is shown of it."""
    from meshwright_agent.policy import policy_files, rollout

    policy = policy_files.load(path)
    mesh = meshing.mesh_domain(gallery.shape("square"), policy.kind)
    runner = rollout.Runner(mesh, policy, 0, 5)
    while runner.step():
        continue
    runner.mesh.validate()
    curve = (policy.header.get("progress") or {}).get("curve", [])
    sum(point["mean"] + point["std"] for point in curve)


def policy_mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """A policy with another value in its header, or other weights."""
    size = int.from_bytes(data[:8], "little")
    outer, weights = json.loads(data[8 : 8 + size]), bytearray(data[8 + size :])
    choice = rng.random()
    if choice < 0.75:
        inner = json_mutated(json.loads(outer["__metadata__"]["meshwright"]), rng)
        outer["__metadata__"]["meshwright"] = json.dumps(inner)
    elif choice < 0.9:
        outer = json_mutated(outer, rng)
    else:
        for _ in range(int(rng.integers(1, 9))):
            value = float(rng.choice([np.nan, np.inf, 3e38, 1e5, -1e6, 1e-40]))
            at = 4 * int(rng.integers(len(weights) // 4))
            weights[at : at + 4] = np.float32(value).tobytes()
    text = json.dumps(outer).encode()
    return len(text).to_bytes(8, "little") + text + bytes(weights)


# levels


def _levels() -> list[bytes]:
    return [path.read_bytes() for path in sorted(level.FOLDER.glob("*.json"))[:3]]


def read_level(path: Path) -> None:
    """Read a level, build its mesh and play its solution."""
    found = level.read(path)
    mesh = found.mesh()
    mesh.validate()
    level.play(mesh, found.solution)
    mesh.validate()
    if not (found.story and found.aim):
        raise AssertionError("it has no description")


def level_mutated(by_bytes: Mutation, data: bytes, rng: np.random.Generator) -> bytes:
    """A level with other bytes, or another value in a field."""
    if rng.random() < 0.3:
        return by_bytes(data, rng)
    return json.dumps(json_mutated(json.loads(data), rng)).encode()


def archive_mutated(by_bytes: Mutation, data: bytes, rng: np.random.Generator) -> bytes:
    """A zip archive with other bytes, or with other bytes in one of its files."""
    if rng.random() < 0.3:
        return by_bytes(data, rng)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    largest = max(files, key=lambda name: len(files[name]))
    names = list(files)
    name = largest if rng.random() < 0.7 else names[int(rng.integers(len(names)))]
    files[name] = by_bytes(files[name], rng)
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return target.getvalue()


def json_mutated(content: Any, rng: np.random.Generator) -> Any:
    """The content with one to three fields replaced, left out or repeated."""
    for _ in range(int(rng.integers(1, 4))):
        holder: Any = content
        while True:  # down to a place at random, with any depth as likely
            if not isinstance(holder, (dict, list)) or not holder:
                break
            keys = list(holder) if isinstance(holder, dict) else range(len(holder))
            key = keys[int(rng.integers(len(keys)))]
            inner = holder[key]
            if isinstance(inner, (dict, list)) and inner and rng.random() < 0.8:
                holder = inner
                continue
            _change(holder, key, rng)
            break
    return content


def _change(holder: Any, key: Any, rng: np.random.Generator) -> None:
    choice = rng.random()
    if choice < 0.1:
        del holder[key]
    elif choice < 0.15 and isinstance(holder, list):
        holder.insert(key, holder[key])
    else:
        holder[key] = VALUES[int(rng.integers(len(VALUES)))]
