"""Damaged files: each format's readers get thousands of mutations of sound files.

A reader may refuse a file in a sentence, or return a valid mesh. Anything else is a fault: another
exception, a mesh that breaks an invariant, more than ten seconds of processor time, or more than
512 MiB of memory.
"""

from __future__ import annotations

import resource
import signal
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from meshwright.console import Update, no_update
from meshwright_core import MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.io import drawings, mesh_files
from meshwright_core.io.formats import FORMATS, NOT_UNDERSTOOD, SHAPES

SUMMARY = "mutated files of every format: refused in a sentence, or read as a valid mesh"
MUTATIONS, QUICK = 2000, 12
SECONDS = 10.0
"""Processor time that reading one file may take."""
LARGEST = 512 * 1024
"""KiB of memory by which the process may grow while it reads one file."""
_NUMBERS = (
    b"-1",
    b"0",
    b"1",
    b"99999999999",
    b"2147483648",
    b"nan",
    b"1e308",
    b"18446744073709551615",
)
_DRAWINGS = {
    ".svg": '<svg xmlns="http://www.w3.org/2000/svg"><style>.a,.b{fill:none}</style>'
    '<path class="a" d="M0 0h9v9h-9z"/><circle cx="4" cy="4" r="2"/></svg>',
    ".geojson": '{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, '
    '"geometry": {"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,4],[0,4],[0,0]]]}}]}',
    ".wkt": "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 1 2, 2 2, 2 1, 1 1))",
    ".json": '{"outline": [[0,0],[4,0],[4,4],[0,4]], "holes": [[[1,1],[1,2],[2,2]]]}',
    ".poly": "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n",
    ".dxf": "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\n0\n90\n4\n70\n1\n10\n0\n20\n0\n"
    "10\n4\n20\n0\n10\n4\n20\n4\n10\n0\n20\n4\n0\nCIRCLE\n8\n0\n10\n2\n20\n2\n40\n1\n0\nENDSEC\n0\nEOF\n",
}


class _TooLong(BaseException):
    """Reading has taken more processor time than it may."""


def run(seed: int, quick: bool, update: Update = no_update) -> dict[str, Any]:
    """Read 2,000 mutations (``quick``: 12) of each format.

    By ending: how many were ``refused``, how many ``read`` as valid meshes, and the ``faults``,
    a line each.
    """
    count = QUICK if quick else MUTATIONS
    rng = np.random.default_rng(seed)
    results: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        for ending, sources in _sources(Path(folder)):
            update(len(results), ending)
            read = _read_drawing if ending in SHAPES else _read_mesh
            results[ending] = fuzzed(Path(folder) / f"mutation{ending}", sources, read, count, rng)
    totals = {key: sum(row[key] for row in results.values()) for key in ("refused", "read")}
    return {**results, "all": {**totals, "faults": sum(len(r["faults"]) for r in results.values())}}


def fuzzed(
    path: Path,
    sources: list[bytes],
    read: Callable[[Path], None],
    count: int,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """Read `count` mutations of sources from a path; the counts of what came of it."""
    found: dict[str, Any] = {"refused": 0, "read": 0, "faults": []}
    for number in range(count):
        path.write_bytes(mutated(sources[number % len(sources)], rng))
        _judge(lambda: read(path), found)
    return found


def _judge(work: Callable[[], None], found: dict[str, Any]) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        with _limited():
            work()
        found["read"] += 1
    except MeshError as error:
        if NOT_UNDERSTOOD in str(error) or "\n" in str(error) or not str(error):
            found["faults"].append(str(error)[-200:])
        else:
            found["refused"] += 1
    except _TooLong:
        found["faults"].append(f"it takes more than {SECONDS:g} s")
    except Exception as error:
        found["faults"].append(f"{type(error).__name__}: {error}"[:200])
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    if grown > LARGEST * (1024 if sys.platform == "darwin" else 1):
        found["faults"].append(f"it takes {grown // 1024} MiB")


@contextmanager
def _limited() -> Iterator[None]:
    def stop(number: int, frame: FrameType | None) -> None:
        raise _TooLong

    usual = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, usual)


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """The bytes with one to four changes: of bits, bytes, numbers, and pieces."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 5))):
        if not changed:
            break
        at, to = sorted(rng.integers(0, len(changed), 2).tolist())
        to = min(to, at + int(rng.integers(1, 64)))
        match int(rng.integers(0, 8)):
            case 0:
                changed[at] ^= 1 << int(rng.integers(0, 8))
            case 1:
                changed[at] = int(rng.integers(0, 256))
            case 2:
                del changed[at:to]
            case 3:
                changed[at:at] = changed[at:to]
            case 4:
                del changed[at:]
            case 5:
                word = _NUMBERS[int(rng.integers(0, len(_NUMBERS)))]
                start = at
                while at < len(changed) and changed[at : at + 1].isdigit():
                    at += 1
                changed[start:at] = word
            case 6:
                changed[at : at + 4] = rng.bytes(4)
            case _:
                line = changed.find(b"\n", at)
                end = changed.find(b"\n", line + 1)
                if 0 <= line < end:
                    changed[at:at] = changed[line:end]
    return bytes(changed)


def _sources(folder: Path) -> Iterator[tuple[str, list[bytes]]]:
    """Sound files of each format, small ones."""
    meshes = [meshing.mesh_domain(gallery.shape(name), kind) for name, kind in
              (("star", "quad"), ("square", "tri"))]  # fmt: skip
    for ending, form in FORMATS.items():
        files = []
        for mesh in meshes:
            name = "triangle" if mesh.k == 3 else "quad"
            if name in form.kinds and not form.needs:
                path = folder / f"whole{ending}"
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    mesh_files.write(path, mesh)
                files.append(path.read_bytes())
        if files:
            yield ending, files
    for ending, text in _DRAWINGS.items():
        yield ending, [text.encode()]


def _read_mesh(path: Path) -> None:
    mesh_files.load(path).mesh.validate()


def _read_drawing(path: Path) -> None:
    drawings.read_domain(path)
