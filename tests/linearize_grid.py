"""Linearises over a grid of nacelle incidence and speed, and compares eigenvalues with numpy's.

Every point must end with 0, write the matrices, print no number that is none, and find the eigenvalues
that `numpy.linalg.eigvals` (LAPACK) finds of A, each within 1e-6 of max(1, |eigenvalue|).

Usage: linearize_grid.py TILTROTOR
"""

import csv
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

# Nacelle incidence in deg, and the speeds in kt at which the XV-15 trims at 13,000 lb at sea level.
GRID = {
    90: range(0, 121, 10),
    75: range(0, 131, 10),
    60: range(0, 151, 10),
    30: range(100, 191, 10),
    0: range(120, 251, 10),
}
SCAS = [[], ["--scas"]]

TOLERANCE = 1e-6


def tables(path):
    """A, and the eigenvalues, of a file that `linearize --csv` wrote."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    numbers = [(row["row"], row["column"], float(row["value"])) for row in rows if row["matrix"] == "A"]
    names = list(dict.fromkeys(row for row, _, _ in numbers))
    place = {name: i for i, name in enumerate(names)}
    a = numpy.full((len(names), len(names)), numpy.nan)
    for row, column, value in numbers:
        a[place[row], place[column]] = value
    parts = {}
    for row in rows:
        if row["matrix"] == "eigenvalue":
            parts.setdefault(int(row["row"]), {})[row["column"]] = float(row["value"])
    return a, [complex(part["re_per_s"], part["im_radps"]) for _, part in sorted(parts.items())]


def furthest(ours, theirs):
    """The largest distance between eigenvalues, each of ours with the nearest of theirs that is left."""
    left, worst = list(theirs), 0.0
    for value in ours:
        nearest = min(range(len(left)), key=lambda i: abs(left[i] - value))
        worst = max(worst, abs(left.pop(nearest) - value) / max(1.0, abs(value)))
    return worst


def check(tiltrotor, flight, path):
    """How far the furthest eigenvalue is from numpy's, or what is wrong."""
    done = subprocess.run(
        [tiltrotor, "linearize", *flight, "--fast", "--response", "--matrices", "--csv", str(path)],
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        return f"exit {done.returncode}: {done.stderr.strip()}"
    if re.search(r"\b(nan|inf)\b", done.stdout, re.IGNORECASE):
        return "a number that is none is printed"
    a, ours = tables(path)
    if len(a) == 0 or len(ours) != len(a):
        return f"{len(ours)} eigenvalues of {len(a)} states"
    if not numpy.isfinite(a).all() or not numpy.isfinite(ours).all():
        return "a number that is none is written"
    off = furthest(ours, numpy.linalg.eigvals(a))
    return off if off <= TOLERANCE else f"an eigenvalue is {off:.1e} from numpy's"


def main():
    flights = [
        ["--nacelle", str(nacelle), "--speed-kt", str(speed), *scas]
        for nacelle, speeds in GRID.items()
        for speed in speeds
        for scas in SCAS
    ]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        paths = [Path(folder, f"{i}.csv") for i in range(len(flights))]
        found = list(pool.map(lambda work: check(sys.argv[1], *work), zip(flights, paths)))
    wrong = 0
    worst = (0.0, "no flight")
    for flight, result in zip(map(" ".join, flights), found):
        if isinstance(result, str):
            print(f"WRONG {flight}: {result}")
            wrong += 1
        else:
            worst = max(worst, (result, flight))
    print(
        f"{len(flights)} steady flights linearised, {wrong} wrong; furthest from numpy "
        f"{numpy.__version__}: {worst[0]:.1e} at {worst[1]}"
    )
    sys.exit(1 if wrong else 0)


main()
