"""What tests/fmu.sh checks of the FMU, flown by FMPy. Usage: fmu.py TILTROTOR FOLDER-OF-FMUS SCRATCH"""

import contextlib
import io
import json
import shutil
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
from fmpy.simulation import instantiate_fmu
from fmpy.validation import validate_fmu

TILTROTOR, FMUS, SCRATCH = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
STEP_S = 0.004
TICKS = 2500


def moved():
    """The inputs of fmi/examples/native.rs, a row a tick, beside where the controls stand at the start."""
    kinds = [("stick_aft", "f8"), ("collective", "f8"), ("pedal_right", "f8")]
    kinds += [("button.nacelle_forward", "?"), ("fail.scas_yaw", "?")]
    rows = np.zeros(TICKS + 1, dtype=[("time", "f8"), *kinds])
    rows["time"] = np.arange(TICKS + 1) * STEP_S
    rows["stick_aft"][125:250] = 0.1
    rows["collective"][500:] = 0.05
    rows["pedal_right"][750:1000] = -0.2
    rows["button.nacelle_forward"][1250:1500] = True
    rows["fail.scas_yaw"][2000:] = True
    return rows


def quiet(call, *arguments, **named):
    """What a call gives, or the exception that it raises, and all that was said."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        try:
            given = call(*arguments, **named)
        except Exception as error:  # noqa: BLE001
            given = error
    return given, said.getvalue()


def flown(fmu, **named):
    """A flight by FMPy; anything that is refused ends the test."""
    result, said = quiet(fmpy.simulate_fmu, str(fmu), **named)
    assert not isinstance(result, Exception), f"{result}\n{said}"
    return result


def verified(log):
    """The command's verdict: exact, or the test ends. Gives the digest."""
    told = subprocess.run([TILTROTOR, "verify", "--format", "json", log], capture_output=True, text=True)
    assert told.returncode == 0, f"{log}: exit {told.returncode}: {told.stdout}{told.stderr}"
    return json.loads(told.stdout)["logs"][0]["digest"]


def same_bits(result, description, native):
    """The outputs of every tick as FMPy recorded them and as the native flight gave them, compared as bits."""
    outputs = [v for v in description.modelVariables if v.causality == "output"]
    code = {"continuous": "<f8", "discrete": "<u8"}
    rows = np.frombuffer(native, dtype=[(v.name, code[v.variability]) for v in outputs])
    assert len(rows) == len(result) == TICKS + 1, (len(rows), len(result))
    moving = 0
    for variable in outputs:
        own, theirs = rows[variable.name], result[variable.name]
        if variable.variability == "continuous":
            own, theirs = own.view("<u8"), np.ascontiguousarray(theirs).view("<u8")
        apart = np.flatnonzero(own != theirs)
        assert not apart.size, f"{variable.name}: apart from tick {apart[0]} on"
        moving += bool(np.ptp(rows[variable.name]))
    # A flight in which nothing moves would compare nothing.
    assert moving > 150, moving
    return len(outputs), moving


class Opened:
    """An instance that is called function by function, the same for both versions."""

    def __init__(self, fmu, **start):
        self.folder = fmpy.extract(str(fmu))
        self.description = fmpy.read_model_description(self.folder)
        self.places = {v.name: v.valueReference for v in self.description.modelVariables}
        self.types = {v.name: v.type for v in self.description.modelVariables}
        self.fmu = instantiate_fmu(self.folder, self.description, "CoSimulation")
        self.is2 = self.description.fmiVersion == "2.0"
        if self.is2:
            self.fmu.setupExperiment(startTime=0.0)
        for name, value in start.items():
            self.set(name, value)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.tick = 0

    def set(self, name, value):
        setters = {"Boolean": "setBoolean", "String": "setString"}
        setter = setters.get(self.types[name], "setReal" if self.is2 else "setFloat64")
        getattr(self.fmu, setter)([self.places[name]], [value])

    def get(self, name):
        return (self.fmu.getReal if self.is2 else self.fmu.getFloat64)([self.places[name]])[0]

    def step(self, ticks=1):
        self.fmu.doStep(self.tick * STEP_S, ticks * STEP_S)
        self.tick += ticks

    def outputs(self):
        places = [v.valueReference for v in self.description.modelVariables if v.causality == "output"]
        return np.array((self.fmu.getReal if self.is2 else self.fmu.getFloat64)(places)).tobytes()

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def check_refusals(fmu, version):
    """What cannot be is refused, and the tool is told why and what to do."""
    nan = moved()
    nan["stick_aft"][100] = np.nan
    cases = [
        (dict(output_interval=0.0033, stop_time=0.1), "multiple of 0.004 s"),
        (dict(input=nan, stop_time=1.0, output_interval=STEP_S), "stick_aft: expected a finite number, got NaN"),
        (dict(start_values={"speed_kt": 390.0}), "steady"),
        (dict(start_values={"speed_kt": 4000.0}), "expected -60 to 400 kt"),
        (dict(start_values={"start": "moon"}), "there are trim, runway"),
        (dict(start_values={"aircraft_file": "/nowhere/xv15.toml"}), "/nowhere/xv15.toml"),
        (dict(start_values={"log_file": "/nowhere/flight.mcap"}), "/nowhere"),
    ]
    for named, words in cases:
        given, said = quiet(fmpy.simulate_fmu, str(fmu), **named)
        assert isinstance(given, Exception), f"FMI {version}: {named}: not refused"
        assert words in said, f"FMI {version}: expected `{words}` in:\n{said}{given}"
        line = next(line for line in said.splitlines() if words in line)
        print(f"  refused: {line}")


