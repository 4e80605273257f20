"""Recorded inputs flown by the second simulator from recorded states, and how the difference grows.

Stick, pedals, lever and nacelle switch are the demonstration's; augmentation, governor and engines are the second
simulator's own, and begin with what the log has of them. The two rotors' collectives have different zeros: what
the second one begins with is the collective at which its rotors take the recorded power, which is what its governor
would hold. `matched` adds the force and moment that are missing at the beginning, and holds them.
"""

import math

import numpy as np

from limits import WINDOW_S, WINDOWS
from model import FOOT_M

INCH_M = 0.0254


def starts(phases):
    """Names and times of the windows."""
    seen = {}
    for name, after in WINDOWS:
        found = [time for time, phase in phases if phase == name]
        if name == "hover" and after == 0.0:
            found = found[1:]
        if found:
            number = seen[name] = seen.get(name, 0) + 1
            yield (
                (f"{name} {number}" if sum(each == name for each, _ in WINDOWS) > 1 else name),
                found[0] + after,
            )


def begin(sim, outputs, state, row, tick):
    """The recorded state, as far as the second simulator has the same."""
    o = {name: values[row] for name, values in outputs.items()}
    s = {name: values[tick] for name, values in state.items()}
    for name, value in sim.begin.items():
        sim.fdm[name] = value
    deg = math.degrees
    sim["tilt"] = deg(o["actuators_mast_tilt_rad_left"])
    sim["flap"] = sim["flap_lever"] = deg(o["actuators_flap_rad"])
    sim["gear"] = sim["gear_lever"] = o["actuators_gear_extension_norm"]
    sim["rotor_radps"] = o["rotor_speed_radps"]
    sim["rpm_wanted"] = sim["rpm_lever"] = s["fcc_governor_reference_radps"] * 30 / math.pi
    sim["power_norm"] = (o["engines_power_w_left"] + o["engines_power_w_right"]) / sim.rated_w
    for mine, theirs in (("aft", "aft"), ("right", "right"), ("pedal", "pedal_right")):
        sim["mean_" + mine] = s[f"fcc_scas_mean_{theirs}_m"] / INCH_M
    sim["held_aft"], sim["held_right"] = s["fcc_scas_held_pitch_rad"], s["fcc_scas_held_roll_rad"]
    for side in ("left", "right"):
        sim["cyclic_" + side[0]] = deg(o[f"actuators_cyclic_forward_rad_{side}"])
    sim["elevator"], sim["rudder"] = deg(o["actuators_elevator_rad"]), deg(o["actuators_rudder_right_rad"])
    inputs(sim, state, tick)
    half = 0.5 * deg(o["actuators_collective_rad_left"] - o["actuators_collective_rad_right"])
    body = [o[f"body_velocity_mps_{axis}"] for axis in "xyz"]
    euler = [o[f"euler_{name}_rad"] for name in ("roll", "pitch", "heading")]
    rates = [o[f"angular_rate_radps_{axis}"] for axis in "xyz"]
    wanted = o["rotors_left_power_w"] + o["rotors_right_power_w"]

    def off(mean):
        sim["collective_l"], sim["collective_r"] = mean + half, mean - half
        sim.place(body, euler, rates, height_m=o["height_above_ground_m"])
        sim.settle(60)
        sim["flaperon"] = max(-23.8, min(13.8, 3.9 * sim["xv/augmented-right"]))
        return sim.power_w() - wanted

    low, high = deg(0.5 * (o["actuators_collective_rad_left"] + o["actuators_collective_rad_right"])), None
    low, high = low - 6.0, low + 18.0
    for _ in range(22):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if off(middle) < 0 else (low, middle)
    correction = middle - (sim["xv/pitch-both"] - sim["correction"])
    sim["correction"] = correction
    sim["integral"] = correction - sim["xv/k-p"] * sim["xv/rpm-off"]
    return o, s, body, euler, rates


def inputs(sim, state, tick):
    """The recorded hands of a tick."""
    for mine, theirs in (
        ("stick_aft", "stick_aft_norm"), ("stick_right", "stick_right_norm"), ("pedal_right", "pedal_right_norm"),
        ("lever", "collective_norm"), ("nacelle_aft", "nacelle_aft_norm"),
    ):  # fmt: skip
        sim[mine] = state["cockpit_" + theirs][tick]


def match(sim, o, s, body, euler, rates):
    """Adds what is missing of the recorded acceleration, force first, moment after it."""
    f = sim.fdm
    slugs = f["inertia/weight-lbs"] / 32.174

    def again():
        sim.place(body, euler, rates, height_m=o["height_above_ground_m"])
        sim.settle(60)

    felt = [f[f"forces/fb{axis}-total-lbs"] / slugs * FOOT_M for axis in "xyz"]
    for axis, mine in zip("xyz", felt):
        sim["given_" + axis] = slugs * (o[f"specific_force_mps2_{axis}"] - mine) / FOOT_M
    again()
    turning = sim.accelerations()[3:]
    for name, axis, mine, inertia in zip(("roll", "pitch", "yaw"), "xyz", turning, ("ixx", "iyy", "izz")):
        missing = s[f"rate_motion_angular_acceleration_radps2_{axis}"] - mine
        sim["given_" + name] = f[f"inertia/{inertia}-slugs_ft2"] * missing
    again()


def fly(sim, outputs, state, row, matched):
    """The difference of attitude in deg, and of velocity in m/s, every 40 ms of the window."""
    tick = int(outputs["tick"][row])
    o, s, body, euler, rates = begin(sim, outputs, state, row, tick)
    if matched:
        match(sim, o, s, body, euler, rates)
    sim["running"] = 1.0
    differences = [(0.0, 0.0, 0.0)]
    for step in range(1, int(WINDOW_S * 250) + 1):
        inputs(sim, state, tick + step - 1)
        sim.fdm.run()
        if step % 10 == 0 and row + step // 10 < len(outputs["tick"]):
            at = row + step // 10
            mine = [sim.fdm[f"attitude/{name}-rad"] for name in ("phi", "theta", "psi")]
            theirs = [outputs[f"euler_{name}_rad"][at] for name in ("roll", "pitch", "heading")]
            turn = [(a - b + math.pi) % (2 * math.pi) - math.pi for a, b in zip(mine, theirs)]
            speed = [
                sim.fdm[f"velocities/v-{name}-fps"] * FOOT_M - outputs[f"velocity_mps_{axis}"][at]
                for name, axis in (("north", "x"), ("east", "y"), ("down", "z"))
            ]
            differences.append((step / 250, math.degrees(math.hypot(*turn)), math.hypot(*speed)))
    return np.array(differences)


def compare(sim, outputs, state, phases):
    """Every window, as it begins and matched."""
    found = []
    for name, time in starts(phases):
        row = int(np.searchsorted(outputs["time_s"], time))
        found.append((name, time, fly(sim, outputs, state, row, False), fly(sim, outputs, state, row, True)))
    return found
