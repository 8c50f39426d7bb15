"""Damaged files: each format's readers get thousands of mutations of sound files.

A reader may refuse a file in a sentence, or return a valid mesh. Anything else is a fault: another
exception, a mesh that breaks an invariant, more than ten seconds of processor time, more than
512 MiB of memory, or the end of the process. Files are read by a process of their own, whose
address space is limited. Of the shapes that are read, some are meshed too.
"""

from __future__ import annotations

import io
import multiprocessing
import resource
import signal
import sys
import tempfile
import warnings
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from meshwright.benchmarks import hostile_files
from meshwright.benchmarks.hostile_files import Kind
from meshwright.console import Update, no_update
from meshwright_core import MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.io import drawings, mesh_files
from meshwright_core.io.formats import FORMATS, NOT_UNDERSTOOD, missing_package

SUMMARY = "mutated files of every format: refused in a sentence, or read as a valid mesh"
MUTATIONS, QUICK = 2000, 12
SECONDS = 10.0
"""Processor time that reading one file may take."""
LARGEST = 512 * 1024
"""KiB of memory by which the process may grow while it reads one file."""
_ADDRESSES = 2 << 30
"""Bytes of address space that reading may take beyond those in use."""
_CHUNK = 250
"""Files that one process reads."""
_FORK = multiprocessing.get_context("fork")
_MESHED = 8
"""Of so many shapes that are read, one is meshed."""
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
    "airfoil.dat": "oval\n"
    + "\n".join(
        f"{0.5 + 0.5 * np.cos(t):.5f} {0.1 * np.sin(t):.5f}" for t in np.linspace(0, 2 * np.pi, 30)
    ),
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


_GRID = (
    '<VTKFile type="{0}" byte_order="LittleEndian"><{0} WholeExtent="0 2 0 1 0 0" Origin="0 0 0" '
    'Spacing="1 1 1"><Piece Extent="0 2 0 1 0 0"><CellData><DataArray type="Int32" Name="m">7 8'
    "</DataArray></CellData><{1}>{2}</{1}></Piece></{0}></VTKFile>"
)
_AXIS = '<DataArray type="Float64" NumberOfComponents="{1}">{0}</DataArray>'
_DECK = (
    "*PART, NAME=P\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=CPS4\n"
    "1, 1, 2, 3, 4\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n2., 0., 0.\n"
    "*END INSTANCE\n*NSET, NSET=left, INSTANCE=I\n1, 4\n*ELSET, ELSET=_S1, INSTANCE=I, GENERATE\n"
    "1, 1, 1\n*SURFACE, NAME=low, TYPE=ELEMENT\n_S1, S1\n*END ASSEMBLY\n"
)
_MESHES = {
    ".vts": _GRID.format(
        "StructuredGrid", "Points", _AXIS.format("0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0", 3)
    ),
    ".vti": _GRID.format("ImageData", "PointData", ""),
    ".vtr": _GRID.format(
        "RectilinearGrid",
        "Coordinates",
        "".join(_AXIS.format(values, 1) for values in ("0 1 2", "0 1", "0")),
    ),
    ".inp": _DECK,
    ".msh": "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$ENDNOD\n$ELM\n3\n1 1 7 1 2 1 2\n"
    "2 2 8 1 3 1 2 3\n3 2 8 1 3 1 3 4\n$ENDELM\n",
}
"""Files that we do not write, beside those that we do."""


class _TooLong(BaseException):
    """Reading has taken more processor time than it may."""


def run(seed: int, quick: bool, update: Update = no_update) -> dict[str, Any]:
    """Read 2,000 mutations (``quick``: 12) of each format.

    By ending: how many were ``refused``, how many ``read`` as valid meshes, and the ``faults``,
    a line each. Also of projects, policies and levels, all of whose states and decisions are
    checked.
    """
    count = QUICK if quick else MUTATIONS
    results: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        for ending, kind in kinds(Path(folder)).items():
            update(len(results), ending)
            results[ending] = fuzzed(Path(folder) / f"mutation{ending}", kind, count, seed)
    totals = {key: sum(row[key] for row in results.values()) for key in ("refused", "read")}
    return {**results, "all": {**totals, "faults": sum(len(r["faults"]) for r in results.values())}}


def kinds(folder: Path) -> dict[str, Kind]:
    """All kinds of files by ending, with whole files that are written in a folder."""
    found = hostile_files.kinds(folder, mutated)
    for ending, sources in _sources(folder):
        read = _read_drawing if ending in _DRAWINGS else _read_mesh
        change = partial(hostile_files.archive_mutated, mutated) if ending == ".3mf" else mutated
        found[ending] = Kind(sources, read, change)
    return found


