"""Policy files looked at without torch."""

import json

import pytest

from meshwright.assistant.policy_catalogue import kind_of, label, shipped


def header(path, content):
    text = json.dumps(content).encode()
    path.write_bytes(len(text).to_bytes(8, "little") + text)
    return path


def test_shipped_ones_begin_with_the_kind():
    assert shipped("quad")[0] == "quad" and shipped("tri")[0] == "tri"
    assert all(name.startswith("quad") for name in shipped("quad"))


def test_the_kind_is_read_from_the_header(tmp_path):
    good = header(tmp_path / "mine.safetensors", {"__metadata__": {"kind": "tri"}})
    assert kind_of(good) == kind_of(str(good)) == "tri"


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"hello",
        b"\xff" * 64,
        (5).to_bytes(8, "little") + b"[1,2]",
        b"\x02" + b"\0" * 7 + b"{}",
    ],
)
def test_files_that_are_no_policies_are_refused(tmp_path, content):
    bad = tmp_path / "bad.safetensors"
    bad.write_bytes(content)
    with pytest.raises(ValueError, match=r"bad\.safetensors: this is no policy file"):
        kind_of(bad)


def test_folders_and_missing_files_are_refused(tmp_path):
    with pytest.raises(ValueError, match="a folder"):
        kind_of(tmp_path)
    with pytest.raises(ValueError, match="no such file"):
        kind_of(tmp_path / "missing.safetensors")


def test_labels():
    assert label("quad-paper") == "quad-paper"
    assert label("/home/somebody/runs/last.safetensors") == "last"
