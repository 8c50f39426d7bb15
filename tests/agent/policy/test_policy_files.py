"""Policy files: round trip, the policies installed with the program, damaged files."""

import json

import pytest
import torch

from meshwright_agent.env.task import Task
from meshwright_agent.policy.network import Architecture, PolicyNetwork
from meshwright_agent.policy.policy_files import Policy, PolicyError, load, save_policy, shipped


def _saved(tmp_path, kind="quad"):
    torch.manual_seed(0)
    policy = Policy(kind, PolicyNetwork(Task(kind, blocks=2), Architecture(width=8)), {"note": "x"})
    path = tmp_path / "policy.safetensors"
    save_policy(policy, path)
    return policy, path


def test_a_policy_survives_the_round_trip(tmp_path):
    policy, path = _saved(tmp_path)
    back = load(path)
    assert back.task == policy.task
    assert back.network.architecture == policy.network.architecture
    assert back.header == {"note": "x"}
    for name, value in policy.network.state_dict().items():
        assert torch.equal(value, back.network.state_dict()[name])


def test_the_folder_of_a_training_names_its_policy(tmp_path):
    runs = [tmp_path / "wide", tmp_path / "narrow"]
    for folder in runs:
        folder.mkdir()
        _saved(folder)
    assert [load(folder).name for folder in runs] == ["wide", "narrow"]
    assert load(runs[0] / "policy.safetensors").name == "wide"
    (tmp_path / "empty").mkdir()
    with pytest.raises(PolicyError, match=r"empty: this folder has no policy.safetensors"):
        load(tmp_path / "empty")


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_policies_of_both_kinds_are_installed(kind):
    assert shipped(kind)[0] == kind
    policy = load(kind)
    assert policy.kind == kind
    assert policy.header["training"]["task"]["kind"] == kind
    assert policy.header["progress"]["curve"]
    assert 0.5 < policy.header["evaluation"]["single_mean"] <= 1.0


def _spoil_header(path, change):
    content = path.read_bytes()
    size = int.from_bytes(content[:8], "little")
    header = json.loads(content[8 : 8 + size])
    inner = json.loads(header["__metadata__"]["meshwright"])
    change(inner)
    header["__metadata__"]["meshwright"] = json.dumps(inner)
    new = json.dumps(header).encode()
    path.write_bytes(len(new).to_bytes(8, "little") + new + content[8 + size :])


@pytest.mark.parametrize(
    ("spoil", "word"),
    [
        (
            lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
            "incomplete",
        ),
        (lambda path: path.write_bytes(b""), "incomplete"),
        (lambda path: path.write_text("a policy, honestly"), "not a policy"),
        (lambda path: _spoil_header(path, lambda h: h.update(format=99)), "format 99"),
        (lambda path: _spoil_header(path, lambda h: h["task"].update(kind="hex")), "hex"),
        (lambda path: _spoil_header(path, lambda h: h["task"].update(blocks=3)), "fit"),
        (lambda path: path.unlink(), "no such"),
    ],
)
def test_a_bad_file_is_refused_in_one_sentence(tmp_path, spoil, word):
    _, path = _saved(tmp_path)
    spoil(path)
    with pytest.raises(PolicyError) as caught:
        load(path)
    assert word in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_weights_that_are_not_finite_are_refused(tmp_path):
    policy, path = _saved(tmp_path)
    with torch.no_grad():
        policy.network.beta.fill_(float("nan"))
    save_policy(policy, path)
    with pytest.raises(PolicyError, match="not finite"):
        load(path)
