"""A flight that is stepped by whoever calls."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np

from . import _native
from ._arrays import row
from .aircraft import Aircraft, Condition


class Flight:
    """A flight that is stepped by whoever calls.

    It begins at a start position (one of ``STARTS``), or as the text of a ``scenario`` file says, and with ``trim`` in
    steady flight there: ``nacelle_deg``, ``speed_kt``, ``altitude_ft``, ``climb_fpm``, ``flap_deg``, ``rpm``,
    ``scas_on``.

    Controls go through the cockpit map as raw device events, as those of a script do: what is recorded reflies to the
    same bits, in Python and by the command.

    >>> flight = Flight(start="hover-50ft")
    >>> flight.set(stick_aft=0.1)
    >>> flight.step(250)
    >>> flight.time_s
    1.0
    """

    def __init__(
        self,
        aircraft: Aircraft | None = None,
        start: str = "runway",
        scenario: str | None = None,
        trim: Condition | None = None,
    ) -> None:
        self.aircraft = aircraft or Aircraft()
        if trim is not None:
            scenario = self.aircraft._held.scenario_in_trim(
                scenario or _native.Flight.scenario(start), **trim
            )
        self._held = _native.Flight(self.aircraft._held, start, scenario)

    @classmethod
    def _over(cls, native: _native.Flight) -> Flight:
        flight = cls.__new__(cls)
        flight.aircraft = Aircraft._over(native.aircraft)
        flight._held = native
        return flight

    @classmethod
    def from_log(cls, path: str | PathLike[str], tick: int | None = None) -> Flight:
        """Goes on from a tick of a log (its first one without), by your hands.

        Weather and failures are those of the log; pause and commands to the actuators are not taken over. A log that is
        recorded before the first step names that one as its parent; one begun later, or of a pickled flight, does not.
        """
        return cls._over(_native.Flight.from_log(fspath(path), tick))

    @property
    def tick(self) -> int:
        """Ticks flown."""
        return self._held.tick

    @property
    def time_s(self) -> float:
        """Time flown, s."""
        return self._held.tick * _native.STEP_S

    def controls(self) -> dict[str, tuple[float, float, str]]:
        """The controls by name: lower and upper end, and what each is."""
        return {name: (low, 1.0, what) for name, low, what in self._held.controls()}

    def set(self, **controls: float) -> None:
        """Moves controls with the next step.

        ``stick_aft``, ``stick_right``, ``pedal_right`` from −1 to 1, ``collective``, ``brake_left`` and ``brake_right``
        from 0 to 1. They stay there.
        """
        # By name, as the events of a script are: the same movements are the same log.
        for name in sorted(controls):
            self._held.set_control(name, float(controls[name]))

    def press(self, button: str) -> None:
        """Presses a button and lets it go, with the next step: ``marker``, ``flap_down``, ``gear_toggle``…"""
        self._held.button(button, True)
        self._held.button(button, False)

    def hold(self, button: str) -> None:
        """Presses a button until :meth:`release`: ``nacelle_forward``, ``nacelle_aft``…"""
        self._held.button(button, True)

    def release(self, button: str) -> None:
        """Lets a button go."""
        self._held.button(button, False)

    def fail(self, *failures: str) -> None:
        """Failures from the next step on: ``engine_left``, ``scas_yaw``…"""
        for failure in failures:
            self._held.fail(failure, True)

    def mend(self, *failures: str) -> None:
        """Ends failures."""
        for failure in failures:
            self._held.fail(failure, False)

    def wind(self, from_deg: float, kt: float) -> None:
        """Steady wind from a true direction, deg, at a speed, kt."""
        self._held.wind(from_deg, kt)

    def turbulence(self, mps: float) -> None:
        """Vertical intensity of the turbulence, m/s; 0 for still air."""
        self._held.turbulence(mps)

    def computer_commands(self) -> dict[str, float]:
        """What the aircraft's own computer asks the actuators for now, whoever commands them.

        Angles are in rad, lever, brakes and nacelle switch in parts of their travel. With the SCAS off, or its axes
        failed, it is what the grips alone ask for: the base for a SCAS of one's own.
        """
        return self._held.computer_commands()

    def drive_actuators(self, commands: Mapping[str, float]) -> None:
        """Commands the actuators in place of the flight control computer, from the next step on.

        Keys are those of :meth:`computer_commands`. What is not named stays as it was asked for last. The commands are
        recorded as inputs: the log says that somebody else flew, and reflies exactly without him.
        """
        self._held.drive_actuators(dict(commands))

    def release_actuators(self) -> None:
        """Gives the actuators back to the flight control computer."""
        self._held.drive_actuators(None)

    def step(self, ticks: int = 1) -> None:
        """Flies so many ticks of 4 ms. Ctrl-C is answered within some ten milliseconds.

        Raises TiltrotorError when the log cannot be written any further: it ends there, never closed, and the flight
        goes on without one.
        """
        self._held.step(ticks)

    def fly(self, table: Iterable[Mapping[str, float]]) -> None:
        """Flies a table: every row has ``time_s``, until when it flies, and the controls that it moves before."""
        for line in table:
            until = round(line["time_s"] / _native.STEP_S)
            if until < self.tick:
                raise _native.TiltrotorError(
                    f"time_s {line['time_s']}: the flight is at {self.time_s:.3f} s already"
                )
            self.set(**{name: value for name, value in line.items() if name != "time_s"})
            self.step(until - self.tick)

    @property
    def state(self) -> np.void:
        """The state after the last step: ``state["plant.fuel_kg"]``, exact."""
        return row("state", self._held.state())

    @property
    def outputs(self) -> np.void:
        """What could be observed after the last step: ``outputs["airspeed_mps"]``."""
        return row("outputs", self._held.outputs())

    def copy(self) -> Flight:
        """A second flight from here on, without a log; the same inputs fly it to the same bits."""
        return Flight._over(self._held.copy())

    def record(self, path: str | PathLike[str], force: bool = False) -> None:
        """Records from here on into an MCAP log; with ``force`` one that is there is set aside."""
        self._held.record(fspath(path), force)

    def close(self) -> str | None:
        """Ends the log; the digest of the whole flight, or None when there was no log."""
        return self._held.close()

    def __enter__(self) -> Flight:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:
            self._held.broken_off(issubclass(kind, KeyboardInterrupt))

    def __reduce__(self) -> tuple[Any, ...]:
        """All but the log: the copy goes on to the same bits, in whatever process."""
        return (_resume, self._held.kept())

    def __repr__(self) -> str:
        return f"<tiltrotor.Flight of {self.aircraft.name} at {self.time_s:.3f} s>"


def _resume(aircraft: str, cockpit: str, scenario: str, kept: _native.Kept) -> Flight:
    return Flight._over(_native.Flight.resume(aircraft, cockpit, scenario, kept))

