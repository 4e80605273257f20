"""What the tests share: the command, flown logs, and the logs that are kept in the tree."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]

#: Flights that are kept, of this version of the flight model and of older ones.
KEPT = sorted([*(ROOT / "tests/golden").glob("*.mcap"), *(ROOT / "tests/corpus").glob("*.mcap")])

#: The same movements as :func:`fly_script`'s, for the command.
SCRIPT = """
[[event]]
at_s = 0.2
axis = { collective = 0.9, stick_aft = -0.1 }

[[event]]
at_s = 1.0
press = ["marker"]

[[event]]
at_s = 1.0
hold = ["nacelle_forward"]
axis = { pedal_right = 0.25, stick_right = 0.05 }

[[event]]
at_s = 2.0
release = ["nacelle_forward"]
fail = ["scas_yaw"]
wind = { from_deg = 250.0, kt = 12.0 }
turbulence_mps = 1.5

[[event]]
at_s = 3.0
mend = ["scas_yaw"]
"""


def fly_script(flight: Any) -> None:
    """Four seconds: what SCRIPT says."""
    flight.step(50)
    flight.set(collective=0.9, stick_aft=-0.1)
    flight.step(200)
    flight.press("marker")
    flight.hold("nacelle_forward")
    # The buttons of a script's event come before its axes.
    flight.set(pedal_right=0.25, stick_right=0.05)
    flight.step(250)
    flight.release("nacelle_forward")
    flight.fail("scas_yaw")
    flight.wind(250.0, 12.0)
    flight.turbulence(1.5)
    flight.step(250)
    flight.mend("scas_yaw")
    flight.step(250)


Command = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def command() -> Command:
    """Runs the command `tiltrotor`."""
    program = os.environ["TILTROTOR"]

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [program, *map(str, arguments)], capture_output=True, text=True, check=False
        )

    return run


@pytest.fixture(scope="session")
def judged(command: Command) -> Callable[[Path], dict[str, Any]]:
    """What the command's `verify` says of a log, and its exit status."""

    def judge(log: Path) -> dict[str, Any]:
        said = command("verify", "--format", "json", log)
        report: dict[str, Any] = json.loads(said.stdout)
        return {**report["logs"][0], "exit status": said.returncode}

    return judge


@pytest.fixture(scope="session")
def hover(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of four seconds, flown from Python."""
    import tiltrotor

    log = tmp_path_factory.mktemp("hover") / "hover.mcap"
    with tiltrotor.Flight(start="hover-50ft") as flight:
        flight.record(log)
        fly_script(flight)
    return log