def check_states(fmu):
    """Set back to a state and moved in the same way, it flies the same bits."""
    opened = Opened(fmu, start="hover-50ft")
    opened.step(100)
    opened.set("stick_aft", 0.05)
    opened.step(10)
    kept = opened.fmu.getFMUState()
    opened.step(100)
    there = opened.outputs()
    opened.set("stick_aft", -0.3)
    opened.step(50)
    elsewhere = opened.outputs()
    opened.fmu.setFMUState(kept)
    opened.tick = 110
    opened.step(100)
    assert opened.outputs() == there != elsewhere
    opened.fmu.freeFMUState(kept)
    opened.end()

    log = SCRATCH / "no-way-back.mcap"
    opened = Opened(fmu, start="hover-50ft", log_file=str(log))
    kept = opened.fmu.getFMUState()
    opened.fmu.setFMUState(kept)
    opened.step(10)
    given, said = quiet(opened.fmu.setFMUState, kept)
    assert isinstance(given, Exception) and "leave log_file" in said, said
    given, said = quiet(opened.set, "speed_kt", 100.0)
    assert isinstance(given, Exception) and "before the flight begins" in said, said
    opened.fmu.freeFMUState(kept)
    opened.end()
    verified(log)
    log.unlink()


def check_outside(fmu):
    """A pitch damper of one's own drives the actuators in place of the aircraft's computer; the log says so and
    verifies exact."""
    log = SCRATCH / "outside.mcap"
    opened = Opened(fmu, start="hover-50ft", log_file=str(log))
    opened.set("fail.scas_pitch", True)
    opened.set("drive_actuators", True)
    for _ in range(500):
        for side in ("left", "right"):
            opened.set(f"drive.cyclic_forward_rad.{side}", 0.15 * opened.get("angular_rate_radps.y"))
        opened.step()
    opened.end()
    verified(log)
    said = subprocess.run([TILTROTOR, "log", "cat", log, "--channel", "inputs"], capture_output=True, text=True)
    levels = {json.loads(line)["world.input_level"] for line in said.stdout.splitlines()}
    assert levels == {1}, levels
    print("  driven from outside: exact, and the log says so in every tick")
    log.unlink()


def check(version, native):
    fmu = FMUS / f"XV15-fmi{version}.fmu"
    problems = validate_fmu(str(fmu))
    assert not problems, problems
    description = fmpy.read_model_description(str(fmu))
    print(f"FMI {description.fmiVersion}: {len(description.modelVariables)} variables, no problem by fmpy.validation")

    log = SCRATCH / f"fmi{version}.mcap"
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    start = {"start": "hover-50ft", "log_file": str(log)}
    result = flown(fmu, start_values=start, input=moved(), output=names, output_interval=STEP_S, stop_time=10.0)
    outputs, moving = same_bits(result, description, native)
    print(f"  ten seconds: {outputs} outputs, {moving} of them moving, the native bits at {TICKS + 1} points")
    digest = verified(log)

    # Unconnected, in the trim of the parameters: it stays there.
    trim = {"nacelle_deg": 60.0, "speed_kt": 100.0, "altitude_ft": 2000.0}
    some = ["airspeed_mps", "height_above_ground_m"]
    result = flown(fmu, start_values=trim, output=some, output_interval=0.02, stop_time=10.0)
    assert abs(result["airspeed_mps"][0] - 100 * 1852 / 3600) < 1e-6, result["airspeed_mps"][0]
    assert abs(result["airspeed_mps"][-1] - result["airspeed_mps"][0]) < 1.0, result["airspeed_mps"][-1]
    check_refusals(fmu, version)
    check_states(fmu)
    check_outside(fmu)
    return digest


def main():
    native = (SCRATCH / "native").read_bytes()
    digests = [check(version, native) for version in (2, 3)]
    assert digests[0] == digests[1], digests
    print(f"both logs exact, one digest: {digests[0]}")


main()
