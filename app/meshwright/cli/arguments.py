"""Reads and checks the inputs of commands: meshes, shapes, policies, numbers.

Every problem of an input is raised here as UserError or, for a number on the command line, as
argparse's own error. A MeshError raised later, while a command works, is therefore reported as an
internal error.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.console import Report, UserError
from meshwright.sources.naming import looks_like_path

if TYPE_CHECKING:
    from meshwright.document.document import Document
    from meshwright_agent.policy.policy_files import Policy
    from meshwright_agent.training.trainer import TrainingConfiguration
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.domains.domain import Domain


def read_mesh(
    path: str,
    corner_angle: float | None = None,
    part: str | None = None,
    to_quads: bool = False,
) -> HalfEdgeMesh:
    """Return the mesh in a mesh file or a project, or raise UserError with the reason.

    ``corner_angle`` in degrees: a boundary vertex where the boundary turns by more is a corner. A
    project stores its corners. ``part`` names the only part of the file that is read; ``to_quads``
    makes quads of its triangles.
    """
    _require_file(path)
    from meshwright.document.document import Document
    from meshwright.sources import resolve
    from meshwright_core.io import file_checks, formats

    with bad_input(path):
        found = resolve.resolve(Path(path), corner_angle=corner_angle, part=part, to_quads=to_quads)
        if not isinstance(found, Document) or found.mesh is None:
            with file_checks.naming(Path(path)):
                formats.of(path)  # refuses a drawing
            raise AssertionError(path)
        return found.mesh.copy()


def read_document(word: str, kind: str, corner_angle: float | None = None) -> Document:
    """Return the document for a file or the name of a shape, or raise UserError with the reason.

    A shape is meshed with elements of ``kind``; a project brings its history. ``corner_angle`` as
    for :func:`read_mesh`.
    """
    from meshwright.document.document import Document
    from meshwright.sources import resolve

    if resolve.names_file(word):
        _require_file(word)
    with bad_input(word):
        found = resolve.resolve(word, corner_angle=corner_angle)
    if isinstance(found, Document):
        return found
    return Document(make_mesh(found, kind), found.name or Path(word).stem)


def read_domain(
    shape: str,
    corner_angle: float | None = None,
    curve_step: float | None = None,
    region: str | None = None,
    gap: float | None = None,
    fit: str | None = None,
    seconds: float | None = None,
) -> Domain:
    """Return the domain with this name in the gallery, or in this drawing.

    ``corner_angle`` in degrees: a point where the boundary turns by more is a corner.
    ``curve_step``, ``region``, ``gap`` and ``fit`` as for
    :func:`meshwright.sources.resolve.resolve`; they are for drawings. ``seconds`` of processor time
    are allowed; None for the default.
    """
    from meshwright.sources import resolve
    from meshwright_core.core.time_limit import SECONDS, time_limit

    if resolve.names_file(shape):
        _require_file(shape)
    for option, value in (("--region", region), ("--fit-arcs", fit)):
        if value is not None and not resolve.names_file(shape):
            raise UserError(f"{option}: this is for drawings, and {shape} is a name in the gallery")
    with bad_input(shape), time_limit(seconds or SECONDS):
        return resolve.domain(
            shape,
            corner_angle=corner_angle,
            curve_step=curve_step,
            region=region,
            gap=gap,
            fit=fit,
        )


def make_mesh(
    domain: Domain,
    kind: str,
    max_edge: float | None = None,
    seed: int = 0,
    seconds: float | None = None,
) -> HalfEdgeMesh:
    """Return a mesh of the domain, or raise UserError if it cannot be meshed as requested.

    ``seconds`` of processor time are allowed; None for the default.
    """
    from meshwright_core.domains import meshing

    with bad_input(domain.name or "the domain"):
        return meshing.mesh_domain(domain, kind, max_edge=max_edge, seed=seed, seconds=seconds)


def prepare_agent(report: Report) -> None:
    """Compile the kernels of the agent if they are not in the cache yet, with a message."""
    from meshwright_agent import warm_up

    if warm_up.is_warm_on_disk():
        return
    report.note("Preparing the agent. This takes half a minute or so, once on this machine.")
    with report.progress("preparing the agent", warm_up.ENTRY_POINTS) as update:
        warm_up.warm(lambda done, total: update(done, f"{done} of {total} kernels"))


def read_policy(name: str | None, kind: str) -> Policy:
    """Return a policy for meshes of this kind: by name, from a file, or the shipped one."""
    from meshwright_agent.policy import policy_files
    from meshwright_core.core.kinds import KIND_NOUN

    policy_files.decide_on_one_thread()
    if name is None:
        shipped = policy_files.shipped(kind)
        if not shipped:
            raise UserError(f"no policy for {KIND_NOUN[kind]} is installed; give one by --policy")
        name = shipped[0]
    elif looks_like_path(name) and not Path(name).is_dir():
        _require_file(name)
    with bad_input(name, policy_files.PolicyError):
        policy = policy_files.load(name)
        policy_files.require_kind(policy, kind, name)
    return policy


def read_configuration(path: str | None, kind: str) -> TrainingConfiguration:
    """Return a training configuration, the shipped one if no path is given."""
    from meshwright_agent.training import trainer

    if path is not None:
        _require_file(path)
    source = path or str(trainer.shipped_configuration(kind))
    with bad_input(source, trainer.ConfigurationError):
        configuration = trainer.read_configuration(source)
    found = configuration.task.kind
    if found != kind:
        raise UserError(f"{source}: this configuration is for --kind {found}, not {kind}")
    return configuration


def one_of(word: str, known: Sequence[str], option: str) -> str:
    """Return the word if it is a known one, or raise UserError with the list of known ones."""
    if word not in known:
        raise UserError(f"{option} {word}: unknown; choose from {', '.join(known)}")
    return word


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


def length(text: str) -> float:
    """Read a finite number of at least 0 from the command line."""
    value = _float(text)
    if not (value >= 0 and math.isfinite(value)):
        raise argparse.ArgumentTypeError(f"{text} is not a number of at least 0")
    return value


def positive_float(text: str) -> float:
    """Read a finite number above 0 from the command line."""
    value = _float(text)
    if not (value > 0 and math.isfinite(value)):
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return value


def share(text: str) -> float:
    """Read a number of 0 to 1 from the command line."""
    value = _float(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of 0 to 1")
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
def bad_input(name: str, *more: type[Exception]) -> Iterator[None]:
    """Turn a MeshError, or one of ``more``, into a UserError whose sentence names the input."""
    from meshwright_core.errors import MeshError

    refused: tuple[type[Exception], ...] = (MeshError, *more)
    try:
        yield
    except refused as error:
        sentence = str(error)
        raise UserError(sentence if name in sentence else f"{name}: {sentence}") from error
