"""Steady flight and small motions of the second simulator."""

import math

import numpy as np

from model import FOOT_M, KNOT_MPS


def airborne(sim, case):
    """Masts, flaps and rotor speed of a case."""
    for name in ("stick_aft", "stick_right", "pedal_right", "nacelle_aft"):
        sim[name] = 0.0
    for name in ("x", "y", "z", "roll", "pitch", "yaw"):
        sim["given_" + name] = 0.0
    sim["scas_on"] = 0.0
    sim["tilt"] = 90.0 - case["nacelle_deg"]
    sim["flap"] = sim["flap_lever"] = case["flap_deg"]
    sim["gear"] = sim["gear_lever"] = 0.0
    sim["rotor_radps"] = case["rpm"] * math.pi / 30


def put(sim, case, pitch, collective, stick_in, motion=(0, 0, 0), rates=(0, 0, 0), roll=0.0):
    """Flies there for no time; stick forward in, motion a change of u, v and w in ft/s."""
    speed = case["speed_kt"] * KNOT_MPS / FOOT_M
    sim["collective_r"] = sim["collective_l"] = collective
    sim["cyclic_r"] = sim["cyclic_l"] = sim["xv/cyclic-per-stick"] * stick_in
    sim["elevator"] = max(-20.0, min(20.0, 4.735 * stick_in))
    sim["flaperon"] = sim["rudder"] = 0.0
    alpha = math.radians(case.get("pitch_for_motion", pitch))
    body = np.array([speed * math.cos(alpha), 0.0, speed * math.sin(alpha)]) + motion
    sim.place(body * FOOT_M, (roll, math.radians(pitch), 0.0), rates, height_m=30.0, ground_m=-500.0)
    sim.settle()
    return np.array(sim.accelerations())


def trim(sim, case):
    """Pitch deg, collective deg at three quarters of the radius, stick in forward, power W."""
    airborne(sim, case)
    sim.place((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), height_m=30.0, ground_m=-500.0)
    sim.settle(3)  # the gearing at these masts is known from here on
    x = np.array(case["start"], dtype=float)
    left = np.inf
    for _ in range(40):
        put(sim, case, *x)
        sim["power_norm"] = sim.power_w() / sim.rated_w  # the engines' jets go with it
        off = put(sim, case, *x)[[0, 2, 4]] * [1, 1, 10]
        left = np.abs(off).max()
        if left < 1e-5:
            break
        slope = np.empty((3, 3))
        for k in range(3):
            y = x.copy()
            y[k] += 0.02
            slope[:, k] = (put(sim, case, *y)[[0, 2, 4]] * [1, 1, 10] - off) / 0.02
        move = np.linalg.solve(slope, -off)
        x = x + move * min(1.0, 3.0 / np.abs(move).max())
    put(sim, case, *x)
    return {
        "pitch_deg": x[0], "collective_deg": x[1], "stick_in": 4.8 + x[2], "power_kw": sim.power_w() / 1e3,
        "thrust_lbf": sim["thrust_r"], "download_lbf": sim["download"], "left": left, "x": x,
    }  # fmt: skip


def modes(sim, case, found):
    """Eigenvalues of the rigid body, the rotors' speed and all controls held, inflow and downwash at rest."""
    airborne(sim, case)
    pitch, collective, stick = found["x"]
    theta = math.radians(pitch)
    still = dict(case, pitch_for_motion=pitch)

    def rate(x):
        u, v, w, p, q, r, phi, the = x
        acc = put(
            sim,
            still,
            pitch + math.degrees(the),
            collective,
            stick,
            motion=(u, v, w),
            rates=(p, q, r),
            roll=phi,
        )
        yawing = q * math.sin(phi) + r * math.cos(phi)
        turning = [p + math.tan(theta + the) * yawing, q * math.cos(phi) - r * math.sin(phi)]
        return np.concatenate([acc, turning])

    steps = np.array([1.0, 1.0, 1.0, 0.02, 0.02, 0.02, 0.01, 0.01])
    a = np.empty((8, 8))
    for k in range(8):
        d = np.zeros(8)
        d[k] = steps[k]
        a[:, k] = (rate(d) - rate(-d)) / (2 * steps[k])
    along, side = [0, 2, 4, 7], [1, 3, 5, 6]
    return np.linalg.eigvals(a[np.ix_(along, along)]), np.linalg.eigvals(a[np.ix_(side, side)])
