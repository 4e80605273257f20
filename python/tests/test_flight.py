"""A flight from Python is the flight that the command flies."""

from __future__ import annotations

import os
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import SCRIPT, fly_script

import tiltrotor


def test_the_same_inputs_give_the_digest_that_the_command_gives(tmp_path, command, judged):
    (tmp_path / "script.toml").write_text(SCRIPT)
    by_command = tmp_path / "command.mcap"
    said = command(
        *("fly", "--script", tmp_path / "script.toml", "--fast", "--no-flightgear"),
        *("--start", "hover-50ft", "--duration", 4, "--out", by_command),
    )
    assert said.returncode == 0, said.stderr
    flight = tiltrotor.Flight(start="hover-50ft")
    flight.record(tmp_path / "python.mcap")
    fly_script(flight)
    digest = flight.close()
    assert flight.close() is None
    assert judged(by_command)["digest"] == digest
    from_python = judged(tmp_path / "python.mcap")
    assert (from_python["outcome"], from_python["digest"]) == ("exact", digest)


def test_a_start_in_trim_is_the_commands(tmp_path, command, judged):
    by_command = tmp_path / "command.mcap"
    said = command(
        *("fly", "--from-trim", "--nacelle", 75, "--speed-kt", 90, "--altitude-ft", 3000),
        *("--fast", "--no-flightgear", "--duration", 1, "--out", by_command),
        *("--script", _nothing(tmp_path)),
    )
    assert said.returncode == 0, said.stderr
    trim = {"nacelle_deg": 75, "speed_kt": 90, "altitude_ft": 3000, "scas_on": True}
    flight = tiltrotor.Flight(trim=trim)
    flight.record(tmp_path / "python.mcap")
    flight.step(250)
    assert flight.close() == judged(by_command)["digest"]
    assert tiltrotor.verify(tmp_path / "python.mcap")
    # It stays where it is.
    assert abs(flight.outputs["airspeed_mps"] - 90 * 1852 / 3600) < 0.1


def _nothing(folder: Path) -> Path:
    (folder / "nothing.toml").write_text("")
    return folder / "nothing.toml"


def test_a_copy_and_the_same_inputs_give_the_same_bits():
    flight = tiltrotor.Flight(start="hover-50ft")
    flight.set(collective=0.8)
    flight.step(100)
    flight.set(stick_aft=0.2)
    copies = [flight.copy(), pickle.loads(pickle.dumps(flight))]
    for each in (flight, *copies):
        fly_script(each)
    for copy in copies:
        assert copy.tick == flight.tick
        assert copy.state.tobytes() == flight.state.tobytes()
        assert copy.outputs.tobytes() == flight.outputs.tobytes()
    copies[0].set(stick_aft=-1.0)
    for each in (flight, copies[0]):
        each.step(50)
    assert copies[0].state.tobytes() != flight.state.tobytes()


def test_in_one_go_or_tick_by_tick_is_the_same():
    one, other = tiltrotor.Flight(), tiltrotor.Flight()
    one.fly([{"time_s": 0.4, "collective": 0.5}, {"time_s": 1.0, "stick_aft": 0.1}])
    other.set(collective=0.5)
    for _ in range(100):
        other.step()
    other.set(stick_aft=0.1)
    for _ in range(150):
        other.step()
    assert one.state.tobytes() == other.state.tobytes()
    assert one.time_s == pytest.approx(1.0)


def test_a_flight_goes_on_from_a_tick_of_a_log(tmp_path, hover):
    flight = tiltrotor.Flight.from_log(hover, tick=500)
    there = tiltrotor.read(hover, "state", 500, 500)[0]
    assert all(flight.state[name] == there[f"state.{name}"] for name in flight.state.dtype.names)
    flight.record(tmp_path / "on.mcap")
    flight.set(stick_aft=0.5)
    flight.step(100)
    flight.close()
    verdict = tiltrotor.verify(tmp_path / "on.mcap")
    assert (bool(verdict), verdict.start_tick, verdict.last_tick) == (True, 500, 600)
    assert tiltrotor.facts(tmp_path / "on.mcap")["parent"] == hover.name


def _answers(flight: tiltrotor.Flight) -> bool:
    """Whether the stick moves the aircraft's controls."""
    other = flight.copy()
    other.set(stick_aft=0.6)
    for each in (flight, other):
        each.step(50)
    return bool(flight.outputs["commands.elevator_rad"] != other.outputs["commands.elevator_rad"])


def test_who_goes_on_from_a_log_has_the_controls(tmp_path):
    """Whoever commanded the actuators in the log, at whatever tick; weather and failures stay."""
    log = tmp_path / "outside.mcap"
    with tiltrotor.Flight(start="hover-50ft") as flight:
        flight.record(log)
        flight.step(50)
        flight.wind(250.0, 12.0)
        flight.fail("scas_yaw")
        flight.drive_actuators({"elevator_rad": 0.1})
        flight.step(50)
    for tick in (20, 70, 100):
        flight = tiltrotor.Flight.from_log(log, tick)
        flight.record(tmp_path / f"on-{tick}.mcap")
        assert _answers(flight), tick
        flight.close()
        world = tiltrotor.read(tmp_path / f"on-{tick}.mcap", "inputs")[0]
        assert world["world.input_level"] == world["world.paused"] == 0
        assert (world["world.wind_mps.x"] != 0.0) == (world["world.failures"] != 0) == (tick >= 50), tick


