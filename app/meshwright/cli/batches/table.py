"""The table of a batch: one record for each part, kept while it runs, as CSV and JSON at the end.

Each record is appended to a log as soon as it is there. A later run skips the parts that are in it
with the same input and options and whose output still exists.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from meshwright.console import as_json
from meshwright_core.io.atomic_write import replacing

LOG, CSV, JSON = "batch.log.jsonl", "batch.csv", "batch.json"

COLUMNS = (
    "file", "status", "output", "error", "score_before", "score", "optimum", "at_optimum",
    "elements", "blocks", "chords", "cells", "worst_scaled_jacobian", "inverted_elements",
    "worst_aspect_ratio", "non_orthogonality", "growth", "area", "seconds",
)  # fmt: skip
"""Of the CSV table; the JSON has everything."""


def signature(path: Path, words: Sequence[str]) -> str:
    """A hash of the content of an input file and of the options."""
    digest = hashlib.sha256(json.dumps(list(words)).encode())
    try:
        digest.update(path.read_bytes())
    except OSError:
        digest.update(b"unreadable")
    return digest.hexdigest()[:24]


class BatchTable:
    """The records of a batch in its output folder."""

    def __init__(self, folder: Path) -> None:
        """Read the log of an earlier run, if there is one; lines that are cut off are left out."""
        self.folder = folder
        self.records: dict[str, dict[str, Any]] = {}
        log = folder / LOG
        text = log.read_text(encoding="utf-8") if log.exists() else ""
        for line in text.splitlines():
            try:
                record = json.loads(line)
                self.records[record["file"]] = record
            except (ValueError, TypeError, KeyError):
                continue
        if text and not text.endswith("\n"):
            with log.open("a", encoding="utf-8") as file:
                file.write("\n")

    def has(self, file: str, signed: str) -> bool:
        """Whether the part is done already, with the same input and options."""
        record = self.records.get(file, {})
        if record.get("signature") != signed or record.get("status") not in ("done", "inverted"):
            return False
        return Path(str(record.get("output"))).exists()

    def add(self, file: str, signed: str, record: dict[str, Any]) -> dict[str, Any]:
        """Append a record to the log."""
        score = record.get("score", record.get("score_after"))
        whole = {**record, "file": file, "signature": signed, "score": score}
        self.records[file] = whole
        with (self.folder / LOG).open("a", encoding="utf-8") as log:
            log.write(as_json(whole) + "\n")
        return whole

    def write(self, files: Sequence[str]) -> list[Path]:
        """Write both tables, with the parts in this order."""
        rows = [self.records[file] for file in files if file in self.records]
        text = io.StringIO()
        writer = csv.DictWriter(text, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        content = {CSV: text.getvalue(), JSON: as_json({"parts": rows}) + "\n"}
        for name, whole in content.items():
            with replacing(self.folder / name) as temporary:
                temporary.write_text(whole, encoding="utf-8")
        return [self.folder / name for name in content]
