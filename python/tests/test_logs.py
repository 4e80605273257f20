"""Logs read and judged in Python are what the command reads and judges."""

from __future__ import annotations

import json
import pickle
import struct
from pathlib import Path

import numpy as np
import pytest
from conftest import KEPT, ROOT

import tiltrotor

GOLDEN = ROOT / "tests/golden/landing.mcap"


def _cat(command, log: Path, channel: str) -> list[dict[str, float]]:
    said = command("log", "cat", log, "--channel", channel)
    return [json.loads(line) for line in said.stdout.splitlines()]


@pytest.mark.parametrize("channel", ["state", "inputs", "hardware", "outputs", "events"])
@pytest.mark.parametrize("which", ["flown", "compacted", "older"])
def test_what_is_read_is_what_log_cat_prints_to_the_bit(command, hover, which, channel):
    older = ROOT / "tests/corpus/model-2.mcap"
    log = {"flown": hover, "compacted": GOLDEN, "older": older}[which]
    printed = _cat(command, log, channel)
    rows = tiltrotor.read(log, channel)
    assert len(rows) == len(printed) > 0
    for row, line in zip(rows, printed, strict=True):
        assert line.pop("topic") == f"/{channel}"
        assert list(line) == list(row.dtype.names)
        for name, number in line.items():
            kind = row.dtype[name].kind
            bits = struct.pack("<d", float(number)) if kind == "f" else int(number).to_bytes(
                8, "little", signed=kind == "i"
            )
            assert row[name].tobytes() == bits, name


def test_a_part_of_a_channel_is_that_part(hover):
    whole = tiltrotor.read(hover, "/state")
    part = tiltrotor.read(hover, "state", from_tick=250, until_tick=300)
    assert np.array_equal(part, whole[250:301])
    channels = tiltrotor.channels(hover)
    assert channels["state"].messages == len(whole)
    assert channels["state"].units["state.plant.fuel_kg"] == "kg"
    with pytest.raises(tiltrotor.TiltrotorError, match="no message of a channel pictures there"):
        tiltrotor.read(hover, "pictures")


