"""Linearises over a grid of nacelle incidence and speed, and compares eigenvalues with numpy's.

What does not trim is counted and left out (exit status 5 of `trim` and of `linearize`, both). Of every
other point `linearize` must end with 0, write the matrices, and find the eigenvalues that
`numpy.linalg.eigvals` (LAPACK) finds of A, each within 1e-6 of max(1, |eigenvalue|).

Usage: linearize_grid.py TILTROTOR
"""

import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

NACELLES_DEG = [90, 75, 60, 30, 0]
SPEEDS_KT = range(0, 260, 10)
SCAS = [[], ["--scas"]]

# The matrices are known to about that: central differences over steps of 1e-5.
TOLERANCE = 1e-6
# Of the 260 points 137 trim today; a model that trims much less has another fault.
POINTS_MIN = 100
NO_TRIM = 5


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


def main():
    tiltrotor = sys.argv[1]
    solved, untrimmed, worst, wrong = 0, 0, (0.0, ""), []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "linear.csv")
        for nacelle in NACELLES_DEG:
            for speed in SPEEDS_KT:
                for scas in SCAS:
                    flight = ["--nacelle", str(nacelle), "--speed-kt", str(speed), *scas]
                    name = " ".join(flight)
                    path.unlink(missing_ok=True)
                    done = subprocess.run(
                        [tiltrotor, "linearize", *flight, "--fast", "--matrices", "--csv", str(path)],
                        capture_output=True,
                        text=True,
                    )
                    if done.returncode == NO_TRIM and "no steady flight" in done.stderr:
                        trim = subprocess.run([tiltrotor, "trim", *flight], capture_output=True)
                        if trim.returncode == NO_TRIM:
                            untrimmed += 1
                        else:
                            wrong.append(f"{name}: trims, but is not linearised")
                        continue
                    if done.returncode != 0:
                        wrong.append(f"{name}: exit {done.returncode}: {done.stderr.strip()}")
                        continue
                    solved += 1
                    if re.search(r"\b(nan|inf)\b", done.stdout, re.IGNORECASE):
                        wrong.append(f"{name}: a number that is none is printed")
                    a, ours = tables(path)
                    if not numpy.isfinite(a).all() or not numpy.isfinite(ours).all():
                        wrong.append(f"{name}: a number that is none is written")
                        continue
                    if len(ours) != len(a):
                        wrong.append(f"{name}: {len(ours)} eigenvalues of {len(a)}")
                        continue
                    off = furthest(ours, numpy.linalg.eigvals(a))
                    worst = max(worst, (off, name))
                    if off > TOLERANCE:
                        wrong.append(f"{name}: an eigenvalue is {off:.1e} from numpy's")
    if solved < POINTS_MIN:
        wrong.append(f"only {solved} points trim")
    for line in wrong:
        print(f"WRONG {line}")
    print(
        f"{solved} points solved, {untrimmed} without a steady flight, {len(wrong)} wrong; "
        f"furthest from numpy {numpy.__version__}: {worst[0]:.1e} at {worst[1]}"
    )
    sys.exit(1 if wrong else 0)


main()
