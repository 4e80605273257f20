"""A pilot for the second simulator, with the task of `tiltrotor demo` and the same way of flying.

It is the pilot model of the demonstration written anew: phases ask for speed, height, heading and nacelles;
hands turn that into stick, lever and pedals fifty times a second, and learn what is missing. It knows no more
of an aircraft than what windows, dials and seat tell. Gains are the demonstration's; none was fitted here.
"""

import math
from dataclasses import dataclass

from model import FOOT_M, KNOT_MPS

HAND_TICKS = 5
HAND_S = HAND_TICKS / 250
G = 9.80665
TORQUE_N_M_MAX = 14690.0
END_RAD = 0.003
CORRIDOR_MPS = 8 * KNOT_MPS
AHEAD_RAD = 0.07


def clip(x, low, high):
    """x, no lower and no higher."""
    return min(high, max(low, x))


def ramp(x, low, high):
    """From 0 at `low` to 1 at `high`."""
    return clip((x - low) / (high - low), 0.0, 1.0)


def wrap(angle):
    """Between -pi and pi."""
    return (angle + math.pi) % (2 * math.pi) - math.pi


class Seen:
    """What the pilot sees, reads and feels."""

    def __init__(self, sim):
        f = sim.fdm
        self.phi, self.theta, self.psi = (f[f"attitude/{a}-rad"] for a in ("phi", "theta", "psi"))
        self.p, self.q, self.r = (f[f"velocities/{a}-rad_sec"] for a in "pqr")
        self.position = sim.position_m()
        self.velocity = [f[f"velocities/v-{a}-fps"] * FOOT_M for a in ("north", "east", "down")]
        self.height = -self.position[2]
        self.airspeed = f["velocities/vtrue-fps"] * FOOT_M
        self.calibrated = f["velocities/vc-kts"] * KNOT_MPS
        self.alpha = f["aero/alpha-rad"]
        self.density = f["atmosphere/rho-slugs_ft3"] * 515.379
        force = [f[f"forces/fb{a}-total-lbs"] / (f["inertia/weight-lbs"] / 32.174) * FOOT_M for a in "xyz"]
        # In the seat everything but gravity is felt.
        s_th, c_th, s_ph, c_ph = (
            math.sin(self.theta),
            math.cos(self.theta),
            math.sin(self.phi),
            math.cos(self.phi),
        )
        self.side = force[1]
        along = force[0] * c_th + (force[1] * s_ph + force[2] * c_ph) * s_th
        self.along_mps2 = along
        self.up_mps2 = force[0] * s_th - (force[1] * s_ph + force[2] * c_ph) * c_th - G
        s, c = math.sin(self.psi), math.cos(self.psi)
        self.forward = self.velocity[0] * c + self.velocity[1] * s
        self.right = self.velocity[1] * c - self.velocity[0] * s
        self.climb = -self.velocity[2]
        self.speed = math.hypot(*self.velocity)
        self.tilt = math.radians(sim["tilt"])
        self.rotor = sim["rotor_radps"]
        self.torque = sim["power_norm"] * sim.rated_w / 2 / max(10.0, self.rotor)
        self.legs = [f[f"gear/unit[{i}]/WOW"] for i in range(3)]
        self.push = f["forces/fbz-gear-lbs"] / f["inertia/weight-lbs"]
        self.on_wheels = -self.push

    def track(self):
        """Which way it goes over the ground."""
        return math.atan2(self.velocity[1], self.velocity[0]) if self.speed > 2 else self.psi


@dataclass
class Aim:
    """What the pilot wants to hold."""

    forward: float
    over_ground: bool
    right: float
    forward_mps2: float
    forward_mps2_max: float
    climb: float
    heading: float
    bank_max: float


