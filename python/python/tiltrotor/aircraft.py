"""An aircraft, its steady flights, and small motions about them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import _native

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Condition(TypedDict, total=False):
    """Which steady flight: the options of ``tiltrotor trim``, with the same defaults and ranges."""

    nacelle_deg: float
    """Nacelle incidence, deg: 90 helicopter (default), 0 aeroplane."""
    speed_kt: float
    """True airspeed, kt."""
    climb_fpm: float
    """Rate of climb, ft/min."""
    lever_percent: float | None
    """Power lever instead of a rate of climb, % of its travel: the climb follows."""
    turn_degps: float
    """Rate of turn, right positive, deg/s."""
    bank_deg: float | None
    """Bank of a turn, right positive, deg; instead of its rate."""
    sideslip_deg: float
    """Sideslip, air from the right positive, deg."""
    weight_lb: float
    """Gross weight, lb; with full tanks by default (13,000 for the XV-15)."""
    altitude_ft: float
    """Above mean sea level, ft."""
    height_ft: float | None
    """Centre of gravity above the ground, ft; the ground is not felt without."""
    isa_k: float
    """Warmer than the standard atmosphere by, K."""
    flap_deg: float | None
    """Flap lever, one of its detents, deg."""
    rpm: float | None
    """Rotor speed, one of those the governor offers, rpm."""
    gear_down: bool
    """Gear down."""
    scas_on: bool
    """SCAS on, centred."""


class Trim(Mapping[str, float]):
    """A steady flight: its numbers by name, the unit in the name, as ``tiltrotor trim --csv`` has them.

    ``trim["power_kw"]``, ``trim["pitch_deg"]``…; ``print(trim)`` lists them as the command does.
    """

    def __init__(self, numbers: dict[str, float], words: list[tuple[str, str, str]]) -> None:
        self._numbers, self._words = numbers, words

    def __getitem__(self, key: str) -> float:
        try:
            return self._numbers[key]
        except KeyError:
            raise KeyError(f"{key}; there are {', '.join(self._numbers)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)

    def __str__(self) -> str:
        return "\n".join(f"{name:<14} {value:>9} {unit}" for name, value, unit in self._words)

    def __repr__(self) -> str:
        told = ", ".join(f"{name} {value} {unit}" for name, value, unit in self._words[:4])
        return f"<tiltrotor.Trim {told}…>"


class Mode(NamedTuple):
    """A motion of its own of a linear system."""

    name: str
    """What it is called."""
    eigenvalue: complex
    """λ, 1/s and rad/s; of a pair the one above."""
    fast: bool
    """Rotors, inflow, actuators: of no interest to a pilot."""


class Linear:
    """Small motions about a steady flight: x' = A x + B u, y = C x + D u, in SI units and radians.

    ``A`` (n, n), ``B`` (n, m), ``C`` (p, n), ``D`` (p, m) are arrays of doubles. ``states``, ``inputs`` and ``outputs``
    name their rows and columns, units last. Inputs are travels of the grips.
    """

    A: NDArray[np.float64]
    B: NDArray[np.float64]
    C: NDArray[np.float64]
    D: NDArray[np.float64]

    def __init__(self, found: _native.Linear) -> None:
        self.states: list[str] = found.states
        self.inputs: list[str] = found.inputs
        self.outputs: list[str] = found.outputs
        self.A, self.B, self.C, self.D = (_matrix(found, name) for name in "ABCD")
        #: Eigenvalues of A from the slowest, 1/s; shape (n,).
        self.eigenvalues: NDArray[np.complex128] = np.array(
            [complex(*pair) for pair in found.eigenvalues()]
        )
        #: The modes from the slowest, a pair as one.
        self.modes: list[Mode] = [
            Mode(name, complex(real, imaginary), fast)
            for name, real, imaginary, fast in found.modes()
        ]

    def __repr__(self) -> str:
        n, m, p = len(self.states), len(self.inputs), len(self.outputs)
        return f"<tiltrotor.Linear of {n} states, {m} inputs, {p} outputs>"


def _matrix(found: _native.Linear, name: str) -> NDArray[np.float64]:
    rows, columns, numbers = found.matrix(name)
    return np.array(numbers, dtype=np.float64).reshape(rows, columns)


class Aircraft:
    """An aircraft file that was read; the XV-15 without a path. It never changes."""

    _held: _native.Aircraft

    def __init__(self, path: str | PathLike[str] | None = None) -> None:
        self._held = _native.Aircraft(None if path is None else fspath(path))

    @classmethod
    def from_toml(cls, toml: str) -> Aircraft:
        """Of the text of an aircraft file."""
        return cls._over(_native.Aircraft.from_toml(toml))

    @classmethod
    def _over(cls, native: _native.Aircraft) -> Aircraft:
        aircraft = cls.__new__(cls)
        aircraft._held = native
        return aircraft

    @property
    def name(self) -> str:
        """What it is called."""
        return self._held.name

    @property
    def toml(self) -> str:
        """The aircraft file, as a flight's log carries it."""
        return self._held.toml

    def values(self) -> dict[str, str]:
        """Every number that :meth:`with_` can change, by its key (the unit is in the key), as the file has it."""
        return dict(self._held.values())

    def with_(
        self, changes: Mapping[str, float | str], source: str = "changed in Python"
    ) -> Aircraft:
        """The same aircraft with numbers changed; ``source`` is written beside each of them.

        Raises KeyError for a key that there is not, TiltrotorError for a number that cannot be.
        """
        texts = [(key, str(value)) for key, value in changes.items()]
        return Aircraft._over(self._held.with_(texts, source))

    def trim(self, **condition: Unpack[Condition]) -> Trim:
        """A steady flight; raises NoSteadyFlight where there is none, or the aircraft cannot fly it."""
        found = self._held.trim(**condition)
        return Trim(dict(found.numbers()), found.words())

    def linearize(self, **condition: Unpack[Condition]) -> Linear:
        """Small motions about the steady flight of :meth:`trim`."""
        return Linear(self._held.linearize(**condition))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Aircraft.from_toml, (self.toml,))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Aircraft) and other.toml == self.toml

    def __hash__(self) -> int:
        return hash(self.toml)

    def __repr__(self) -> str:
        return f"<tiltrotor.Aircraft {self.name}>"
