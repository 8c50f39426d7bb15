"""Names of sides and regions, in and out again: 200 operations, then the agent, by `improve`."""

import numpy as np
import pytest
from named_plate import EXPECTED, edit, measures, plate

from meshwright import cli
from meshwright_core import read, write

pytestmark = pytest.mark.usefixtures("prepared_agent")

VERSION_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
FORMS = [
    ("msh 2.2", ".msh", ""),
    ("msh 4.1", ".msh", VERSION_4),
    ("su2", ".su2", ""),
    ("inp", ".inp", ""),
    ("vtu", ".vtu", ""),
]


def expected(ending: str) -> dict[str, tuple[float, ...]]:
    """SU2 has no regions, and one marker for each edge."""
    if ending != ".su2":
        return EXPECTED
    wall = {"wall": (2.0, 2.0, 0.0, 4.0, 0.0), "wall&hot": (2.0, 0.0, 0.0, 2.0, 0.0)}
    return {"inlet": EXPECTED["inlet"], **wall}


def edited(path, ending: str, version: str):
    """A file of a plate after 200 operations, read from a file and written to another."""
    first = path / f"first{ending}"
    made = plate()
    if ending == ".su2":  # the joint is no side there once there is no region
        made.rename("joint", "")
    first.write_text(version)
    write(first, made)
    mesh = read(first)
    edit(mesh, np.random.default_rng(5))
    second = path / f"second{ending}"
    second.write_text(version)
    write(second, mesh)
    return second


@pytest.mark.filterwarnings("ignore::meshwright_core.errors.FileWarning")
@pytest.mark.parametrize(("name", "ending", "version"), FORMS, ids=[form[0] for form in FORMS])
def test_operations_and_the_agent_keep_all_names(name, ending, version, tmp_path, capsys):
    second, third = edited(tmp_path, ending, version), tmp_path / f"third{ending}"
    assert measures(read(second)) == expected(ending)
    third.write_text(version)
    command = ["improve", str(second), "-o", str(third), "--rollouts", "1", "--steps", "20"]
    # 3: after so many operations at random elements are inverted, and one rollout may leave some
    assert cli.main(command) in (0, 3)
    before, after = read(second), read(third)
    assert measures(after) == expected(ending)
    assert after.score < before.score
    after.validate()
    if version:
        assert third.read_text().startswith(VERSION_4)


@pytest.mark.filterwarnings("ignore::meshwright_core.errors.FileWarning")
@pytest.mark.parametrize("version", ["", VERSION_4], ids=["msh 2.2", "msh 4.1"])
def test_gmsh_reads_the_same_groups(version, tmp_path):
    gmsh = pytest.importorskip("gmsh", reason="needs the package gmsh")
    path = edited(tmp_path, ".msh", version)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        found = {}
        for dimension, tag in gmsh.model.getPhysicalGroups():
            name = gmsh.model.getPhysicalName(dimension, tag)
            places = gmsh.model.mesh.getNodesForPhysicalGroup(dimension, tag)[1].reshape(-1, 3)
            box = (*places[:, :2].min(axis=0), *places[:, :2].max(axis=0))
            key = name if dimension == 1 else f"region {name}"
            found[key] = tuple(np.round(box, 6).tolist())
    finally:
        gmsh.finalize()
    assert found == {name: measure[1:] for name, measure in EXPECTED.items()}
