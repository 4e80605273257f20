"""Flight logs: what they are, the numbers in them, and what is made of them by flying them again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._arrays import rows
from ._native import TiltrotorError, Verdict

Path = str | PathLike[str]

_END = 2**64 - 1


class Channel(NamedTuple):
    """A channel of a log."""

    messages: int
    """How many it has."""
    units: dict[str, str]
    """Its fields and their units, empty where there is none."""


class Response(NamedTuple):
    """A frequency response from a flight; arrays are of shape (n,), one element a frequency."""

    input: str
    output: str
    unit: str
    """Of the response: the output's over the input's."""
    frequency_radps: NDArray[np.float64]
    response: NDArray[np.complex128]
    coherence: NDArray[np.float64]
    """0 to 1: how much of the output is this input's."""
    gain_error_norm: NDArray[np.float64]
    """Random error of the gain, a part of it."""
    segment_s: NDArray[np.float64]
    """Length of the segments, s."""
    verdict: Verdict
    """What the log is."""


def verify(
    path: Path,
    threads: int | None = None,
    from_tick: int | None = None,
    until_tick: int | None = None,
    across_versions: bool = False,
) -> Verdict:
    """Reflies a log and compares every bit of every state; the verdict is true when the log is exact.

    It is the verdict of ``tiltrotor verify``. ``threads`` is one a processor without; what comes out is the same.
    """
    return _native.verify(fspath(path), threads, from_tick, until_tick, across_versions)


def channels(path: Path) -> dict[str, Channel]:
    """The channels of a log that hold numbers."""
    found = _native.channels(fspath(path))
    return {name: Channel(count, dict(fields)) for name, (count, fields) in found.items()}


def facts(path: Path) -> dict[str, str]:
    """What a log says of itself: who flew, by which program; aircraft, cockpit map and scenario as texts."""
    return _native.facts(fspath(path))


def read(
    path: Path,
    channel: str,
    from_tick: int = 0,
    until_tick: int | None = None,
    partial: bool = False,
) -> NDArray[np.void]:
    """A channel of a log as a structured array, a row a message: ``read(log, "state")["state.plant.fuel_kg"]``.

    Channels are ``state``, ``inputs``, ``hardware``, ``timing``, ``events``, ``outputs``, ``restart``; ``time_ns`` comes
    first. The bits are those of the file, whatever version wrote it; compacted logs are flown while they are read.

    Raises TiltrotorError for a damaged log, unless ``partial`` asks for what is before the damage.
    """
    until = _END if until_tick is None else until_tick
    times, data, fields, damage = _native.messages(fspath(path), channel, from_tick, until)
    if damage is not None and not (partial and fields):
        raise TiltrotorError(f"{fspath(path)}: damaged: {damage}")
    return rows([("time_ns", "<u8"), *fields], _beside(times, data, len(fields)))


def _beside(times: bytes, data: bytes, fields: int) -> bytes:
    """Each row's time in front of its numbers, all of them eight bytes."""
    count = len(times) // 8
    words = np.empty((count, fields + 1), dtype="<u8")
    words[:, 0] = np.frombuffer(times, dtype="<u8")
    words[:, 1:] = np.frombuffer(data, dtype="<u8").reshape(count, fields)
    return words.tobytes()


def refly(
    path: Path,
    what: Literal["state", "outputs"] = "outputs",
    from_tick: int | None = None,
    until_tick: int | None = None,
    every: int = 1,
) -> NDArray[np.void]:
    """States or outputs of every tick of a log, flown again: a log holds the outputs of one tick in ten only.

    Raises TiltrotorError when the log does not refly to the same bits: :func:`verify` says more.
    """
    data, fields, diverged = _native.refly(fspath(path), what, from_tick, until_tick, every)
    if diverged is not None:
        raise TiltrotorError(
            f"{fspath(path)}: it does not refly to the same bits from tick {diverged} on; tiltrotor.verify says more"
        )
    return rows(fields, data)


def whatif(
    log: Path,
    out: Path,
    *,
    set: Mapping[str, float | str] | None = None,
    world: Mapping[str, float] | None = None,
    fail: Iterable[str] = (),
    mend: Iterable[str] = (),
    from_tick: int = 0,
    until_tick: int | None = None,
    force: bool = False,
) -> Verdict:
    """Flies the recorded inputs of a log with something changed, into a new log; returns what that one is.

    ``set`` changes numbers of the aircraft file, ``world`` numbers of the recorded world (``wind_mps.x``, ``gust_mps.z``,
    ``turbulence_mps``…); ``fail`` and ``mend`` are failures. What changes of the world changes from ``from_tick`` on.
    """
    return _native.whatif(
        fspath(log),
        fspath(out),
        [(key, str(value)) for key, value in (set or {}).items()],
        [f"{key}={float(value)!r}" for key, value in (world or {}).items()],
        list(fail),
        list(mend),
        from_tick,
        until_tick,
        force,
    )


def identify(
    log: Path,
    input: str,
    output: str,
    *,
    low_radps: float | None = None,
    high_radps: float | None = None,
    per_decade: float | None = None,
    segment_s: float | None = None,
    from_tick: int | None = None,
    until_tick: int | None = None,
) -> Response:
    """The frequency response of one signal of a log to another, as ``tiltrotor identify``.

    Signals are the inputs and outputs of ``linearize`` (``stick_aft``, ``pitch_rate``), or numbers of the state.
    """
    named_input, named_output, points, verdict = _native.identify(
        fspath(log),
        input,
        output,
        low_radps,
        high_radps,
        per_decade,
        segment_s,
        from_tick,
        until_tick,
    )
    numbers = np.array(points, dtype=np.float64).reshape(len(points), 6)
    unit = "" if named_input[1] == named_output[1] else f"{named_output[1]}/{named_input[1]}"
    return Response(
        named_input[0],
        named_output[0],
        unit,
        numbers[:, 0],
        numbers[:, 1] + 1j * numbers[:, 2],
        numbers[:, 3],
        numbers[:, 4],
        numbers[:, 5],
        verdict,
    )
