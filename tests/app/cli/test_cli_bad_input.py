"""Bad input: each case ends in one clear line, exit code 2, and nothing written."""

import errno
import json
import resource
import signal
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path

import pytest

import meshwright_core
from meshwright import cli

pytestmark = pytest.mark.usefixtures("prepared_agent")

TRIANGLES = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"

BAD_MESHES = {
    "empty.vtk": ("", "empty"),
    "empty.obj": ("", "empty"),
    "words.vtk": ("This is a letter, not a mesh.\n", ""),
    "words.msh": ("This is a letter, not a mesh.\n", ""),
    "words.obj": ("This is a letter, not a mesh.\n", ""),
    "words.ply": ("This is a letter, not a mesh.\n", ""),
    "words.stl": ("This is a letter, not a mesh.\n", ""),
    "words.vtu": ("This is a letter, not a mesh.\n", ""),
    "words.inp": ("This is a letter, not a mesh.\n", ""),
    "words.su2": ("This is a letter, not a mesh.\n", ""),
    "words.off": ("This is a letter, not a mesh.\n", ""),
    "ending.xyzzy": (TRIANGLES, "xyzzy"),
    "mixed.obj": (
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n",
        "triangles and quads|mixed|quads and triangles",
    ),
    "manifold.obj": (
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n",
        "manifold|orient|edge|once",
    ),
    "pinched.obj": (
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n",
        "manifold|pinched|fan|vertex",
    ),
    "nan.obj": (TRIANGLES.replace("v 1 1 0", "v nan 1 0"), "NaN|nan|finite|number"),
    "index.obj": (TRIANGLES.replace("f 1 3 4", "f 1 3 9"), ""),
    "repeated.obj": (TRIANGLES.replace("f 1 3 4", "f 1 3 3"), ""),
    "pentagon.obj": ("v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n", ""),
    "points.obj": ("v 0 0 0\nv 1 0 0\nv 1 1 0\n", ""),
}

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]

BAD_POLYGONS = {
    "bow.json": ({"outline": [[0, 0], [1, 1], [1, 0], [0, 1]]}, "cross"),
    "two.json": ({"outline": [[0, 0], [1, 0]]}, "3|three"),
    "none.json": ({"outline": []}, "3|three"),
    "nan.json": ({"outline": [[0, 0], [1, 0], [float("nan"), 1]]}, "NaN|nan|finite|number"),
    "flat.json": ({"outline": [[0, 0], [1, 0], [2, 0]]}, ""),
    "hole.json": ({"outline": SQUARE, "holes": [[[5, 5], [6, 5], [6, 6]]]}, "hole"),
    "over.json": ({"outline": SQUARE, "holes": [[[3, 3], [6, 3], [3, 3.5]]]}, "Hole 0 crosses"),
    "key.json": ({"points": SQUARE}, "outline"),
    "list.json": ([1, 2, 3], ""),
    "words.json": ("a letter", ""),
    "kind.json": ({"outline": "a letter"}, ""),
    "depth.json": ({"outline": SQUARE, "holes": [[1, 1], [2, 1], [2, 2]]}, ""),
}