class Hands:
    """From what is wanted to stick, pedals and lever."""

    def __init__(self):
        self.felt_along = self.felt_up = self.pitch = self.lever = self.roll = self.level = 0.0
        self.lever_max = 1.0
        self.aft = self.right = self.foot = 0.0

    def settle(self):
        """Lowers the lever and lets the stick go."""
        fade = 1 - HAND_S / 0.7
        self.aft, self.right, self.foot = self.aft * fade, self.right * fade, self.foot * fade
        self.lever = clip(self.lever - 0.3 * HAND_S, 0, 1)
        return self.aft, self.right, self.foot, self.lever

    def fly(self, seen, aim):
        """Moves the hands once: stick aft, stick right, right pedal, lever."""
        flying = ramp(seen.airspeed, 15, 26)
        pitch, lever = self.pitch_and_lever(seen, aim, flying)
        bank = self.bank(seen, aim, flying)
        learn = 0.0 if seen.on_wheels > 0.1 else HAND_S
        light = 1 / (1 + 0.5 * seen.density * seen.airspeed**2 / 1500)
        turn = flying * G * math.sin(seen.phi) / max(seen.airspeed, 15)
        pull = clip(1.8 * (pitch - seen.theta), -0.2, 0.2) + turn * math.sin(seen.phi) - seen.q
        roll = clip(1.5 * (bank - seen.phi), -0.35, 0.35) - seen.p
        self.aft = clip(self.aft + 1.8 * light * pull * learn, -0.9, 0.9)
        self.right = clip(self.right + 0.4 * roll * learn, -0.6, 0.6)
        off = wrap(aim.heading - seen.psi)
        yaw = clip(0.6 * off, -0.2, 0.2)
        spot_foot = 2.2 * yaw + 2.5 * (yaw - seen.r)
        ball_foot = 0.8 * -seen.side / G + 0.5 * (turn - seen.r)
        slow = 1 - flying
        nearly = off if abs(off) < 0.15 else 0.0
        self.foot = clip(self.foot + (slow * 0.25 * nearly + flying * 0.3 * ball_foot) * learn, -0.7, 0.7)
        return (
            clip(self.aft + 1.8 * light * pull, -1, 1),
            clip(self.right + 0.9 * roll, -1, 1),
            clip(self.foot + slow * spot_foot + flying * 0.9 * ball_foot, -1, 1),
            lever,
        )

    def pitch_and_lever(self, seen, aim, flying):
        """Speed and climb by attitude and lever, shared out by the masts' tilt."""
        self.felt_along += HAND_S / 0.25 * (seen.along_mps2 - self.felt_along)
        self.felt_up += HAND_S / 0.25 * (seen.up_mps2 - self.felt_up)
        through_air = 0.0 if aim.over_ground else flying
        now = seen.forward + through_air * (seen.airspeed - seen.forward)
        along = clip(
            aim.forward_mps2 + 0.3 * (aim.forward - now), -aim.forward_mps2_max, aim.forward_mps2_max
        )
        climb_off = aim.climb - seen.climb
        up = clip((0.8 - 0.3 * flying) * climb_off, -2.0, 2.0)
        lift = 0.014 * 0.5 * seen.density * seen.airspeed**2
        strength = min(9.0, 330 / max(seen.airspeed, 1))
        s, c = strength * math.sin(seen.tilt), strength * math.cos(seen.tilt)
        whole = G * c + lift * s

        def hands(a, b):
            return (s * b - c * a) / whole, (G * b + lift * a) / whole

        over = seen.torque / TORQUE_N_M_MAX
        self.lever_max = clip(self.lever_max + (-0.5 * (over - 1) if over > 1 else 0.05) * HAND_S, 0.3, 1.0)
        at_once = list(hands(0.7 * along, 0.7 * up))
        up_off = up - self.felt_up
        off = list(hands(along - self.felt_along, up_off))
        lever = self.lever + at_once[1]
        at_end = (lever >= self.lever_max and off[1] > 0) or (lever <= 0 and off[1] < 0)
        if flying > 0.5 and abs(climb_off) > 2 and off[1] * climb_off < 0:
            off[1] = 0.0
        if at_end and seen.airspeed > 40:
            at_once[0], off[0] = 0.7 * up / lift, up_off / lift
        on_wheels = seen.on_wheels > 0.1
        if not on_wheels:
            highest = min(0.3, seen.theta + 0.2 - seen.alpha) if flying > 0.5 else 0.3
            self.pitch = clip(
                self.pitch + (0.4 + 0.4 * flying) * off[0] * HAND_S, -0.3 - at_once[0], highest - at_once[0]
            )
        self.lever = clip(
            self.lever + (0.9 - 0.4 * flying) * off[1] * HAND_S, -at_once[1], self.lever_max - at_once[1]
        )
        return self.pitch + (0 if on_wheels else at_once[0]), clip(self.lever + at_once[1], 0, self.lever_max)

    def bank(self, seen, aim, flying):
        """To the side when slow, to the heading when fast."""
        off = aim.right - seen.right
        slow = 1 - flying
        if seen.on_wheels < 0.1:
            self.level = clip(self.level + slow * 0.006 * off * HAND_S, -0.15, 0.15) * (
                1 - flying * HAND_S / 2
            )
        turn = clip(0.2 * wrap(aim.heading - seen.psi), -0.35, 0.35)
        bank = clip(math.atan2(seen.airspeed * turn, G), -aim.bank_max, aim.bank_max)
        wanted = slow * clip(0.04 * off, -0.2, 0.2) + flying * bank
        self.roll += clip(wanted - self.roll, -0.25 * HAND_S, 0.25 * HAND_S) * (3 if slow > 0.5 else 1)
        return self.level + self.roll


