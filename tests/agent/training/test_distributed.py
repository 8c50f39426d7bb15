"""Training in two processes, and resuming after a kill, started from the command line."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import torch
from safetensors.torch import load_file

from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import Batch, start_meshes
from meshwright_agent.policy.inference import tensors
from meshwright_agent.policy.network import Architecture, PolicyNetwork
from meshwright_agent.training import checkpoint
from meshwright_agent.training.distributed import DeviceError, Processes, joined
from meshwright_agent.training.trainer import train

ROOT = Path(__file__).parents[2]

TINY = """
sides = [8, 10]
pool = 12
iterations = {iterations}
evaluate_every = 1
evaluation_meshes = 4
table_meshes = 0
device = "cpu"
[task]
kind = "quad"
blocks = 2
candidates = 8
steps = 0.5
[architecture]
width = 8
embedding = 4
[ppo]
environments = 9
horizon = 6
minibatch = 16
"""

# run by both processes: a training, and afterwards a record of the state of each
TOGETHER = """
import json, sys
from pathlib import Path
import numpy as np
from safetensors.torch import save_file
from meshwright_agent.training import trainer

configuration, folder = sys.argv[1], Path(sys.argv[2])
trainer.evaluate = lambda *_: {"single_mean": 0.0, "seconds": 1.0}
run_updates = trainer._run_updates

def run_and_record(trainer, *rest):
    run_updates(trainer, *rest)
    known = trainer.processes
    numbers = np.arange(3.0 + known.rank)
    name = folder.parent / f"process-{known.rank}"
    record = {
        "moments": known.mean_and_deviation(numbers),
        "least": known.least(len(numbers)),
        "from_first": known.from_first(known.rank),
        "environments": trainer.settings.environments,
        "decisions": trainer.progress.decisions,
        "curve": [point["mean"] for point in trainer.progress.curve],
    }
    name.with_suffix(".json").write_text(json.dumps(record))
    save_file(trainer.network.state_dict(), name.with_suffix(".safetensors"))

trainer._run_updates = run_and_record
trainer.train(configuration, folder)
"""


def environment() -> dict[str, str]:
    return {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}


@pytest.mark.slow
def test_two_processes_make_the_same_updates_and_the_first_writes(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY.format(iterations=2))
    (tmp_path / "together.py").write_text(TOGETHER)
    words = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node=2"]
    done = subprocess.run(
        [*words, "together.py", "tiny.toml", "out"],
        capture_output=True,
        text=True,
        env=environment(),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    records = [json.loads((tmp_path / f"process-{i}.json").read_text()) for i in range(2)]
    assert [one["environments"] for one in records] == [5, 4]
    assert records[0]["decisions"] == records[1]["decisions"] == 9 * 6 * 2
    assert records[0]["curve"] == records[1]["curve"]
    every = np.array([0, 1, 2, 0, 1, 2, 3])
    for one in records:
        assert one["moments"] == pytest.approx([every.mean(), every.std()])
        assert (one["least"], one["from_first"]) == (3, 0)
    first, second = (load_file(tmp_path / f"process-{i}.safetensors") for i in range(2))
    assert all(torch.equal(first[name], second[name]) for name in first)
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"policy.safetensors", "checkpoint.safetensors", "curve.json", "curve.png"} <= written
    assert len(json.loads((tmp_path / "out" / "curve.json").read_text())) == 3


@pytest.mark.slow
def test_a_killed_training_continues_from_its_last_checkpoint(tmp_path, monkeypatch):
    (tmp_path / "long.toml").write_text(TINY.format(iterations=100_000))
    words = ["train", "--kind", "quad", "--config", "long.toml", "-o", "out"]
    started = subprocess.Popen(
        [sys.executable, "-m", "meshwright", *words],
        stderr=subprocess.PIPE,
        text=True,
        env=environment(),
        cwd=tmp_path,
    )
    path = tmp_path / "out" / "checkpoint.safetensors"
    deadline = time.monotonic() + 150
    while _updates(path) < 2 and time.monotonic() < deadline:
        time.sleep(0.05)
    os.kill(started.pid, signal.SIGKILL)
    log = started.communicate()[1].splitlines()
    assert "single" in log[0]
    assert log[1].split()[0] == "1/100000"
    before = checkpoint.unpack(path.read_bytes())[1]["progress"]
    assert before["iteration"] >= 2
    monkeypatch.setattr(
        "meshwright_agent.training.trainer.evaluate",
        lambda *_: {"single_mean": 0.0, "seconds": 1.0},
    )
    (tmp_path / "long.toml").write_text(TINY.format(iterations=before["iteration"] + 2))
    after = train(tmp_path / "long.toml", tmp_path / "out")
    assert after["iteration"] == before["iteration"] + 2
    assert after["curve"][: len(before["curve"])] == before["curve"]
    assert [point["iteration"] for point in after["curve"]] == list(range(len(before["curve"]) + 2))
    assert after["decisions"] > before["decisions"]


def _updates(path: Path) -> int:
    return checkpoint.unpack(path.read_bytes())[1]["progress"]["iteration"] if path.exists() else 0


def test_a_single_process_returns_its_input():
    alone = Processes()
    assert (alone.first, alone.share(7), alone.least(5), alone.from_first("x")) == (True, 7, 5, "x")
    values = np.array([1.0, 2.0, 6.0], np.float32)
    assert alone.mean_and_deviation(values) == pytest.approx((values.mean(), values.std()))
    assert sum(Processes.share(_numbered(i), 10) for i in range(4)) == 10


def _numbered(rank: int) -> Processes:
    one = Processes()
    one.rank, one.size = rank, 4
    return one


def test_a_missing_gpu_is_reported(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(DeviceError, match="finds no GPU"), joined("cuda"):
        pass
    with joined("auto") as processes:
        assert processes.device.type == "cpu"


def test_a_network_moves_its_input_to_its_device(monkeypatch):
    # no GPU is needed: tensors on "meta" have shapes and a device, and refuse to meet others
    task = Task("tri", channels=6, blocks=2, candidates=8)
    rng = np.random.default_rng(1)
    seen = Batch(task, start_meshes("tri", (6, 8), 2, rng), 2, rng).observe()
    network = PolicyNetwork(task, Architecture(width=8)).to("meta")
    monkeypatch.setattr(torch.Tensor, "cpu", lambda tensor: tensor)
    logits, values = network(*tensors(seen))
    assert logits.shape == (2, 8 * task.operations)
    assert logits.device.type == values.device.type == "meta"
    (logits.mean() + values.mean()).backward()
    assert network.head.weight.grad.device.type == "meta"
