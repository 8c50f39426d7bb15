"""Evaluations of policies as text: a sentence for one row, aligned tables for several."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from meshwright_core.core.kinds import KIND_NOUN

_METHODS = {
    "policy": "policy",
    "greedy": "greedy",
    "plateaus": "greedy, plateaus",
    "annealing": "annealing",
    "random_walk": "random walk",
}


def one_row(kind: str, policy: str, given: Mapping[str, Any], row: Mapping[str, Any]) -> str:
    """The row as a sentence, followed by tables of the baselines and other measurements."""
    low, high = row["sides"]
    sentence = (
        f"{KIND_NOUN[kind]}, {low}-{high} sides, {given['meshes']} meshes, "
        f"{policy}: single {row['single_mean']:.3f} (std {row['single_std']:.3f}), "
        f"best of {given['rollouts']} {row['best_mean']:.3f} (std {row['best_std']:.3f}), "
        f"at the optimum {row['at_optimum']:.0%}, {row['operations_median']:.0f} operations "
        f"(median), {row['seconds']:.1f} s"
    )
    return "\n\n".join([sentence, *_extras([row])])


def all_rows(
    kind: str, policy: str, given: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]
) -> str:
    """Our results beside the paper's, followed by tables of the other measurements."""
    head = (
        f"{KIND_NOUN[kind]}, policy {policy}, {given['meshes']} polygons a row, "
        f"seed {given['seed']}\n"
        "normalised return, mean ± standard deviation; operations: median, to the best state of\n"
        "the best run; elements: there, relative to the start; seconds: a mesh, all runs"
    )
    names = [
        "sides", "single", "paper", f"best of {given['rollouts']}", "paper", "at s*", "operations",
        "elements", "seconds",
    ]  # fmt: skip
    cells = [
        [
            _sides(row),
            _spread(row, "single"),
            _spread(row["paper"] or {}, "single", 2),
            _spread(row, "best"),
            _spread(row["paper"] or {}, "best", 2),
            f"{row['at_optimum']:.0%}",
            f"{row['operations_median']:.0f}",
            f"{row['elements_mean']:.2f}",
            f"{row['seconds_per_mesh']:.3f}",
        ]
        for row in rows
    ]
    return "\n\n".join([f"{head}\n\n{grid(names, cells)}", *_extras(rows)])


def sides(bounds: Sequence[int]) -> str:
    """A closed range of sides in words."""
    low, high = bounds
    return f"{low}-{high} sides" if low < high else f"{low} sides"


def grid(names: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    """A text table: the first column is aligned to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(names, *cells, strict=True)]
    lines = [
        "  ".join(
            text.rjust(width) if i else text.ljust(width)
            for i, (text, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in [names, *cells]
    ]
    return "\n".join([lines[0], "-" * max(map(len, lines)), *lines[1:]])


def _extras(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    parts = []
    if "baselines" in rows[0]:
        parts.append(_baselines(rows))
    if "race" in rows[0]:
        parts.append(_race(rows))
    if "polished" in rows[0]:
        parts.append(_polished(rows))
    return parts


def _baselines(rows: Sequence[Mapping[str, Any]]) -> str:
    methods = list(rows[0]["baselines"])
    names = ["sides", "seconds", *(_METHODS[method] for method in methods)]
    cells = []
    for row in rows:
        found = [row["baselines"][method] for method in methods]
        cells.append(
            [
                _sides(row),
                f"{row['seconds_per_mesh']:.3f}",
                *(
                    f"{one['mean']:.3f} ± {one['std']:.3f} {one['at_optimum']:5.0%}"
                    for one in found
                ),
            ]
        )
    title = "Without learning, in no more than the same seconds a mesh: return, share at s*"
    return f"{title}\n\n{grid(names, cells)}"


def _race(rows: Sequence[Mapping[str, Any]]) -> str:
    moments = list(next(iter(rows[0]["race"].values())))
    cells = [
        [
            _sides(row) if i == 0 else "",
            _METHODS[method],
            *(f"{shares[moment]:.0%}" for moment in moments),
        ]
        for row in rows
        for i, (method, shares) in enumerate(row["race"].items())
    ]
    names = ["sides", "method", *(f"{moment} s" for moment in moments)]
    return f"Share at s* after so many seconds a mesh, one core\n\n{grid(names, cells)}"


def _polished(rows: Sequence[Mapping[str, Any]]) -> str:
    columns = ["operations", "and clean-ups", "elements"]
    names = ["sides", "meshes", *columns, f"coarse: {columns[0]}", *columns[1:]]
    cells = []
    for row in rows:
        found = row["polished"]
        cells.append([_sides(row), str(found["meshes"])])
        for state in ("", "coarse_"):
            decisions = found[f"{state}decisions_median"]
            added = found[f"{state}operations_median"] - decisions
            elements = found[f"{state}elements_mean"]
            cells[-1] += [f"{decisions:g}", f"{added:g}", f"{elements:.2f}"]
    title = (
        "Solutions at s*, shortened, and the same coarsened: operations and clean-ups (medians),\n"
        "elements relative to the start (mean)"
    )
    return f"{title}\n\n{grid(names, cells)}"


def _sides(row: Mapping[str, Any]) -> str:
    return sides(row["sides"]).removesuffix(" sides")


def _spread(numbers: Mapping[str, Any], name: str, digits: int = 3) -> str:
    if f"{name}_mean" not in numbers:
        return ""
    mean, deviation = numbers[f"{name}_mean"], numbers[f"{name}_std"]
    # the paper gives one of its means with three digits
    shown = f"{mean:.{digits}f}" if round(mean, digits) == mean or digits > 2 else f"{mean:g}"
    return f"{shown} ± {deviation:.{digits}f}"