def test_a_paused_log_goes_on(tmp_path, command):
    (tmp_path / "paused.toml").write_text("[[event]]\nat_s = 0.2\npause = true\n")
    log = tmp_path / "paused.mcap"
    said = command(
        *("fly", "--script", tmp_path / "paused.toml", "--fast", "--no-flightgear"),
        *("--start", "hover-50ft", "--duration", 1, "--out", log),
    )
    assert said.returncode == 0, said.stderr
    assert tiltrotor.read(log, "inputs")["world.paused"][-1] == 1
    for tick in (100, 250):
        assert _answers(tiltrotor.Flight.from_log(log, tick)), tick


@pytest.mark.skipif(os.name != "posix", reason="files have no limits elsewhere")
def test_a_log_that_cannot_be_written_stays_never_closed(tmp_path):
    """There is room again later: what lacks ticks must not look whole then."""
    import resource

    log = tmp_path / "full.mcap"
    flight = tiltrotor.Flight(start="hover-50ft")
    flight.record(log)
    flight.step(1000)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (log.stat().st_size + 1000, before[1]))
    try:
        with pytest.raises(tiltrotor.TiltrotorError):
            flight.step(5000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    flight.step(100)
    assert flight.close() is None
    verdict = tiltrotor.verify(log)
    assert (bool(verdict), verdict.diverged_tick) == (False, None)
    assert verdict.outcome in ("never_closed", "damaged"), verdict.report


@pytest.mark.parametrize(("raised", "words"), [(ValueError, "ended by the crew"), (KeyboardInterrupt, "SIGINT")])
def test_a_flight_that_was_broken_off_says_so(tmp_path, command, raised, words):
    log = tmp_path / "flight.mcap"
    with pytest.raises(raised), tiltrotor.Flight(start="hover-50ft") as flight:
        flight.record(log)
        flight.step(10)
        raise raised
    assert tiltrotor.verify(log)
    said = command("log", "find", log)
    assert words in said.stdout, said
    assert "the pilot model or script has ended" not in said.stdout


def test_the_log_says_which_program_flew(hover):
    facts = tiltrotor.facts(hover)
    assert facts["program"] == f"tiltrotor (Python) {tiltrotor.__version__}"
    assert re.fullmatch(r"[0-9a-f]{12}|unknown", facts["commit"])
    assert facts["dirty"] in ("true", "false", "unknown")
    assert "rustc" in facts["compiler"]
    assert facts["commit"] in tiltrotor.BUILD
    assert facts["aircraft.toml"] == tiltrotor.Aircraft().toml


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda f: f.set(stick_aft=1.5), "stick_aft: expected -1 to 1, got 1.5"),
        (lambda f: f.set(collective=float("nan")), "collective: expected 0 to 1"),
        (lambda f: f.set(rudder=0.1), "rudder: no such control; there are stick_aft"),
        (lambda f: f.press("horn"), "horn: no such button"),
        (lambda f: f.fail("luck"), "luck: no such failure; there are engine_left"),
        (lambda f: f.wind(0, 900), "expected 0 to 200 kt"),
        (lambda f: f.turbulence(-1), "expected 0 to 15 m/s"),
        (lambda f: f.drive_actuators({"elevator": 0.0}), "elevator: no such command"),
        (lambda f: f.drive_actuators({"elevator_rad": np.inf}), "expected a finite number"),
        (lambda f: f.record("/nowhere/at/all.mcap"), "/nowhere/at/all.mcap"),
        (lambda _: tiltrotor.Flight(start="moon"), "no position is called moon"),
        (lambda _: tiltrotor.Flight(scenario="fuel_lb = 1"), "scenario.toml"),
        (lambda _: tiltrotor.Flight.from_log("nowhere.mcap"), "nowhere.mcap"),
    ],
)
def test_what_cannot_be_is_refused_in_words(wrong, words):
    flight = tiltrotor.Flight()
    before = flight.state.tobytes()
    with pytest.raises(tiltrotor.TiltrotorError, match=re.escape(words)):
        wrong(flight)
    assert flight.state.tobytes() == before


def test_an_existing_log_is_not_overwritten_unless_forced(tmp_path, hover):
    log = tmp_path / "flight.mcap"
    log.write_bytes(hover.read_bytes())
    flight = tiltrotor.Flight()
    with pytest.raises(tiltrotor.TiltrotorError, match=r"flight\.mcap"):
        flight.record(log)
    assert log.read_bytes() == hover.read_bytes()
    flight.record(log, force=True)
    with pytest.raises(tiltrotor.TiltrotorError, match="being recorded already"):
        flight.record(tmp_path / "other.mcap")
    flight.step(10)
    flight.close()
    assert tiltrotor.verify(log)
