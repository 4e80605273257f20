"""One flight of the second simulator, from standing on the ground to standing there again."""

import math

import numpy as np

from pilot import HAND_TICKS, Pilot, corridor

COLUMNS = (
    "time", "north", "east", "down", "roll", "pitch", "heading", "tilt", "knots", "power_kw", "rpm",
    "stick_aft", "stick_right", "pedal_right", "lever", "collective", "wheels",
)  # fmt: skip
HEADING_RAD = math.radians(270)
# Higher than at touchdown is a bounce.
BOUNCE_M = 0.3


def fly(sim, data, pitched=False, longest_s=400.0):
    """Flies the task; returns the record, fifty times a second, and the pilot."""
    for name, value in sim.begin.items():
        sim.fdm[name] = value
    sim["flap_lever"], sim["gear_lever"], sim["rpm_lever"] = 40.0, 1.0, 589.0
    sim.place((0.0, 0.0, 0.0), (0.0, 0.0, HEADING_RAD), height_m=2.2)
    sim.settle()
    sim["running"] = 1.0
    pilot = Pilot(sim, corridor(data), pitched)
    rows = []
    for tick in range(0, int(longest_s * 250), HAND_TICKS):
        seen = pilot.act(tick / 250)
        rows.append(
            (
                tick / 250,
                *seen.position,
                seen.phi,
                seen.theta,
                seen.psi,
                seen.tilt,
                sim["knots"],
                sim.power_w() / 1e3,
                seen.rotor * 30 / math.pi,
                sim["stick_aft"],
                sim["stick_right"],
                sim["pedal_right"],
                sim["lever"],
                sim["collective_r"],
                sum(seen.legs),
            )  # fmt: skip
        )
        if pilot.done or not math.isfinite(seen.height) or seen.height < 0.5 or abs(seen.phi) > 1.5:
            break
        for _ in range(HAND_TICKS):
            sim.fdm.run()
    record = np.array(rows)
    return {name: record[:, i] for i, name in enumerate(COLUMNS)}, pilot


def summary(record, pilot):
    """What is promised of a flight: does it land where it began, without touching the ground on the way?"""
    time, wheels, height = record["time"], record["wheels"] > 0, -record["down"]
    # Lift-off: the first moment without a wheel on the ground. Touchdown: the first with one while landing.
    landing = next((begun for begun, name in pilot.log if name == "landing"), math.inf)
    free = np.nonzero(~wheels & (time > 1.0))[0]
    down = np.nonzero(wheels & (time >= landing))[0]
    lift_off = free[0] if len(free) else 0
    touchdown = down[0] if len(down) else len(time)
    return {
        "done": pilot.done and pilot.gave_up is None and pilot.at == len(pilot.phases),
        "phases": len(pilot.log),
        "touched": bool(wheels[lift_off:touchdown].any()),
        "bounced": bool((height[touchdown:] > height[touchdown - 1] + BOUNCE_M).any()),
        "off_m": math.hypot(record["north"][-1], record["east"][-1]),
        "took_s": record["time"][-1],
        "gave_up": pilot.gave_up,
    }
