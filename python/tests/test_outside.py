"""Somebody else's computer commands the actuators; the log says so, and reflies without it."""

from __future__ import annotations

import json

import numpy as np

import tiltrotor


def _scas(flight: tiltrotor.Flight) -> None:
    """Rate damping of one's own over what the grips ask for."""
    commands = flight.computer_commands()
    outputs = flight.outputs
    pitch, roll, yaw = (float(outputs[f"angular_rate_radps.{axis}"]) for axis in "yxz")
    for side, sign in (("left", 1.0), ("right", -1.0)):
        commands[f"cyclic_forward_rad.{side}"] += 0.15 * pitch
        commands[f"collective_rad.{side}"] -= sign * 0.05 * roll
    commands["elevator_rad"] += 0.3 * pitch
    commands["rudder_right_rad"] += 0.3 * -yaw
    flight.drive_actuators(commands)


def _hover_without_scas() -> tiltrotor.Flight:
    flight = tiltrotor.Flight(start="hover-50ft")
    flight.fail("scas_pitch", "scas_roll", "scas_yaw")
    return flight


def _kick(flight: tiltrotor.Flight, tick: int) -> None:
    if tick == 125:
        flight.set(stick_aft=0.2)
    if tick == 187:
        flight.set(stick_aft=0.0)


def test_a_scas_in_python_flies_and_its_log_reflies_without_it(tmp_path, command, judged):
    log = tmp_path / "outside.mcap"
    flight = _hover_without_scas()
    flight.record(log)
    for tick in range(1000):
        _kick(flight, tick)
        if tick < 900:
            _scas(flight)
        elif tick == 900:
            flight.release_actuators()
        flight.step()
    digest = flight.close()
    verdict = tiltrotor.verify(log)
    assert verdict and verdict.digest == digest == judged(log)["digest"]
    said = command("log", "info", log)
    assert said.returncode == 0
    assert "0.000 s  actuators: commanded from outside" in said.stdout
    assert "3.600 s  actuators: commanded by the flight control computer" in said.stdout
    levels = tiltrotor.read(log, "inputs")["world.input_level"]
    assert levels.tolist() == [1] * 900 + [0] * 100
    events = command("log", "cat", log, "--channel", "events").stdout.splitlines()
    kinds = [json.loads(line)["kind"] for line in events]
    assert kinds.count(23) == 2


def test_it_damps_what_nothing_damps_without_it():
    rates = {}
    for with_scas in (False, True):
        flight, sum_of_squares = _hover_without_scas(), 0.0
        for tick in range(1000):
            _kick(flight, tick)
            if with_scas:
                _scas(flight)
            flight.step()
            sum_of_squares += float(flight.outputs["angular_rate_radps.y"]) ** 2
        rates[with_scas] = sum_of_squares
    assert rates[True] < 0.8 * rates[False], rates


def test_the_computers_own_commands_given_from_outside_fly_the_same_flight():
    own, outside = tiltrotor.Flight(start="hover-50ft"), tiltrotor.Flight(start="hover-50ft")
    for tick in range(500):
        for flight in (own, outside):
            _kick(flight, tick)
        # What is moved with this step is not in them yet: the grips act a tick later.
        own.step()
        outside.drive_actuators({name: own.outputs[f"commands.{name}"] for name in outside.computer_commands()})
        outside.step()
    names = [name for name in own.state.dtype.names if name.startswith("plant.")]
    assert all(own.state[name] == outside.state[name] for name in names)


def test_what_is_not_named_stays_as_it_was_asked_for():
    flight = tiltrotor.Flight(start="hover-50ft")
    before = flight.outputs
    flight.drive_actuators({"elevator_rad": 0.05})
    flight.step()
    flight.drive_actuators({"rudder_right_rad": np.float64(0.02)})
    flight.step()
    now = flight.outputs
    assert now["commands.elevator_rad"] == 0.05
    assert now["commands.rudder_right_rad"] == 0.02
    assert now["commands.collective_rad.left"] == before["commands.collective_rad.left"]