# Phases: name, what is done, s before the pilot gives up.
VERTICAL = ("on the ground", "take-off", "hover", "acceleration")
PITCHED = ("on the ground", "pitch-forward take-off")
REST = ("conversion", "climb", "left turn", "approach", "hover turn", "hover over the start", "landing")
PATIENCE_S = {"approach": 300.0}


class Pilot:
    """The task, phase by phase."""

    def __init__(self, sim, corridor, pitched=False):
        self.sim, self.hands = sim, Hands()
        self.slowest, self.fastest = corridor
        self.phases = (PITCHED if pitched else VERTICAL) + REST
        self.at, self.since, self.log = 0, 0.0, [(0.0, self.phases[0])]
        self.forward = 0.0
        self.over_ground = False
        self.forward_mps2, self.forward_mps2_max = 0.0, 1.5
        self.height, self.climb_max, self.sink_max = 2.2, 2.5, 2.5
        self.nacelles, self.gear_down, self.bank_max = 0, True, 0.5
        self.spot = None
        self.turned, self.touched, self.handle = 0.0, None, 0.0
        self.rpm_low, self.flap = False, 40.0
        self.done, self.gave_up = False, None
        self.start = self.heading = self.start_heading = None
        self.calibrated = 0.0

    def act(self, time):
        """Looks, and moves hands and switches once."""
        seen = Seen(self.sim)
        if self.start is None:
            self.start, self.heading, self.start_heading = seen.position, seen.psi, seen.psi
        self.calibrated += HAND_S / 0.5 * (seen.calibrated - self.calibrated)
        name = self.phases[self.at]
        over = self.order(name, seen, time)
        if name == "on the ground":
            stick = (0.0, 0.0, 0.0, 0.0)
        elif self.touched is not None:
            stick = self.hands.settle()
        else:
            stick = self.hands.fly(seen, self.aim(name, seen))
        for control, value in zip(("stick_aft", "stick_right", "pedal_right", "lever"), stick):
            self.sim[control] = value
        self.switches(seen, time)
        if over:
            self.at, self.since, self.turned = self.at + 1, time, 0.0
            self.done = self.at == len(self.phases)
            if not self.done:
                self.log.append((time, self.phases[self.at]))
        elif time - self.since > PATIENCE_S.get(name, 120.0):
            self.gave_up, self.done = f"{name}: it takes too long", True
        return seen

    def bearing(self, seen):
        """Of the spot where it began, and the distance."""
        north, east = self.start[0] - seen.position[0], self.start[1] - seen.position[1]
        return math.atan2(east, north), math.hypot(north, east)

    def order(self, name, seen, time):
        """What the phase wants now, and whether it is over."""
        since = time - self.since
        if name == "on the ground":
            return since >= 1.0
        if name == "take-off":
            self.climb_max, self.height = 2.0, 10.0
            return abs(seen.height - 10) < 1
        if name in ("hover", "hover over the start"):
            return since >= (3.0 if name == "hover" else 2.0)
        if name in ("acceleration", "pitch-forward take-off"):
            self.forward, self.forward_mps2_max, self.climb_max, self.height = 85 * KNOT_MPS, 1.6, 4.0, 60.0
            if name != "acceleration":
                self.climb_max = 2.5
                if seen.on_wheels > 0.1 or seen.height < 4:
                    self.forward_mps2_max = 0.6  # nose a little down as it leaves the ground
            self.gear_down = self.gear_down and (seen.height < 15 or self.calibrated < 20)
            return self.calibrated > 81 * KNOT_MPS and seen.height > 50
        if name == "conversion":
            self.nacelles, self.forward, self.forward_mps2_max = -1, 150 * KNOT_MPS, 3.0
            self.climb_max, self.gear_down = 3.0, False
            return seen.tilt > math.pi / 2 - END_RAD and self.calibrated > 142 * KNOT_MPS
        if name == "climb":
            self.height, self.climb_max = 120.0, 7.0
            return seen.height > 105
        if name == "left turn":
            self.bank_max = math.radians(40)
            to, distance = self.bearing(seen)
            rate = seen.r * math.cos(seen.phi) + seen.q * math.sin(seen.phi)
            self.turned -= rate * HAND_S
            self.heading = wrap(seen.psi - 1)
            lead = abs(rate * 2.2) + 0.03
            return self.turned > 2.5 and abs(wrap(to - seen.track())) < lead and distance > 1
        if name == "approach":
            return self.approach(seen)
        if name == "hover turn":
            self.heading = self.start_heading
            return abs(wrap(self.heading - seen.psi)) < 0.05 and abs(seen.r) < 0.03
        if self.touched is None and any(seen.legs):
            self.touched = time
        return self.touched is not None and time - self.touched > 5 and seen.speed < 0.3

    def approach(self, seen):
        """To the spot: reconverts and slows down on the way, hovers over it."""
        to, distance = self.bearing(seen)
        off = wrap(to - seen.track())
        ahead = distance * math.cos(wrap(to - seen.psi))
        if distance > 150 and abs(off) < 1:
            self.heading = wrap(seen.psi + off)
        self.bank_max = 0.5
        self.slow_down(seen, math.sqrt(2 * 1.4 * max(0.0, ahead - 15)))
        self.height = min(self.height, max(10.0, 10 + 0.07 * (ahead - 150)))
        if (seen.speed < 3 and ahead < 30) or self.spot is not None:
            self.spot = self.start
        helicopter = seen.tilt < END_RAD
        return (
            self.spot is not None
            and distance < 3
            and seen.speed < 1
            and abs(seen.height - 10) < 1.5
            and helicopter
        )

    def slow_down(self, seen, slow):
        """A speed over the ground, no slower than the nacelles allow, which come aft meanwhile."""
        if slow < seen.forward + 3:
            self.nacelles = 1
        self.over_ground, self.forward_mps2_max, self.climb_max = True, 2.0, 2.5
        self.sink_max = clip(0.12 * seen.airspeed, 2.5, 6.0)
        self.gear_down = self.gear_down or self.calibrated < 150 * KNOT_MPS
        slowest = self.slowest(seen.tilt)
        keep = slowest + CORRIDOR_MPS - (self.calibrated - seen.forward) if slowest > 0 else 0.0
        slower = slow < self.forward + 0.1 and slow > keep and slow > 3
        self.forward_mps2 = -1.4 if slower else 0.0
        self.forward = max(min(self.forward, slow), keep)

    def aim(self, name, seen):
        """Speeds that serve the orders, and hold the spot when there is one."""
        if name == "landing":
            climb = -clip(0.3 * (seen.height - 2.3), 0.4, 1.6)
        else:
            gain = 0.2 if seen.airspeed > 40 else 0.4
            climb = clip(gain * (self.height - seen.height), -self.sink_max, self.climb_max)
        hovers = name in ("approach", "hover turn", "hover over the start", "landing")
        hovering = self.spot is not None or (self.forward == 0 and seen.speed < 4)
        forward, right = self.forward, 0.0
        s, c = math.sin(seen.psi), math.cos(seen.psi)
        if hovering and (self.forward == 0 or hovers):
            if self.spot is None:
                self.spot = seen.position
            north, east = self.spot[0] - seen.position[0], self.spot[1] - seen.position[1]
            forward = clip(0.12 * (north * c + east * s), -4, 4)
            right = clip(0.12 * (east * c - north * s), -3, 3)
            self.forward = 0.0
        elif not hovers or self.forward > 0:
            self.spot = None
        if name == "approach" and self.spot is None:
            north, east = self.start[0] - seen.position[0], self.start[1] - seen.position[1]
            right = clip(0.2 * (east * c - north * s), -3, 3)
        return Aim(
            forward, self.over_ground, right, 0.0 if hovering else self.forward_mps2, self.forward_mps2_max, climb,
            self.heading, self.bank_max,
        )  # fmt: skip

    def switches(self, seen, time):
        """Nacelles inside the corridor, rotor speed, flaps and gear."""
        sim, thumb = self.sim, 0
        steady = abs(seen.rotor / 61.68 - 1) < 0.05
        if self.nacelles < 0 and seen.tilt < math.pi / 2 - 1e-4 and steady:
            fast = self.calibrated > self.slowest(min(seen.tilt + AHEAD_RAD, math.pi / 2)) + CORRIDOR_MPS
            thumb = -1 if fast and seen.alpha < 0.21 else 0
        elif self.nacelles > 0 and seen.tilt > 1e-4 and steady:
            thumb = 1 if self.calibrated < self.fastest(max(seen.tilt - AHEAD_RAD, 0.0)) - CORRIDOR_MPS else 0
        sim["nacelle_aft"] = thumb
        sim["rpm_lever"] = 589.0
        sim["gear_lever"] = 1.0 if self.gear_down else 0.0
        if time - self.handle > 1.0:
            flap = self.flap_wanted(seen)
            if flap != self.flap:
                self.flap, self.handle = flap, time
        sim["flap_lever"] = self.flap

    def flap_wanted(self, seen):
        """Up late and down early: 40 with the nacelles well up, 20 between, none as a fast aeroplane."""
        incidence = 90 - math.degrees(seen.tilt)
        if incidence > (60 if self.nacelles > 0 else 75):
            return 40.0
        if incidence > 5 or self.calibrated < 145 * KNOT_MPS:
            return 20.0
        return 0.0 if self.calibrated > 160 * KNOT_MPS else self.flap


def corridor(data):
    """The slowest and the fastest calibrated airspeed over mast tilt, m/s, as two functions of rad."""
    from published import at

    def limit(path):
        tilts, knots = data.line(path)
        return lambda tilt: at(tilts, knots, math.degrees(tilt)) * KNOT_MPS

    e = "envelope.corridor.calibrated_airspeed_kt_"

    return limit(e + "min"), limit(e + "max")
