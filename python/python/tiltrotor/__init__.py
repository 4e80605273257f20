"""A deterministic simulation of the Bell XV-15 tilt-rotor, and its flight logs.

The same engine as the command ``tiltrotor``, with the same bits: what is recorded here is verified there, and the
other way round. A tick is 4 ms. Numbers are in SI units and radians where their names end so (``_mps``, ``_rad``);
a pilot's units are in the names too (``_kt``, ``_deg``).

>>> import tiltrotor
>>> xv15 = tiltrotor.Aircraft()
>>> round(xv15.trim(nacelle_deg=0, speed_kt=180, altitude_ft=5000)["lever_percent"]) > 0
True
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._native import STARTS, STEP_S, NoSteadyFlight, TiltrotorError, Trim, Verdict, __version__
from ._native import channels as _channels

__all__ = [
    "STARTS",
    "STEP_S",
    "Aircraft",
    "Flight",
    "Linear",
    "NoSteadyFlight",
    "TiltrotorError",
    "Trim",
    "Verdict",
    "__version__",
    "channels",
    "read",
    "verify",
]

Path = str | PathLike[str]


class Linear:
    """Small motions about a steady flight: x' = A x + B u, y = C x + D u, SI units and radians.

    ``A`` (n, n), ``B`` (n, 4), ``C`` (13, n), ``D`` (13, 4) are arrays of doubles; ``states``, ``inputs`` and ``outputs`` name
    their rows and columns. Inputs are travels of the grips in m: stick aft, stick right, pedal right, lever up.
    """

    def __init__(self, found: _native.Linear) -> None:
        self.states: list[str] = found.states
        self.inputs: list[str] = found.inputs
        self.outputs: list[str] = found.outputs
        self.A, self.B, self.C, self.D = (self._matrix(found, name) for name in "ABCD")
        #: Eigenvalues of A from the slowest, 1/s.
        self.eigenvalues: NDArray[np.complex128] = np.array([complex(*pair) for pair in found.eigenvalues()])

    @staticmethod
    def _matrix(found: _native.Linear, name: str) -> NDArray[np.float64]:
        rows, columns, numbers = found.matrix(name)
        return np.array(numbers, dtype=np.float64).reshape(rows, columns)

    def __repr__(self) -> str:
        return f"<tiltrotor.Linear of {len(self.states)} states>"


class Aircraft:
    """An aircraft file that was read; the XV-15 without a path."""

    def __init__(self, path: Path | None = None, *, _native_aircraft: _native.Aircraft | None = None) -> None:
        self._native = _native_aircraft or _native.Aircraft(None if path is None else fspath(path))

    @classmethod
    def from_toml(cls, toml: str) -> Aircraft:
        """Of the text of an aircraft file."""
        return cls(_native_aircraft=_native.Aircraft.from_toml(toml))

    @property
    def name(self) -> str:
        """What it is called."""
        return self._native.name

    @property
    def toml(self) -> str:
        """The aircraft file, as a flight's log carries it."""
        return self._native.toml

    def values(self) -> dict[str, str]:
        """Every number that :meth:`with_` can change, by its key (the unit is in the key), as the file has it."""
        return dict(self._native.values())

    def with_(self, changes: Mapping[str, float], source: str = "changed in Python") -> Aircraft:
        """The same aircraft with numbers changed; ``source`` is written beside each of them.

        Raises KeyError for a key that there is not, TiltrotorError for a number that cannot be.
        """
        return Aircraft(_native_aircraft=self._native.with_(dict(changes), source))

    def trim(self, **condition: float | bool) -> Trim:
        """A steady flight.

        ``nacelle_deg`` (90 helicopter, 0 aeroplane), ``speed_kt``, ``climb_fpm`` or ``lever_percent``, ``turn_degps`` or ``bank_deg``,
        ``sideslip_deg``, ``weight_lb``, ``altitude_ft``, ``height_ft`` above the ground, ``isa_k``, ``flap_deg``, ``rpm``, ``gear_down``,
        ``scas_on``: as the options of ``tiltrotor trim``, with the same defaults. Raises NoSteadyFlight.
        """
        return self._native.trim(**condition)

    def linearize(self, **condition: float | bool) -> Linear:
        """Small motions about the steady flight of :meth:`trim`."""
        return Linear(self._native.linearize(**condition))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Aircraft.from_toml, (self.toml,))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Aircraft) and other.toml == self.toml

    def __hash__(self) -> int:
        return hash(self.toml)

    def __repr__(self) -> str:
        return f"<tiltrotor.Aircraft {self.name}>"


def _record(fields: list[tuple[str, str]], data: bytes) -> NDArray[np.void]:
    """Structured array over bytes that are laid end to end: nothing is copied or rounded."""
    return np.frombuffer(data, dtype=np.dtype(fields))


