"""The randomized extreme sweep: is an answer ever wrong silently?

``python benchmarks/reliability.py [--seed 1] [--count 300] [--out DIR]`` prints a
table; the same call goes on where it was stopped. Scenes and verdicts stand in
tests/robustness/extreme_scenes.py.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

import numpy as np

import iga_membrane as iga

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from robustness.extreme_scenes import KINDS, Hypercube, extreme_scenes, score

LIMIT = 120.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--out", default="reliability")
    given = parser.parse_args()
    scenes = extreme_scenes(given.seed, given.count)
    found = iga.sweep(
        Hypercube(given.seed, given.count),
        {"index": range(len(scenes))},
        out=Path(given.out) / f"seed{given.seed}",
        workers=given.workers,
        timeout=10 * LIMIT,
        options=iga.SolverOptions(max_cpu_s=LIMIT),
    )
    report(scenes, found)


def report(scenes: list, found: iga.Sweep) -> None:
    """Print the table by kinds, every case that is not solved, and the five numbers."""
    rows: dict[str, Counter] = {name: Counter() for name in KINDS}
    worst: dict[str, float] = dict.fromkeys(KINDS, 0.0)
    seconds, trouble, known, solved = [], [], 0, 0
    for extreme, record in zip(scenes, found.records, strict=True):
        end, error = score(extreme, record)
        rows[extreme.kind][end] += 1
        worst[extreme.kind] = max(worst[extreme.kind], error or 0.0)
        result = record.get("result", {})
        seconds.append(result.get("cpu_seconds", {}).get("solve", 0.0))
        exists = extreme.exists()
        known += exists is True
        solved += exists is True and end == "solved"
        if end in ("wrong", "crashed") or (exists is True and end != "solved"):
            numbers = {name: f"{value:.4g}" for name, value in extreme.parameters.items()}
            said = result.get("status", ""), result.get("message", record.get("error", ""))
            trouble.append((extreme.kind, end, numbers, *said, error, seconds[-1]))
    ends = ("solved", "failed", "refused", "wrong", "crashed")
    print("| kind | scenes | " + " | ".join(ends) + " | largest error of a success |")
    print("|---" * 8 + "|")
    for name, counts in rows.items():
        cells = [str(counts[end]) for end in ends]
        print(f"| {name} | {sum(counts.values())} | {' | '.join(cells)} | {worst[name]:.1e} |")
    total = sum(rows.values(), Counter())
    print(f"\n{len(scenes)} scenes: {dict(total)}")
    print(f"of {known} with a known equilibrium {solved} solved: {100 * solved / known:.1f} %")
    print(
        f"CPU s of a solve: median {np.median(seconds):.2f}, "
        f"95 % {np.percentile(seconds, 95):.1f}, largest {max(seconds):.0f}, "
        f"sum {sum(seconds):.0f}\n"
    )
    for row in trouble:
        print(*row, sep=" | ")


if __name__ == "__main__":
    main()
