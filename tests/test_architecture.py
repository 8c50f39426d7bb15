"""Imports follow the layers, light modules import no heavy libraries, functions are annotated.

What an import loads is measured in a fresh interpreter, as this one has loaded everything.
"""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HEAVY = ("torch", "gymnasium", "safetensors", "matplotlib", "rich", "PIL")
DRAWING = ("qtpy", "PySide6", "pyvista", "pyvistaqt", "vtkmodules", "vtk")
READERS = ("meshio", "trimesh", "shapely", "triangle", "networkx")
NUMERIC = ("numpy", "numba", "scipy")
PACKAGES = ("meshwright_agent", "meshwright_core")


def brought_along(statement: str) -> set[str]:
    """The top-level modules that are loaded once a fresh interpreter has run the statement."""
    code = f"import sys, json; {statement}; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    return {name.partition(".")[0] for name in json.loads(done.stdout.splitlines()[-1])}


@pytest.mark.parametrize(
    ("statement", "forbidden"),
    [
        ("import meshwright_core", (*HEAVY, *DRAWING, *READERS, "meshwright_agent", "meshwright")),
        ("from meshwright_core.domains import gallery, meshing", (*HEAVY, *DRAWING)),
        ("import meshwright_agent", (*DRAWING, "meshwright")),
        (  # PyTorch's compiler, which takes seconds, and brings this along
            "from meshwright_agent.policy import policy_files; policy_files.load('quad')",
            ("sympy", *DRAWING),
        ),
        ("import meshwright.document.document", (*HEAVY, *DRAWING, "meshwright_agent")),
        ("import meshwright.assistant.assistant", ("torch", *DRAWING)),
        (
            "import meshwright.puzzles.level, meshwright.puzzles.play",
            (*HEAVY, *DRAWING, "meshwright_agent"),
        ),
        ("import meshwright.graphics.vtk_scene", ("torch", "qtpy", "PySide6", "pyvistaqt")),
        ("import meshwright.desktop.main_window.window", ("torch", "meshwright_agent")),
        (
            "import meshwright.cli",
            (*HEAVY, *DRAWING, *READERS, *NUMERIC, "meshwright_agent", "meshwright_core"),
        ),
    ],
)
def test_import_brings_along_only_what_it_needs(statement: str, forbidden: tuple[str, ...]) -> None:
    assert not brought_along(statement) & set(forbidden)


@pytest.mark.parametrize("words", [["--help"], ["--version"], ["improve", "--help"], ["mesh"]])
def test_command_line_answers_without_heavy_imports(words: list[str]) -> None:
    heavy = {*HEAVY, *DRAWING, *READERS, *NUMERIC, *PACKAGES}
    assert not brought_along(f"from meshwright.cli import main; main({words!r})") & heavy


def test_import_contracts() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports; exit(lint_imports())"],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stdout + done.stderr


ROOTS = {"meshwright_core": "meshcore", "meshwright_agent": "agent", "meshwright": "app"}


def module_files() -> dict[str, Path]:
    """The file of every module of the three packages, by dotted name."""
    files = {}
    for package, root in ROOTS.items():
        for path in (ROOT / root / package).rglob("*.py"):
            parts = path.relative_to(ROOT / root).with_suffix("").parts
            files[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return files


def imported(tree: ast.Module) -> list[tuple[str, int]]:
    """Dotted names that a module imports, with their lines: also inside functions and under
    TYPE_CHECKING."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, "imports are absolute"
            found += [(f"{node.module}.{alias.name}", node.lineno) for alias in node.names]
    return found


def room_imports(package: str, files: dict[str, Path]) -> dict[tuple[str, str], list[str]]:
    """File and line of the imports between rooms (direct children) of a package, by pair."""
    edges: dict[tuple[str, str], list[str]] = {}
    prefix = f"{package}."
    for module, path in files.items():
        if not module.startswith(prefix):
            continue
        room = module.removeprefix(prefix).partition(".")[0]
        for name, line in imported(ast.parse(path.read_text())):
            if not name.startswith(prefix):
                continue
            other = name.removeprefix(prefix).partition(".")[0]
            # names that the package's own __init__ defines belong to no room
            if other != room and f"{prefix}{other}" in files:
                text = f"{path.relative_to(ROOT)}:{line}"
                lines = edges.setdefault((room, other), [])
                lines += [text] if text not in lines else []
    return edges


def reachable(start: str, edges: dict[tuple[str, str], list[str]]) -> set[str]:
    """All rooms that a room imports, directly or through others."""
    found: set[str] = set()
    pending = [start]
    while pending:
        room = pending.pop()
        following = {b for a, b in edges if a == room} - found
        found |= following
        pending += following
    return found


ROOMS = ["meshwright.desktop", "meshwright_core.domains", "meshwright_core.io.drawings"]


@pytest.mark.parametrize("package", [*ROOTS, *ROOMS])
def test_no_rooms_import_each_other(package: str) -> None:
    edges = room_imports(package, module_files())
    assert edges
    reached = {room: reachable(room, edges) for room in {a for a, _ in edges}}
    circular = {
        f"{a} imports {b}: {', '.join(lines)}"
        for (a, b), lines in edges.items()
        if a in reached.get(b, set())
    }
    assert not circular, "these imports close a circle of rooms:\n" + "\n".join(sorted(circular))


def unannotated(path: Path) -> list[str]:
    """Functions and methods that leave out a type, but for compiled kernels, which have none."""
    found = []
    module = ast.parse(path.read_text())
    classes = [node for node in ast.walk(module) if isinstance(node, ast.ClassDef)]
    for node in [child for owner in (module, *classes) for child in owner.body]:
        if not isinstance(node, ast.FunctionDef):
            continue
        decorators = [ast.unparse(decorator) for decorator in node.decorator_list]
        if any(name.split("(")[0].endswith(("kernel", "intrinsic")) for name in decorators):
            continue
        arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        named = [a for a in arguments if a.arg not in ("self", "cls")]
        if any(a.annotation is None for a in named) or (named and node.returns is None):
            found.append(f"{path.relative_to(ROOT)}:{node.lineno} {node.name}")
    return found


@pytest.mark.parametrize("package", ["meshcore", "agent", "app"])
def test_functions_are_annotated(package: str) -> None:
    missing = [
        name for path in sorted((ROOT / package).rglob("*.py")) for name in unannotated(path)
    ]
    assert missing == []


MOST_KERNEL_ARGUMENTS = 8


def test_kernels_take_few_arguments() -> None:
    found = []
    for name, path in module_files().items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and any(
                "kernel" in ast.unparse(decorator) for decorator in node.decorator_list
            ):
                count = len(node.args.posonlyargs) + len(node.args.args)
                if count > MOST_KERNEL_ARGUMENTS:
                    found.append(f"{name}.{node.name}: {count}")
    assert not found
