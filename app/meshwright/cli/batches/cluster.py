"""A batch on a Dask cluster, whose workers see the same folders under the same names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from meshwright.cli.batches.one_part import run_part
from meshwright.cli.batches.workers import Task
from meshwright.console import UserError

TRIES = 3
CONNECTING = "20s"


def run_on_cluster(tasks: Sequence[Task], address: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield (key, record) of each task as soon as it is there, in any order.

    Parts of a worker that ends are given to others. Raises UserError if the package dask is
    missing, or there is no cluster at the address.
    """
    try:
        from dask.distributed import Client, as_completed
    except ImportError as error:
        raise UserError(
            "--dask needs the package dask, which is not installed "
            "(pip install 'dask[distributed]')"
        ) from error
    try:
        client = Client(address, timeout=CONNECTING)
    except (OSError, ValueError) as error:
        raise UserError(f"--dask {address}: there is no cluster ({error})") from error
    with client:
        keys, futures = {}, []
        for key, words in tasks:
            futures.append(client.submit(run_part, list(words), pure=False, retries=TRIES))
            keys[futures[-1].key] = key
        finished = as_completed(futures)
        # a record that is still held by its worker would be computed again when that ends
        futures.clear()
        for future in finished:
            key, failure = keys[future.key], future.exception()
            if failure is not None:
                record = {"status": "failed", "error": f"{type(failure).__name__}: {failure}"}
            else:
                record = future.result()
            future.release()
            yield key, record