class Flight:
    """A flight that is stepped by whoever calls.

    ``start`` is one of the positions in ``STARTS``; ``scenario`` is the text of a scenario file instead. The controls go through
    the cockpit map as raw device events, and what is recorded refly to the same bits.
    """

    def __init__(
        self,
        aircraft: Aircraft | None = None,
        start: str = "runway",
        scenario: str | None = None,
        *,
        _native_flight: _native.Flight | None = None,
    ) -> None:
        self.aircraft = aircraft or Aircraft()
        self._native = _native_flight or _native.Flight(self.aircraft._native, start, scenario)

    @property
    def tick(self) -> int:
        """Ticks flown."""
        return self._native.tick

    @property
    def time_s(self) -> float:
        """Time flown, s."""
        return self._native.tick * STEP_S

    def controls(self) -> dict[str, tuple[float, float, str]]:
        """The controls by name: lower and upper end, and what each is."""
        return {name: (low, 1.0, what) for name, low, what in self._native.controls()}

    def set(self, **controls: float) -> None:
        """Moves controls with the next step: ``stick_aft``, ``stick_right``, ``pedal_right`` (−1 to 1), ``collective``,
        ``brake_left`` and ``brake_right`` (0 to 1), and what else :meth:`controls` has."""
        # By name, as the events of a script are.
        for name in sorted(controls):
            self._native.set_control(name, float(controls[name]))

    def press(self, button: str) -> None:
        """Presses a button and lets it go, with the next step: ``marker``, ``flap_down``, ``gear_toggle``…"""
        self._native.button(button, None)

    def hold(self, button: str) -> None:
        """Presses a button until :meth:`release`: ``nacelle_forward``…"""
        self._native.button(button, True)

    def release(self, button: str) -> None:
        """Lets a button go."""
        self._native.button(button, False)

    def fail(self, *failures: str) -> None:
        """Failures from the next step on: ``engine_left``, ``scas_yaw``…"""
        for failure in failures:
            self._native.fail(failure, True)

    def mend(self, *failures: str) -> None:
        """Ends failures."""
        for failure in failures:
            self._native.fail(failure, False)

    def wind(self, from_deg: float, kt: float) -> None:
        """Steady wind from a true direction, deg, at a speed, kt."""
        self._native.wind(from_deg, kt)

    def turbulence(self, mps: float) -> None:
        """Vertical intensity of the turbulence, m/s; 0 for still air."""
        self._native.turbulence(mps)

    def command(self, commands: Mapping[str, float] | None) -> None:
        """Commands the actuators in place of the flight control computer, from the next step on, until ``None`` gives them back.

        Keys are those below ``commands`` in :attr:`outputs`: ``elevator_rad``, ``collective_rad.left``… What is not named stays what the
        computer, or the last call, asked for. The log says that somebody else flew, and reflies exactly without him.
        """
        self._native.command(None if commands is None else dict(commands))

    def step(self, ticks: int = 1) -> None:
        """Flies so many ticks of 4 ms. Ctrl-C is answered within some ten milliseconds."""
        self._native.step(ticks)

    def fly(self, table: Iterable[Mapping[str, float]]) -> None:
        """Flies a table: every row has ``time_s``, until when it flies, and the controls that it moves before."""
        for row in table:
            until = round(row["time_s"] / STEP_S)
            if until < self.tick:
                raise TiltrotorError(f"time_s {row['time_s']}: the flight is at {self.time_s} s already")
            self.set(**{name: value for name, value in row.items() if name != "time_s"})
            self.step(until - self.tick)

    @property
    def state(self) -> np.void:
        """The state: a record of doubles and integers, exact; ``state['plant.fuel_kg']``."""
        fields, data = self._native.numbers("state")
        return _record(fields, data)[0]

    @property
    def outputs(self) -> np.void:
        """What could be observed after the last tick: ``outputs['airspeed_mps']``."""
        fields, data = self._native.numbers("outputs")
        return _record(fields, data)[0]

    def copy(self) -> Flight:
        """A second flight from here on, without a log."""
        return Flight(self.aircraft, _native_flight=self._native.copy())

    def record(self, path: Path, force: bool = False) -> None:
        """Records from here on into an MCAP log; ``force`` replaces one that is there."""
        self._native.record(fspath(path), force)

    def close(self) -> str | None:
        """Ends the log; the digest of the whole flight, or None when there was no log."""
        return self._native.close()

    def __enter__(self) -> Flight:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return repr(self._native)


def verify(path: Path, threads: int | None = None) -> Verdict:
    """Reflies a log and compares every bit of every state; the verdict is true when the log is exact."""
    return _native.verify(fspath(path), threads)


def channels(path: Path) -> dict[str, int]:
    """The channels of a log that hold numbers, and how many messages each has."""
    return _channels(fspath(path))


def read(path: Path, channel: str, from_tick: int = 0, until_tick: int | None = None) -> NDArray[np.void]:
    """A channel of a log as a structured array, a row a message: ``read(log, "state")["state.plant.fuel_kg"]``.

    Channels are ``state``, ``inputs``, ``hardware``, ``timing``, ``events``, ``outputs``, ``restart``; the field ``time_ns`` is added in front. Bits are
    those of the file. Raises TiltrotorError for a damaged log, with the tick up to which it can be read.
    """
    until = 2**64 - 1 if until_tick is None else until_tick
    times, data, fields, damage = _native.messages(fspath(path), channel, from_tick, until)
    if damage is not None:
        raise TiltrotorError(f"{fspath(path)}: damaged: {damage}")
    body = _record(fields, data)
    rows = np.empty(len(body), dtype=[("time_ns", "<u8"), *body.dtype.descr])
    rows["time_ns"] = np.frombuffer(times, dtype="<u8")
    for name in body.dtype.names or ():
        rows[name] = body[name]
    return rows
