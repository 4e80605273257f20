"""The published tables and numbers, as aircraft/xv15.toml quotes them with their sources."""

import tomllib
from pathlib import Path

FLAPS_DEG = (0.0, 20.0, 40.0, 75.0)


class Published:
    """Reads by path: `number("rotors.radius_ft")`, `table("fuselage.lift_ft2")`."""

    def __init__(self, file):
        self.tree = tomllib.loads(Path(file).read_text())

    def node(self, path):
        """What stands at a path."""
        at = self.tree
        for key in path.split("."):
            at = at[key]
        return at

    def number(self, path):
        """A number, or a list of them, in the unit that the key's name ends with."""
        return self.node(path)["value"]

    def line(self, path):
        """The one axis and the values of a table."""
        node = self.node(path)
        axis = next(key for key in node if key not in ("value", "source", "trust", "note"))
        return node[axis], node["value"]

    def grid(self, path, *axes):
        """The named axes and the values of a table."""
        node = self.node(path)
        return [node[axis] for axis in axes], node["value"]


def at(xs, ys, x):
    """Linear between the points, held at the ends."""
    if x <= xs[0]:
        return ys[0]
    for x0, x1, y0, y1 in zip(xs, xs[1:], ys, ys[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return ys[-1]


def polar(data, path):
    """A wing's coefficient over mast tilt, angle of attack and flap, on the union of the printed angles.

    The aeroplane's columns end at 40 deg or before; beyond them stand the helicopter's, which go all round.
    """
    lines = {}
    for tilt in ("upright", "aeroplane"):
        for flap in FLAPS_DEG:
            lines[tilt, flap] = data.line(f"{path}.{tilt}.flap_{flap:.0f}")
    angles = sorted({x for xs, _ in lines.values() for x in xs})

    def value(tilt, flap, x):
        xs, ys = lines[tilt, flap]
        if not xs[0] <= x <= xs[-1]:
            xs, ys = lines["upright", flap]
        return at(xs, ys, x)

    values = [
        [[value(tilt, flap, x) for flap in FLAPS_DEG] for x in angles] for tilt in ("upright", "aeroplane")
    ]
    return [[0.0, 90.0], angles, list(FLAPS_DEG)], values


def fin(data):
    """The fins' side force over sideslip and rudder, all round."""
    (betas, rudders), values = data.grid("vertical_stabilizers.side_force", "beta_deg", "rudder_deg")
    mirrored = [(-b, [-y for y in reversed(row)]) for b, row in zip(betas, values) if b < 0]
    rows = sorted(list(zip(betas, values)) + mirrored)
    return [[b for b, _ in rows], rudders], [row for _, row in rows]
