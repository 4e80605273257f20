"""Gymnasium environments: hover, conversion and landing of the XV-15; docs/python.md says how they are installed.

Importing this module registers ``tiltrotor/Hover-v0``, ``tiltrotor/Conversion-v0`` and ``tiltrotor/Landing-v0``.

>>> import gymnasium, tiltrotor.gym
>>> env = gymnasium.make("tiltrotor/Hover-v0")
>>> observation, info = env.reset(seed=1)

Agents fly with the grips, through the flight control computer with its SCAS, 25 times a second. With ``record`` every
episode is a flight log that reflies bit for bit; logs that are there stay, the numbers of new ones go on.
"""

from __future__ import annotations

import math
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ._native import TiltrotorError
from .aircraft import Aircraft, Condition
from .flight import Flight

#: What is observed, in order, with what each is divided by.
OBSERVED: dict[str, float] = {
    "north of the start, m": 50.0,
    "east of the start, m": 50.0,
    "height above the start, m": 50.0,
    "height above the ground, m": 50.0,
    "forward speed, m/s": 50.0,
    "speed to the right, m/s": 50.0,
    "downward speed, m/s": 10.0,
    "roll, rad": 1.0,
    "pitch, rad": 1.0,
    "heading off the start's, rad": 1.0,
    "roll rate, rad/s": 1.0,
    "pitch rate, rad/s": 1.0,
    "yaw rate, rad/s": 1.0,
    "airspeed, m/s": 50.0,
    "mast tilt, rad": 1.0,
    "rotor speed, rad/s": 60.0,
    "load factor": 1.0,
    "weight on wheels": 1.0,
}

#: Observations are cut off here.
_OBSERVED_MAX = 20.0

#: What moves: stick aft, stick right, pedal right, power lever, and the nacelle switch, forward positive.
ACTIONS = ("stick_aft", "stick_right", "pedal_right", "collective", "nacelle_forward")

#: Part of the travel that an action of 1 moves a control away from where it was at the start.
_AUTHORITY = {"stick_aft": 1.0, "stick_right": 1.0, "pedal_right": 1.0, "collective": 0.5}

#: Beyond this the nacelle switch is pressed.
_SWITCH = 1.0 / 3.0

#: Ticks between two decisions: 25 Hz.
_TICKS = 10


class Task(NamedTuple):
    """What is to be flown."""

    start: str
    """Start position."""
    trim: Condition | None
    """Steady flight in which it begins instead of the position's own."""
    length_s: float
    """After which the episode ends, s."""
    wind_kt: float
    """The strongest steady wind that an episode may have, from anywhere, kt."""


TASKS: dict[str, Task] = {
    # Stay where it began.
    "hover": Task("hover-50ft", None, 30.0, 10.0),
    # Nacelles down, height kept.
    "conversion": Task(
        "runway",
        {"nacelle_deg": 75.0, "speed_kt": 100.0, "altitude_ft": 2000.0, "scas_on": True},
        60.0,
        0.0,
    ),
    # Onto the wheels below, softly.
    "landing": Task("hover-50ft", None, 60.0, 5.0),
}