def _broken(log: Path, folder: Path) -> dict[str, Path]:
    """The log cut, and with a bit turned over, at several places."""
    whole = log.read_bytes()
    logs = {}
    for part in (0, 50, 1000, len(whole) // 3, len(whole) * 4 // 5, len(whole) - 9):
        logs[f"cut-{part}"] = whole[:part]
    for place in (1, 200, len(whole) // 4, len(whole) // 2, len(whole) * 3 // 4, len(whole) - 30):
        logs[f"flipped-{place}"] = whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :]
    logs["foreign"] = b"no log, but a good hundred bytes of it" * 3
    paths = {}
    for name, data in logs.items():
        paths[name] = folder / f"{name}.mcap"
        paths[name].write_bytes(data)
    return paths


def _same(judged, log: Path) -> str:
    verdict, report = tiltrotor.verify(log), judged(log)
    assert verdict.outcome == report["outcome"]
    assert verdict.first_bad_tick == report["first_bad_tick"]
    if verdict.digest is None:
        # What can be done about it is said in the language of each.
        assert verdict.words.split(";")[0] == report["words"].split(";")[0]
    else:
        assert verdict.words == report["words"]
        assert (verdict.start_tick, verdict.exact_tick) == (report["start_tick"], report["exact_tick"])
        assert (verdict.last_tick, verdict.diverged_tick) == (report["last_tick"], report["diverged_tick"])
        assert (verdict.digest, verdict.end) == (report["digest"], report["end"]["reason"])
        assert verdict.field == (report["divergence"] or {}).get("field")
    assert verdict.status == report["exit status"]
    assert bool(verdict) == (report["outcome"] == "exact")
    assert pickle.loads(pickle.dumps(verdict)) == verdict
    return verdict.outcome


@pytest.mark.parametrize("log", KEPT, ids=lambda log: log.stem)
def test_of_every_kept_log_the_verdict_is_the_commands(judged, log):
    _same(judged, log)


def test_command_and_package_are_of_one_version(command):
    assert command("--version").stdout.split()[1] == tiltrotor.__version__
    assert tiltrotor.BUILD.startswith(f"{tiltrotor.__version__} (commit ")


def test_of_every_broken_log_the_verdict_is_the_commands(judged, tmp_path, hover):
    outcomes = {name: _same(judged, log) for name, log in _broken(hover, tmp_path).items()}
    assert "exact" not in outcomes.values(), outcomes
    assert {"unusable", "never_closed", "damaged"} <= set(outcomes.values()), outcomes


def test_a_golden_flight_flies_otherwise_when_it_is_compared_with_another_aircraft(tmp_path, hover):
    made = tiltrotor.whatif(hover, tmp_path / "windy.mcap", world={"wind_mps.x": 5.0}, from_tick=250)
    assert made
    assert tiltrotor.facts(tmp_path / "windy.mcap")["parent"] == hover.name
    was, now = (tiltrotor.read(log, "state")["state.plant.position_m.x"] for log in (hover, tmp_path / "windy.mcap"))
    assert len(was) == len(now) + 250
    assert was[250] == now[0] and was[-1] != now[-1]
    with pytest.raises(tiltrotor.TiltrotorError, match="did you mean wind_mps"):
        tiltrotor.whatif(hover, tmp_path / "no.mcap", world={"wind_mps": 5.0})
    assert not (tmp_path / "no.mcap").exists()


def test_a_what_if_is_the_commands(tmp_path, command, judged, hover):
    by_command, by_python = tmp_path / "command.mcap", tmp_path / "python.mcap"
    said = command(
        *("whatif", hover, "--out", by_command, "--fail", "governor", "--world", "gust_mps.z=-5.0"),
        *("--world", "gust_s=1.0", "--from", "100t"),
    )
    assert said.returncode == 0, said.stderr
    # A number of any kind: numpy's say of themselves what they are.
    for five in (-5, -5.0, np.float64(-5.0), np.linspace(-5.0, 5.0, 3)[0], np.float32(-5.0), np.int64(-5)):
        world = {"gust_mps.z": five, "gust_s": np.float64(1.0)}
        made = tiltrotor.whatif(hover, by_python, world=world, fail=["governor"], from_tick=100, force=True)
        assert made
        assert judged(by_python)["digest"] == judged(by_command)["digest"]
    assert tiltrotor.facts(by_python)["changes"] == tiltrotor.facts(by_command)["changes"]


def test_a_what_if_says_what_a_number_was(tmp_path, command, hover):
    by_command, by_python = tmp_path / "command.mcap", tmp_path / "python.mcap"
    key = "fcc.scas.washout_s"
    said = command("whatif", hover, "--set", f"{key}=2", "--out", by_command)
    assert said.returncode == 0, said.stderr
    assert tiltrotor.whatif(hover, by_python, set={key: 2})
    changes = [tiltrotor.facts(log)["changes"] for log in (by_command, by_python)]
    assert changes == [f"{key} = 2 (was 1.5)"] * 2


def test_reflown_outputs_are_those_recorded_where_some_are(hover):
    recorded = tiltrotor.read(hover, "outputs")
    reflown = tiltrotor.refly(hover)
    assert len(reflown) == 1000
    by_tick = {row["tick"]: row for row in reflown}
    compared = 0
    for row in recorded:
        if row["tick"] in by_tick:
            compared += 1
            for name in by_tick[row["tick"]].dtype.names:
                assert by_tick[row["tick"]][name].tobytes() == row[name].tobytes(), name
    assert compared == 100
    states = tiltrotor.refly(hover, "state", from_tick=500, until_tick=750, every=50)
    assert states["tick"].tolist() == [550, 600, 650, 700, 750]


def test_a_damaged_log_is_read_as_far_as_asked_for(tmp_path, hover):
    data = bytearray(hover.read_bytes())
    data[len(data) * 3 // 4] ^= 1
    (tmp_path / "broken.mcap").write_bytes(data)
    with pytest.raises(tiltrotor.TiltrotorError, match="damaged"):
        tiltrotor.read(tmp_path / "broken.mcap", "state")
    some = tiltrotor.read(tmp_path / "broken.mcap", "state", partial=True)
    whole = tiltrotor.read(hover, "state")
    assert 0 < len(some) < len(whole)
    assert np.array_equal(some, whole[: len(some)])


def test_identify_is_the_commands(tmp_path, command):
    log = tmp_path / "sweep.mcap"
    said = command(
        *("fly", "--pilot", "sweep-pitch", "--start", "downwind", "--fast", "--no-flightgear"),
        *("--out", log),
    )
    if said.returncode != 0:
        names = command("fly", "--help").stdout
        pytest.fail(f"{said.stderr}\n{names}")
    said = command("identify", log, "--input", "stick_aft", "--output", "pitch_rate", "--format", "json")
    report = json.loads(said.stdout)
    found = tiltrotor.identify(log, "stick_aft", "pitch_rate")
    assert (found.input, found.output) == (report["input"]["name"], report["output"]["name"])
    points = report["points"]
    assert found.frequency_radps.tolist() == [point["frequency_radps"] for point in points]
    assert found.response.real.tolist() == [point["real"] for point in points]
    assert found.coherence.tolist() == [point["coherence"] for point in points]
    assert found.verdict.outcome == report["judgement"]["outcome"] == "exact"
