"""``meshwright batch``: a folder of drawings or meshes to improved meshes or grids."""

from __future__ import annotations

import argparse
import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli.output_files import checked_folder
from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    from meshwright.cli.batches.table import BatchTable

SUMMARY = "improve, or make grids of, all drawings and meshes of a folder"
DESCRIPTION = (
    "Carry out one command for every drawing and mesh in a folder, several at a time: improve, or "
    "blocks with --grids; --options are handed to it. One bad file stops nothing; "
    "a run that was stopped goes on where it was. A table of all parts is written as batch.csv and "
    "batch.json."
)
EPILOGUE = (
    "example: meshwright batch parts -o out --jobs 4 --grids --to .vtm --options='--size 0.1'"
)

USUAL = ".vtu"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.epilog = EPILOGUE
    parser.add_argument("folder", metavar="FOLDER", help="folder of drawings and mesh files")
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="folder to write")
    parser.add_argument(
        "--jobs", metavar="N", type=inputs.positive_int, default=1, help="processes (1)"
    )
    parser.add_argument(
        "--dask", metavar="ADDRESS",
        help="work on the Dask cluster at this address instead, host:port of its scheduler",
    )  # fmt: skip
    parser.add_argument(
        "--grids", action="store_true", help="block grids, as by the command blocks"
    )
    parser.add_argument(
        "--to", metavar="ENDING", default=USUAL, help=f"format of the files to write ({USUAL})"
    )
    parser.add_argument(
        "--options", metavar="TEXT", type=shlex.split, default=[],
        help="options of the command for each part, in one text: --options='--search 5'",
    )  # fmt: skip


def run(arguments: argparse.Namespace, report: Report) -> int | None:
    """Find the parts, carry out those that are not done yet, write the table."""
    from meshwright.cli.batches.table import BatchTable, signature

    began = time.perf_counter()
    source = Path(arguments.folder)
    if not source.is_dir():
        raise UserError(f"{source}: there is no such folder")
    command = "blocks" if arguments.grids else "improve"
    ending = _ending(arguments.to, arguments.grids)
    folder = checked_folder(arguments.output)
    _check_options(command, arguments.options, ending)
    parts = _parts(source)
    if not parts:
        raise UserError(f"{source}: there is no drawing and no mesh file in this folder")
    folder.mkdir(exist_ok=True)
    done = BatchTable(folder)
    names = _outputs(parts, ending)
    signed = {part.name: signature(part, [command, ending, *arguments.options]) for part in parts}
    tasks = [
        (part.name, [command, str(part.absolute()), "-o", str((folder / name).absolute()),
                     *arguments.options])
        for part, name in zip(parts, names, strict=True)
        if not done.has(part.name, signed[part.name])
    ]  # fmt: skip
    _carry_out(arguments, report, tasks, done, signed)
    files = done.write([part.name for part in parts])
    values = _values(arguments, done, parts, len(tasks), files)
    values["seconds"] = round(time.perf_counter() - began, 3)
    report.result(values, _text(values))
    return None


def _carry_out(
    arguments: argparse.Namespace, report: Report, tasks: list[tuple[str, list[str]]],
    done: BatchTable, signed: dict[str, str],
) -> None:  # fmt: skip
    from meshwright.cli.batches.workers import run_on_workers

    if arguments.dask is not None:
        from meshwright.cli.batches.cluster import run_on_cluster

        results = run_on_cluster(tasks, arguments.dask)
    else:
        results = run_on_workers(tasks, arguments.jobs)
    with report.progress("working", len(tasks)) as update:
        for number, (name, record) in enumerate(results, start=1):
            done.add(name, signed[name], record)
            update(number, f"{name}: {record['status']}")


def _ending(word: str, grids: bool) -> str:
    """The ending, or file name, to write; refused before the work begins."""
    from meshwright_core.errors import MeshError
    from meshwright_core.io import formats
    from meshwright_core.io.grids import block_files

    ending = word if word.startswith(".") else f".{word}"
    try:
        if grids:
            block_files.check_format(f"part{ending}")
        else:
            formats.of(f"part{ending}", written=True)
    except MeshError as error:
        raise UserError(f"--to {word}: {str(error).rstrip('.')}") from error
    return ending


def _check_options(command: str, options: list[str], ending: str) -> None:
    """Raise UserError for options that the command does not know."""
    from meshwright.cli import build_parser

    build_parser().parse_args([command, "part", "-o", f"part{ending}", *options])


def _parts(source: Path) -> list[Path]:
    """The files of a folder that are drawings or meshes, by name."""
    from meshwright_core.io import formats

    known = {*formats.FORMATS, *formats.SHAPES}
    return sorted(
        path for path in source.iterdir() if path.is_file() and path.suffix.lower() in known
    )


def _outputs(parts: list[Path], ending: str) -> list[str]:
    """A file name for each part; parts that differ in their ending only keep it."""
    stems = [part.stem for part in parts]
    return [(part.stem if stems.count(part.stem) == 1 else part.name) + ending for part in parts]


def _values(
    arguments: argparse.Namespace, done: BatchTable, parts: list[Path], worked: int,
    files: list[Path],
) -> dict[str, Any]:  # fmt: skip
    records = [done.records[part.name] for part in parts]
    states = [record["status"] for record in records]
    return {
        "command": "batch",
        "folder": arguments.folder,
        "output": arguments.output,
        "parts": len(parts),
        "done": states.count("done"),
        "inverted": states.count("inverted"),
        "failed": states.count("failed"),
        "skipped": len(parts) - worked,
        "at_optimum": sum(bool(record.get("at_optimum")) for record in records),
        "errors": {
            record["file"]: record.get("error", "") for record in records
            if record["status"] == "failed"
        },
        "tables": [str(file) for file in files],
    }  # fmt: skip


def _text(values: dict[str, Any]) -> str:
    rows: list[tuple[str, object]] = [
        ("parts", f"{values['parts']:,}, of which {values['skipped']:,} were done before"),
        ("done", f"{values['done']:,}, {values['at_optimum']:,} at the optimum"),
        ("inverted", values["inverted"] or "none"),
        ("failed", values["failed"] or "none"),
        *((f"  {name}", error) for name, error in values["errors"].items()),
        ("seconds", f"{values['seconds']:.1f}"),
    ]
    return f"{values['folder']} -> {', '.join(values['tables'])}\n" + table(rows)
