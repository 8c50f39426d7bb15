"""Checks that ``import meshwright`` works in a folder with modules of common names.

Usage: ``python .ci/shadowed_names.py PYTHON``. PYTHON, the interpreter under test, has Meshwright
installed, and ipykernel; the one that runs this script has nbclient. Both a plain interpreter and
a notebook's kernel make a widget in a folder with ``app.py``, ``agent.py``, ``assets.py`` and
``meshcore.py``, each of which raises when it is imported.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

NAMES = ("app", "agent", "assets", "meshcore")
STATEMENT = "import meshwright as mw; print(mw.MeshWidget('star').score, mw.__file__)"


def main(python: str) -> None:
    """Raise if one of the two does not end well; print what they printed."""
    with tempfile.TemporaryDirectory() as folder:
        for name in NAMES:
            Path(folder, f"{name}.py").write_text(f"raise ImportError('{name}.py was imported')\n")
        subprocess.run([python, "-c", STATEMENT], cwd=folder, check=True)
        sys.stdout.write(in_notebook(python, folder))


def in_notebook(python: str, folder: str) -> str:
    """What the statement prints in a kernel of ``python`` that starts in ``folder``."""
    import nbformat
    from nbclient import NotebookClient

    kernel = Path(folder, "share", "kernels", "tested")
    kernel.mkdir(parents=True)
    command = [python, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    specification = {"argv": command, "display_name": "tested", "language": "python"}
    (kernel / "kernel.json").write_text(json.dumps(specification))
    os.environ["JUPYTER_PATH"] = str(kernel.parents[1])
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(STATEMENT)])
    client = NotebookClient(
        notebook, timeout=170, kernel_name="tested", resources={"metadata": {"path": folder}}
    )
    client.execute()
    return "".join(output["text"] for output in notebook.cells[0].outputs)


if __name__ == "__main__":
    main(sys.argv[1])