class XV15Env(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """A task in the XV-15.

    Observations are the 18 numbers of ``OBSERVED``, each divided as there; actions are five numbers from −1 to 1,
    ``ACTIONS``. A reward of 1 a second is the best there is on the way, and 10 more for a task that is done.
    ``info["done"]`` says whether it is, ``info["log"]`` which log the episode went into.
    """

    metadata = {"render_modes": []}  # noqa: RUF012 (Gymnasium's own form)

    def __init__(
        self,
        task: str = "hover",
        aircraft: Aircraft | None = None,
        record: str | PathLike[str] | None = None,
        render_mode: str | None = None,
    ) -> None:
        if task not in TASKS:
            raise ValueError(f"task {task}: there are {', '.join(TASKS)}")
        self.task = task
        self.render_mode = render_mode
        self._task = TASKS[task]
        self._record = None if record is None else Path(record)
        self._aircraft = aircraft or Aircraft()
        # It settles or is trimmed once; every episode is a copy.
        self._start = Flight(self._aircraft, self._task.start, trim=self._task.trim)
        self._flight: Flight | None = None
        self._episode = 0
        self.observation_space = gymnasium.spaces.Box(
            -_OBSERVED_MAX, _OBSERVED_MAX, (len(OBSERVED),), np.float32
        )
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(ACTIONS),), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """A new episode; the seed decides the wind."""
        super().reset(seed=seed)
        self._close()
        flight = self._flight = self._start.copy()
        self._log: str | None = None
        if self._record is not None:
            self._log = str(self._recorded(flight, self._record))
        state, outputs = flight.state, flight.outputs
        self._from = [float(outputs[f"position_m.{axis}"]) for axis in "xyz"]
        self._heading_rad = float(outputs["euler.heading_rad"])
        self._grips = {name: float(state[f"cockpit.{name}_norm"]) for name in _AUTHORITY}
        self._pressed = {"nacelle_forward": False, "nacelle_aft": False}
        self._tilt_rad = float(outputs["actuators.mast_tilt_rad.left"])
        if self._task.wind_kt > 0.0:
            from_deg = float(self.np_random.uniform(0.0, 360.0))
            flight.wind(from_deg, float(self.np_random.uniform(0.0, self._task.wind_kt)))
        return self._seen(outputs), {"done": False, "log": self._log}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Flies 40 ms."""
        flight = self._flight
        if flight is None:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        wanted = dict(zip(ACTIONS, np.clip(action, -1.0, 1.0).tolist(), strict=True))
        flight.set(**self._positions(wanted))
        self._switch(flight, "nacelle_forward", wanted["nacelle_forward"] > _SWITCH)
        self._switch(flight, "nacelle_aft", wanted["nacelle_forward"] < -_SWITCH)
        flight.step(_TICKS)
        outputs = flight.outputs
        observation = self._seen(outputs)
        reward, done, failed = self._judged(outputs, bool(flight.state["frozen"]))
        truncated = not (done or failed) and flight.time_s >= self._task.length_s
        if done or failed or truncated:
            flight.close()
        return observation, reward, done or failed, truncated, {"done": done, "log": self._log}

    def close(self) -> None:
        """Ends the episode and its log."""
        self._close()

    def _close(self) -> None:
        if self._flight is not None:
            self._flight.close()
            self._flight = None

    def _recorded(self, flight: Flight, folder: Path) -> Path:
        """Records under the next number that nobody has: neither an earlier run nor an environment beside this one."""
        folder.mkdir(parents=True, exist_ok=True)
        while True:
            self._episode += 1
            log = folder / f"{self.task}-{self._episode:06}.mcap"
            if log.exists():
                continue
            try:
                flight.record(log)
            except TiltrotorError:
                # Somebody else took the name in between, or nothing can be recorded there.
                if not log.exists():
                    raise
            else:
                return log

    def _positions(self, wanted: dict[str, float]) -> dict[str, float]:
        positions = {}
        for name, authority in _AUTHORITY.items():
            lowest = 0.0 if name == "collective" else -1.0
            positions[name] = min(1.0, max(lowest, self._grips[name] + authority * wanted[name]))
        return positions

    def _switch(self, flight: Flight, button: str, pressed: bool) -> None:
        if pressed != self._pressed[button]:
            (flight.hold if pressed else flight.release)(button)
            self._pressed[button] = pressed

    def _seen(self, outputs: np.void) -> NDArray[np.float32]:
        north, east, down = (
            float(outputs[f"position_m.{axis}"]) - start
            for axis, start in zip("xyz", self._from, strict=True)
        )
        off_rad = float(outputs["euler.heading_rad"]) - self._heading_rad
        numbers = [
            north,
            east,
            -down,
            outputs["height_above_ground_m"],
            outputs["body_velocity_mps.x"],
            outputs["body_velocity_mps.y"],
            outputs["velocity_mps.z"],
            outputs["euler.roll_rad"],
            outputs["euler.pitch_rad"],
            math.remainder(off_rad, math.tau),
            outputs["angular_rate_radps.x"],
            outputs["angular_rate_radps.y"],
            outputs["angular_rate_radps.z"],
            outputs["airspeed_mps"],
            outputs["actuators.mast_tilt_rad.left"],
            outputs["rotor_speed_radps"],
            outputs["load_factor"],
            outputs["landing_gear.main.left.push_n"] > 0.0,
        ]
        scaled = np.array(numbers, dtype=np.float64) / np.array(list(OBSERVED.values()))
        seen: NDArray[np.float32] = np.clip(scaled, -_OBSERVED_MAX, _OBSERVED_MAX).astype(np.float32)
        return seen

    def _judged(self, outputs: np.void, frozen: bool) -> tuple[float, bool, bool]:
        """Reward; whether the task is done; whether it has failed."""
        north, east, down = (
            float(outputs[f"position_m.{axis}"]) - start
            for axis, start in zip("xyz", self._from, strict=True)
        )
        decision_s = _TICKS * 0.004
        rolled = abs(float(outputs["euler.roll_rad"])) > 1.0
        pitched = abs(float(outputs["euler.pitch_rad"])) > 1.0
        on_wheels = float(outputs["landing_gear.main.left.push_n"]) > 0.0
        upset = frozen or rolled or pitched
        if self.task == "conversion":
            tilt_rad = float(outputs["actuators.mast_tilt_rad.left"])
            turned, self._tilt_rad = tilt_rad - self._tilt_rad, tilt_rad
            done = tilt_rad > math.radians(89.5) and abs(down) < 100.0
            reward = 10.0 * turned + decision_s * (math.exp(-abs(down) / 50.0) - 1.0)
            return reward + 10.0 * done, done, upset or on_wheels
        apart_m = math.hypot(north, east)
        if self.task == "landing":
            sink_mps = float(outputs["velocity_mps.z"])
            done = on_wheels and sink_mps < 2.0 and apart_m < 10.0 and not upset
            low = float(outputs["height_above_ground_m"]) / 20.0
            reward = decision_s * math.exp(-apart_m / 10.0 - max(0.0, low))
            return reward + 10.0 * done, done, upset or (on_wheels and not done)
        reward = decision_s * math.exp(-math.hypot(apart_m, down) / 5.0)
        return reward, False, upset or on_wheels or apart_m > 200.0


for _name in TASKS:
    gymnasium.register(
        id=f"tiltrotor/{_name.capitalize()}-v0",
        entry_point="tiltrotor.gym:XV15Env",
        kwargs={"task": _name},
    )
