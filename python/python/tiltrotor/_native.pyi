"""What the package is made of. Use the package itself."""

from typing import Any, final

__version__: str
BUILD: str
"""Version and commit that it was built from."""
STEP_S: float
"""A tick, s."""
STARTS: list[tuple[str, str]]
"""Start positions: name, and what each is."""

Kept = tuple[bytes, bytes, bytes, list[tuple[int, int]], list[tuple[str, float]]]
Fields = list[tuple[str, str]]

class TiltrotorError(Exception):
    """What the simulator cannot do, in words."""

class NoSteadyFlight(TiltrotorError):
    """There is no such steady flight, or the aircraft cannot fly it."""

@final
class Aircraft:
    name: str
    toml: str
    def __init__(self, path: str | None = None) -> None: ...
    @staticmethod
    def from_toml(toml: str, name: str = "aircraft.toml") -> Aircraft: ...
    def values(self) -> list[tuple[str, str]]: ...
    def with_(self, changes: list[tuple[str, str]], source: str) -> Aircraft: ...
    def trim(self, **condition: float | bool | None) -> Trim: ...
    def linearize(self, **condition: float | bool | None) -> Linear: ...
    def scenario_in_trim(self, scenario: str, **condition: float | bool | None) -> str: ...

@final
class Trim:
    def numbers(self) -> list[tuple[str, float]]: ...
    def words(self) -> list[tuple[str, str, str]]: ...

@final
class Linear:
    states: list[str]
    inputs: list[str]
    outputs: list[str]
    def matrix(self, name: str) -> tuple[int, int, list[float]]: ...
    def eigenvalues(self) -> list[tuple[float, float]]: ...
    def modes(self) -> list[tuple[str, float, float, bool]]: ...

@final
class Flight:
    tick: int
    aircraft: Aircraft
    def __init__(self, aircraft: Aircraft, start: str, scenario: str | None) -> None: ...
    @staticmethod
    def from_log(path: str, tick: int | None) -> Flight: ...
    @staticmethod
    def scenario(start: str) -> str: ...
    @staticmethod
    def fields(which: str) -> Fields: ...
    @staticmethod
    def resume(aircraft: str, cockpit: str, scenario: str, kept: Kept) -> Flight: ...
    def kept(self) -> tuple[str, str, str, Kept]: ...
    def controls(self) -> list[tuple[str, float, str]]: ...
    def set_control(self, control: str, position: float) -> None: ...
    def button(self, control: str, pressed: bool) -> None: ...
    def fail(self, key: str, failed: bool) -> None: ...
    def wind(self, from_deg: float, kt: float) -> None: ...
    def turbulence(self, mps: float) -> None: ...
    def computer_commands(self) -> dict[str, float]: ...
    def drive_actuators(self, commands: dict[str, float] | None) -> None: ...
    def step(self, ticks: int = 1) -> None: ...
    def state(self) -> bytes: ...
    def outputs(self) -> bytes: ...
    def copy(self) -> Flight: ...
    def record(self, path: str, force: bool) -> None: ...
    def close(self) -> str | None: ...
    def broken_off(self, by_signal: bool) -> None: ...

@final
class Verdict:
    """What a log is; true when it is exact. ``print(verdict)`` says all that ``tiltrotor verify`` says."""

    outcome: str
    """exact, never_closed, damaged, altered, diverged, outputs_differ, compared, unusable."""
    words: str
    """The same in a sentence."""
    report: str
    """All that there is to say, with the first difference and how it grows."""
    first_bad_tick: int | None
    """The first tick that is not as it should be, or that the log lacks."""
    start_tick: int | None
    """The tick that the log begins with."""
    exact_tick: int | None
    """Up to there it is proven exact."""
    last_tick: int | None
    """The last tick in the log."""
    diverged_tick: int | None
    """The first tick whose reflown state is not the recorded one."""
    field: str | None
    """The first field of the state that differs."""
    end: str | None
    """How its reading ended: closed, window, never_closed, recovered, damaged, disorder."""
    digest: str | None
    """Of the last tick read, 16 hexadecimal digits."""
    @property
    def status(self) -> int:
        """The exit status of ``tiltrotor verify``: 0 exact, 1 differs, 2 unusable, 3 never closed, 6 compared."""
    def __bool__(self) -> bool: ...
    def __eq__(self, other: object) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def verify(
    path: str,
    threads: int | None,
    from_tick: int | None,
    until_tick: int | None,
    across_versions: bool,
) -> Verdict: ...
def channels(path: str) -> dict[str, tuple[int, list[tuple[str, str]]]]: ...
def facts(path: str) -> dict[str, str]: ...
def messages(
    path: str, channel: str, from_tick: int, until_tick: int
) -> tuple[bytes, bytes, Fields, str | None]: ...
def refly(
    path: str, which: str, from_tick: int | None, until_tick: int | None, every: int
) -> tuple[bytes, Fields, int | None]: ...
def whatif(
    log: str,
    out: str,
    set: list[tuple[str, str]],
    world: list[str],
    fail: list[str],
    mend: list[str],
    from_tick: int,
    until_tick: int | None,
    force: bool,
) -> Verdict: ...
def identify(
    log: str,
    input: str,
    output: str,
    low_radps: float | None,
    high_radps: float | None,
    per_decade: float | None,
    segment_s: float | None,
    from_tick: int | None,
    until_tick: int | None,
) -> tuple[
    tuple[str, str],
    tuple[str, str],
    list[tuple[float, float, float, float, float, float]],
    Verdict,
]: ...
