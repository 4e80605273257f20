#!/usr/bin/env python3
"""Looks at the pictures of tests/flightgear_pictures.sh: what they have to show is there.

Usage: look.py FOLDER MOMENT…   (FOLDER/MOMENT.png from outside, FOLDER/MOMENT_cockpit.png from the cockpit;
FOLDER/ghost.png with a second aircraft, which is amber)
"""
import itertools
import subprocess
import sys

WIDE, HIGH = 320, 180


def pixels(path):
    raw = subprocess.run(["convert", path, "-resize", f"{WIDE}x{HIGH}!", "-depth", "8", "rgb:-"],
                         check=True, capture_output=True).stdout
    assert len(raw) == 3 * WIDE * HIGH, f"{path}: {len(raw)} bytes"
    return [tuple(raw[i:i + 3]) for i in range(0, len(raw), 3)]


def near(colour, wanted, by=40):
    return all(abs(a - b) < by for a, b in zip(colour, wanted))


def count(picture, test):
    return sum(1 for colour in picture if test(colour))


def main():
    folder, moments = sys.argv[1], sys.argv[2:]
    pictures = {}
    for moment in moments:
        outside = pictures[moment] = pixels(f"{folder}/{moment}.png")
        white = count(outside, lambda c: min(c) > 190 and max(c) - min(c) < 25)
        assert white > 150, f"{moment}: {white} pixels of white paint, 150 at least"
        cockpit = pictures[moment + "_cockpit"] = pixels(f"{folder}/{moment}_cockpit.png")
        # The display's sky and ground are of colours of its own; together a twentieth of the picture.
        sky = count(cockpit, lambda c: near(c, (33, 107, 194)))
        ground = count(cockpit, lambda c: near(c, (112, 74, 36), 30))
        assert sky > 300 and ground > 300, f"{moment}: display with {sky} pixels of sky, {ground} of ground"
        print(f"{moment}: {white} pixels of white paint; on the display {sky} of sky, {ground} of ground")
    ghost = pictures["ghost"] = pixels(f"{folder}/ghost.png")
    amber = count(ghost, lambda c: c[0] > 170 and c[2] < 60 and 0.5 * c[0] < c[1] < 0.78 * c[0])
    white = count(ghost, lambda c: min(c) > 190 and max(c) - min(c) < 25)
    # The same view without the second one has none of amber.
    assert amber > 30 and white > 60, f"ghost: {amber} pixels of amber, {white} of white paint"
    print(f"ghost: {amber} pixels of amber beside {white} of white paint")
    for (a, one), (b, other) in itertools.combinations(pictures.items(), 2):
        differ = sum(1 for x, y in zip(one, other) if not near(x, y, 12))
        assert differ > WIDE * HIGH // 20, f"{a} and {b} differ in {differ} pixels only"


if __name__ == "__main__":
    main()