def fuzzed(path: Path, kind: Kind, count: int, seed: int) -> dict[str, Any]:
    """Read `count` mutations from a path in processes of their own; the counts of what came of it.

    Mutation i is the same in each run with this seed.
    """
    found: dict[str, Any] = {"refused": 0, "read": 0, "faults": []}
    first = 0
    while first < count:
        verdicts: list[str] = []
        receive, send = _FORK.Pipe(duplex=False)
        numbers = range(first, min(count, first + _CHUNK))
        child = _FORK.Process(target=_read_all, args=(path, kind, numbers, seed, send))
        child.start()
        send.close()
        with suppress(EOFError):
            while True:
                verdicts.append(receive.recv())
        child.join()
        if len(verdicts) < len(numbers):
            verdicts.append(f"the process ended with {child.exitcode}")
        for number, verdict in zip(numbers, verdicts, strict=False):
            if verdict in ("refused", "read"):
                found[verdict] += 1
            else:
                found["faults"].append(f"{number}: {verdict}")
        first += len(verdicts)
    return found


def mutation(kind: Kind, number: int, seed: int) -> bytes:
    """The bytes of one mutation."""
    rng = np.random.default_rng((seed, number))
    return kind.mutated(kind.sources[number % len(kind.sources)], rng)


def _read_all(path: Path, kind: Kind, numbers: range, seed: int, send: Connection) -> None:
    """In a process of its own: send the verdict on each mutation."""
    _limit_memory()
    for number in numbers:
        path.write_bytes(mutation(kind, number, seed))
        send.send(verdict(lambda: kind.read(path)))
    send.close()


def _limit_memory() -> None:
    """Limit the address space to what is in use and 2 GiB more."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except OSError:  # another system than Linux: the growth is measured all the same
        return
    limit = pages * resource.getpagesize() + _ADDRESSES
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))


def verdict(work: Callable[[], None]) -> str:
    """What came of reading a file: refused, read, or what is wrong with how it was read."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        with _limited():
            work()
        found = "read"
    except (MeshError, ValueError) as error:
        text = str(error)
        found = "refused"
        own = isinstance(error, MeshError) or type(error).__module__.startswith("meshwright")
        if not own or NOT_UNDERSTOOD in text or "\n" in text or not text:
            found = f"{type(error).__name__}: {text[-200:]}"
    except _TooLong:
        found = f"it takes more than {SECONDS:g} s"
    except Exception as error:
        found = f"{type(error).__name__}: {error}"[:200]
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    if grown > LARGEST * (1024 if sys.platform == "darwin" else 1):
        return f"it takes {grown // 1024} MiB"
    return found


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
            if name in form.kinds and missing_package(form) is None:
                path = folder / f"whole{ending}"
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    mesh_files.write(path, mesh)
                files.append(path.read_bytes())
        if ending in _MESHES:
            files.append(_MESHES[ending].encode())
        if ending == ".cgns" and missing_package(form) is None:
            files += [_cgns(structured) for structured in (False, True)]
        if files:
            yield ending, files
    for ending, text in _DRAWINGS.items():
        yield ending, [text.encode()]


def _cgns(structured: bool) -> bytes:
    """A CGNS file of one zone: two quads, a named side and a family."""
    import h5py

    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:

        def node(parent: Any, name: str, label: str, data: Any = None) -> Any:
            made = parent.create_group(name)
            made.attrs["label"] = np.bytes_(label)
            if data is not None:
                codes = list(data.encode()) if isinstance(data, str) else data
                kind = np.int8 if isinstance(data, str) else None
                made.create_dataset(" data", data=np.array(codes, kind))
            return made

        base = node(file, "Base", "CGNSBase_t", [2, 3])
        size = [[3, 2], [2, 1], [0, 0]] if structured else [[6], [2], [0]]
        zone = node(base, "Zone", "Zone_t", size)
        node(zone, "ZoneType", "ZoneType_t", "Structured" if structured else "Unstructured")
        node(zone, "FamilyName", "FamilyName_t", "steel")
        places = node(zone, "GridCoordinates", "GridCoordinates_t")
        node(places, "CoordinateX", "DataArray_t", [0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
        node(places, "CoordinateY", "DataArray_t", [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
        if not structured:
            for name, code, span, nodes in (
                ("bars", 3, [1, 2], [1, 2, 2, 3]),
                ("cells", 20, [3, 4], [7, 1, 2, 5, 4, 7, 2, 3, 6, 5]),
            ):
                section = node(zone, name, "Elements_t", [code, 0])
                node(section, "ElementRange", "IndexRange_t", span)
                node(section, "ElementConnectivity", "DataArray_t", nodes)
        side = node(node(zone, "ZoneBC", "ZoneBC_t"), "wall", "BC_t", "BCWall")
        node(side, "PointRange", "IndexRange_t", [[1, 1], [3, 1]] if structured else [[1], [2]])
        if not structured:
            node(side, "GridLocation", "GridLocation_t", "EdgeCenter")
    return memory.getvalue()


def _read_mesh(path: Path) -> None:
    mesh_files.load(path).mesh.validate()


def _read_drawing(path: Path) -> None:
    domain = drawings.read_domain(path)
    if zlib.crc32(path.read_bytes()) % _MESHED == 0:
        meshing.mesh_domain(domain, "tri").validate()
