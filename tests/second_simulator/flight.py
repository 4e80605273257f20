"""One flight of the second simulator, from standing on the ground to standing there again."""

import math

import numpy as np

from pilot import HAND_TICKS, Pilot, corridor

COLUMNS = (
    "time", "north", "east", "down", "roll", "pitch", "heading", "tilt", "knots", "power_kw", "rpm",
    "stick_aft", "stick_right", "pedal_right", "lever", "collective", "wheels",
)  # fmt: skip
HEADING_RAD = math.radians(270)


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
                tick / 250, *seen.position, seen.phi, seen.theta, seen.psi, seen.tilt, sim["knots"],
                sim.power_w() / 1e3, seen.rotor * 30 / math.pi, sim["stick_aft"], sim["stick_right"],
                sim["pedal_right"], sim["lever"], sim["collective_r"], sum(seen.legs),
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
    lifted = np.nonzero(record["down"] < -4.0)[0]
    first = lifted[0] if len(lifted) else 0
    landing = next((time for time, name in pilot.log if name == "landing"), record["time"][-1])
    on_the_way = (record["time"] >= record["time"][first]) & (record["time"] < landing)
    # From lift-off the wheels may touch again only once: to stay.
    after = np.nonzero(record["wheels"][first:])[0]
    bounced = len(after) and not record["wheels"][first + after[0] :][250:].all()
    return {
        "done": pilot.done and pilot.gave_up is None and pilot.at == len(pilot.phases),
        "phases": len(pilot.log),
        "touched": bool(record["wheels"][on_the_way].any()),
        "bounced": bool(bounced),
        "off_m": math.hypot(record["north"][-1], record["east"][-1]),
        "took_s": record["time"][-1],
        "gave_up": pilot.gave_up,
    }
