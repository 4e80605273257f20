"""A flight from Python is the flight that the command flies."""

from __future__ import annotations

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
