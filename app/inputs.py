"""What a command is given: meshes, shapes, policies, numbers.

Everything that can be wrong with an input is found here and raised as UserError or, for a number
on the command line, as argparse's own error. A MeshError that comes later, while a command works,
is therefore a bug of ours and is reported as one.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from app.report import Report, UserError

if TYPE_CHECKING:
    from agent.policies import Policy
    from agent.training import Training
    from app.document import Document
    from meshcore import HalfEdgeMesh
    from meshcore.domain import Domain

KIND_NOUN = {"tri": "triangles", "quad": "quads"}


def read_mesh(path: str, corner_angle: float | None = None) -> HalfEdgeMesh:
    """Return the mesh in a file, or raise UserError that says what is wrong with it.

    ``corner_angle`` in degrees: a boundary vertex where the boundary turns by more is a corner. A
    project knows its corners.
    """
    _require_file(path)
    import meshcore
    from app import project

    with _bad_input(path):
        if project.is_project(path):
            return project.read(path).mesh.copy()
        if corner_angle is None:
            return meshcore.read(path)
        return meshcore.read(path, corner_angle=corner_angle)


def read_project(path: str) -> Document:
    """Return the document in a project file, its history with it, or raise UserError."""
    _require_file(path)
    from app.document import Document

    document = Document()
    with _bad_input(path):
        document.open(path)
    return document


def read_domain(shape: str, corner_angle: float | None = None) -> Domain:
    """Return the domain with this name in the gallery, or in this geometry file.

    ``corner_angle`` in degrees: a point where the boundary turns by more is a corner.
    """
    from meshcore import geometry_files, shapes

    if looks_like_path(shape) or Path(shape).exists():
        _require_file(shape)
        with _bad_input(shape):
            if corner_angle is None:
                return geometry_files.read_domain(shape)
            return geometry_files.read_domain(shape, corner_angle)
    with _bad_input(shape):
        return shapes.shape(shape)


def make_mesh(
    domain: Domain, kind: str, max_edge: float | None = None, seed: int = 0
) -> HalfEdgeMesh:
    """Return a mesh of the domain, or raise UserError if it cannot be meshed as asked."""
    from meshcore import generate

    with _bad_input(domain.name or "the domain"):
        return generate.mesh_domain(domain, kind, max_edge=max_edge, seed=seed)


def prepare_agent(report: Report) -> None:
    """Compile what an agent needs where that was never done, and say so: it takes a while."""
    from agent import warm_up

    if warm_up.is_warm_on_disk():
        return
    report.note("Preparing the agent. This takes half a minute or so, once on this machine.")
    with report.progress("preparing the agent", warm_up.ENTRY_POINTS) as update:
        warm_up.warm(lambda done, total: update(done, f"{done} of {total} kernels"))


def read_policy(name: str | None, kind: str) -> Policy:
    """Return a policy for meshes of this kind: by name, from a file, or the one we ship."""
    from agent import policies

    policies.decide_on_one_thread()
    if name is None:
        shipped = policies.shipped(kind)
        if not shipped:
            raise UserError(f"no policy for {KIND_NOUN[kind]} is installed; give one by --policy")
        name = shipped[0]
    elif looks_like_path(name):
        _require_file(name)
    with _bad_input(name, policies.PolicyError):
        policy = policies.load(name)
    if policy.kind != kind:
        raise UserError(
            f"{name}: this policy is for {KIND_NOUN[policy.kind]}, the mesh is of {KIND_NOUN[kind]}"
        )
    return policy


def read_configuration(path: str | None, kind: str) -> Training:
    """Return a training configuration, the shipped one if no path is given."""
    from agent import training

    if path is not None:
        _require_file(path)
    source = path or str(training.shipped_configuration(kind))
    with _bad_input(source, training.ConfigurationError):
        configuration = training.read_configuration(source)
    found = configuration.task.kind
    if found != kind:
        raise UserError(f"{source}: this configuration is for --kind {found}, not {kind}")
    return configuration


def one_of(word: str, known: Sequence[str], option: str) -> str:
    """Return the word if it is a known one, or raise UserError with those that are."""
    if word not in known:
        raise UserError(f"{option} {word}: there is no such one; choose from {', '.join(known)}")
    return word


def looks_like_path(text: str) -> bool:
    """Tell whether the user meant a file: it has an ending or a folder."""
    return bool(Path(text).suffix) or "/" in text or "\\" in text


def positive_int(text: str) -> int:
    """Read a whole number of at least 1 from the command line."""
    value = _int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number of at least 1")
    return value


def seed(text: str) -> int:
    """Read a seed, a whole number of at least 0, from the command line."""
    value = _int(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number of at least 0")
    return value


def positive_float(text: str) -> float:
    """Read a finite number above 0 from the command line."""
    value = _float(text)
    if not (value > 0 and math.isfinite(value)):
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return value


def angle(text: str) -> float:
    """Read an angle of 0 to 180 degrees from the command line."""
    value = _float(text)
    if not 0 <= value <= 180:
        raise argparse.ArgumentTypeError(f"{text} is not an angle of 0 to 180 degrees")
    return value


def sides(text: str) -> tuple[int, int]:
    """Read a range of polygon sides such as ``10-20``, or one number, from the command line."""
    first, _, last = text.partition("-")
    try:
        low, high = int(first), int(last or first)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a range such as 10-20") from None
    if not 3 <= low <= high:
        raise argparse.ArgumentTypeError(f"{text}: a polygon has 3 sides or more, fewest first")
    return low, high


def _int(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number") from None


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a number") from None


def _require_file(path: str) -> None:
    if Path(path).is_dir():
        raise UserError(f"{path}: that is a folder, not a file")
    if not Path(path).exists():
        raise UserError(f"{path}: there is no such file")


@contextmanager
def _bad_input(name: str, *more: type[Exception]) -> Iterator[None]:
    """Turn a MeshError, or one of ``more``, into a UserError whose sentence names the input."""
    from meshcore.errors import MeshError

    try:
        yield
    except (MeshError, *more) as error:
        sentence = str(error)
        raise UserError(sentence if name in sentence else f"{name}: {sentence}") from error
