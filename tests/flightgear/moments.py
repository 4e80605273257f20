#!/usr/bin/env python3
"""When a demonstration flight does what: the time of a moment, s, from the log's outputs as lines of JSON.

Usage: tiltrotor log cat LOG --channel outputs --every 25 | moments.py
Prints a line each: name and time of hover, conversion, aeroplane, landing.
"""
import json
import math
import sys


def main():
    rows = []
    for line in sys.stdin:
        message = json.loads(line)
        if message["topic"] == "/outputs":
            tilt_deg = math.degrees(message["actuators.mast_tilt_rad.left"])
            rows.append((message["time_ns"] * 1e-9, message["height_above_ground_m"], tilt_deg,
                         abs(math.degrees(message["euler.roll_rad"]))))
    top = max(height for _, height, _, _ in rows)
    forward = next(t for t, _, tilt, _ in rows if tilt > 89)
    back = max(t for t, _, tilt, _ in rows if tilt > 89)
    moments = {
        # Risen, and the nacelles still upright.
        "hover": max(t for t, height, tilt, _ in rows if t < forward and height < 14 and tilt < 2),
        "conversion": next(t for t, _, tilt, _ in rows if tilt > 45),
        # In the turn, which is flown as an aeroplane.
        "aeroplane": max((roll, t) for t, _, tilt, roll in rows if forward < t < back)[1],
        "landing": max(t for t, height, _, _ in rows if t > back and height > 5),
    }
    assert top > 50 and list(moments.values()) == sorted(moments.values()), moments
    for name, time_s in moments.items():
        print(f"{name} {time_s:.2f}")


if __name__ == "__main__":
    main()