@pytest.fixture
def refused(tmp_path, monkeypatch, capfd):
    """Run the command line where it must refuse; return its line on stderr."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(cli.DEBUG, raising=False)

    def run(*words: str, part: str = "") -> str:
        before = {path: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
        code = cli.main(list(words))
        output = capfd.readouterr()
        assert output.err.count("\n") == 1, output.err
        assert output.out == ""
        assert code == 2, output.err
        assert any(word in output.err for word in part.split("|")), output.err
        after = {path: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
        assert after == before
        return output.err

    return run


@pytest.mark.parametrize("name", BAD_MESHES)
def test_bad_mesh_file(refused, tmp_path, name):
    text, part = BAD_MESHES[name]
    (tmp_path / name).write_text(text)
    assert name in refused("improve", name, "-o", "out.obj", part=part)


@pytest.mark.parametrize("name", BAD_POLYGONS)
def test_bad_polygon_file(refused, tmp_path, name):
    polygon, part = BAD_POLYGONS[name]
    (tmp_path / name).write_text(json.dumps(polygon))
    assert name in refused("mesh", name, "-o", "out.obj", "--kind", "quad", part=part)


def test_polygon_file_that_is_not_json(refused, tmp_path):
    (tmp_path / "a.json").write_text('{"outline": [[0, 0], ')
    assert "a.json" in refused("mesh", "a.json", "-o", "out.obj", "--kind", "tri")
    (tmp_path / "a.json").write_bytes(b"\xff\xfe\x00\x01")
    assert "a.json" in refused("mesh", "a.json", "-o", "out.obj", "--kind", "tri")


@pytest.mark.parametrize(
    "words", [["improve", "no.vtk", "-o", "a.vtk"], ["view", "no.vtk"], ["no.vtk"]]
)
def test_missing_file(refused, words):
    assert "no.vtk: there is no such file" in refused(*words)


def test_folder_in_place_of_a_file(refused, tmp_path):
    (tmp_path / "folder").mkdir()
    assert "is a folder" in refused("improve", "folder", "-o", "a.vtk")


def test_unknown_shape_gets_a_hint(refused):
    assert "did you mean star?" in refused("mesh", "sta", "-o", "a.vtk", "--kind", "tri")


def test_unknown_command_gets_a_hint(refused):
    assert "did you mean the command improve?" in refused("improv")


def test_output_folder_that_does_not_exist(refused, tmp_path):
    (tmp_path / "a.obj").write_text(TRIANGLES)
    part = "the folder no does not exist"
    refused("improve", "a.obj", "-o", "no/b.obj", part=part)
    refused("improve", "a.obj", "-o", "b.obj", "--png", "no/b.png", part=part)
    refused("mesh", "star", "-o", "no/b.obj", "--kind", "tri", part=part)
    refused("improve", "a.obj", "-o", "b.obj", "--film", "no/b.gif", part=part)
    refused("demo", "-o", "no/b.png", part=part)


def test_output_ending_that_cannot_be_written(refused, tmp_path):
    (tmp_path / "a.obj").write_text(TRIANGLES)
    refused("improve", "a.obj", "-o", "b.docx", part="cannot write the ending .docx")
    refused(
        "improve", "a.obj", "-o", "b.obj", "--png", "b.jpg", part="cannot write the ending .jpg"
    )
    refused("improve", "a.obj", "-o", "b.obj", "--film", "b.avi", part="use one of .gif .mp4")
    refused("mesh", "star", "-o", "b", "--kind", "tri", part="a name without an ending")


def test_quads_into_a_format_of_triangles(refused):
    refused("mesh", "star", "-o", "b.stl", "--kind", "quad", part="cannot write the ending .stl")


def shipped_policy(kind: str) -> Path:
    from meshwright_agent.policy import policy_files

    name = policy_files.shipped(kind)[0]
    return Path(str(files("meshwright_assets") / "policies" / f"{name}.safetensors"))


def test_missing_policy(refused, tmp_path):
    (tmp_path / "a.obj").write_text(TRIANGLES)
    refused("improve", "a.obj", "-o", "b.obj", "--policy", "no.safetensors", part="no such file")
    refused("improve", "a.obj", "-o", "b.obj", "--policy", "nobody", part="nobody")


@pytest.mark.parametrize("share", [0.0, 0.001, 0.5, 0.999])
def test_policy_cut_short(refused, tmp_path, share):
    whole = shipped_policy("tri").read_bytes()
    (tmp_path / "half.safetensors").write_bytes(whole[: int(share * len(whole))])
    (tmp_path / "a.obj").write_text(TRIANGLES)
    refused(
        "improve",
        "a.obj",
        "-o",
        "b.obj",
        "--policy",
        "half.safetensors",
        part="half.safetensors",
    )


def test_policy_that_is_another_file(refused, tmp_path):
    (tmp_path / "a.obj").write_text(TRIANGLES)
    refused("improve", "a.obj", "-o", "b.obj", "--policy", "a.obj", part="a.obj")


def test_policy_of_the_other_kind(refused, tmp_path):
    (tmp_path / "a.obj").write_text(TRIANGLES)
    policy = str(shipped_policy("quad"))
    refused("improve", "a.obj", "-o", "b.obj", "--policy", policy, part="is for quads")
    refused("evaluate", "--kind", "tri", "--policy", policy, part="is for quads")


@contextmanager
def files_no_larger_than(size: int):
    """Let the system refuse to write more, as a full disk does, in the middle of a file."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, handler)


@pytest.mark.parametrize("ending", ["vtk", "obj", "msh", "ply"])
def test_full_disk_leaves_the_old_mesh_whole(refused, tmp_path, capfd, ending):
    words = ["mesh", "star", "-o", f"a.{ending}", "--kind", "quad"]
    assert cli.main(words) == 0
    capfd.readouterr()
    with files_no_larger_than(500):
        refused(*words, part="too large|No space|cannot write")
    meshwright_core.read(tmp_path / f"a.{ending}").validate()


def test_full_disk_leaves_the_old_picture_whole(refused, tmp_path, monkeypatch):
    from meshwright.graphics.export import export_job

    def picture(mesh, path, *_):
        path.write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(export_job, "save_mesh_picture", picture)
    (tmp_path / "a.obj").write_text(TRIANGLES)
    (tmp_path / "a.png").write_bytes(b"old")
    words = ["improve", "a.obj", "-o", "a.obj", "--png", "a.png", "--rollouts", "1"]
    refused(*words, part="no space left on device")
