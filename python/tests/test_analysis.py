"""Steady flight and small motions are the command's, to the bit."""

from __future__ import annotations

import csv
import pickle

import numpy as np
import pytest

import tiltrotor

#: Name in Python, option of the command, value.
CONDITIONS = [
    [],
    [("nacelle_deg", "--nacelle", 60), ("speed_kt", "--speed-kt", 100)],
    [("nacelle_deg", "--nacelle", 0), ("speed_kt", "--speed-kt", 200), ("altitude_ft", "--altitude-ft", 10000)],
    [("nacelle_deg", "--nacelle", 75), ("speed_kt", "--speed-kt", 80), ("bank_deg", "--bank-deg", 20)],
]


def _both(condition):
    return {name: value for name, _, value in condition}, [
        word for _, option, value in condition for word in (option, value)
    ]


@pytest.mark.parametrize("condition", CONDITIONS)
def test_a_trim_is_the_commands(tmp_path, command, condition):
    named, options = _both(condition)
    said = command("trim", *options, "--csv", tmp_path / "trim.csv")
    assert said.returncode == 0, said.stderr
    with (tmp_path / "trim.csv").open() as file:
        row = next(csv.DictReader(file))
    trim = tiltrotor.Aircraft().trim(**named)
    assert row.pop("trimmed") == "1"
    assert dict(trim) == {name: float(value) for name, value in row.items()}
    assert [line.split() for line in str(trim).splitlines()] == [
        line.split() for line in said.stdout.splitlines()
    ]
    assert dict(pickle.loads(pickle.dumps(trim))) == dict(trim)


@pytest.mark.parametrize("condition", CONDITIONS)
def test_matrices_and_eigenvalues_are_the_commands(tmp_path, command, condition):
    named, options = _both(condition)
    said = command("linearize", *options, "--csv", tmp_path / "linear.csv")
    assert said.returncode == 0, said.stderr
    linear = tiltrotor.Aircraft().linearize(**named)
    numbers: dict[tuple[str, str, str], float] = {}
    with (tmp_path / "linear.csv").open() as file:
        for row in csv.DictReader(file):
            numbers[row["matrix"], row["row"], row["column"]] = float(row["value"])
    for name, rows, columns in [
        ("A", linear.states, linear.states),
        ("B", linear.states, linear.inputs),
        ("C", linear.outputs, linear.states),
        ("D", linear.outputs, linear.inputs),
    ]:
        matrix = getattr(linear, name)
        assert matrix.shape == (len(rows), len(columns))
        expected = [[numbers.pop((name, row, column)) for column in columns] for row in rows]
        assert np.array_equal(matrix, expected)
    for i, value in enumerate(linear.eigenvalues):
        assert value.real == numbers.pop(("eigenvalue", str(i), "re_per_s"))
        assert value.imag == numbers.pop(("eigenvalue", str(i), "im_radps"))
    assert not numbers
    slow = [mode.name for mode in linear.modes if not mode.fast]
    # The command prints the modes that matter to a pilot, each by its name.
    printed = said.stdout.splitlines()[3:]
    assert [line[:28].strip() for line in printed] == slow
    again = pickle.loads(pickle.dumps(linear))
    assert np.array_equal(again.A, linear.A) and again.modes == linear.modes


@pytest.mark.parametrize(
    ("condition", "error", "words"),
    [
        ({"speed_kt": 390, "nacelle_deg": 90}, tiltrotor.NoSteadyFlight, ""),
        ({"speed_kt": 1e9}, tiltrotor.NoSteadyFlight, "speed_kt 1000000000: expected -60 to 400 kt"),
        ({"altitude_ft": float("nan")}, tiltrotor.NoSteadyFlight, "altitude_ft NaN"),
        ({"flap_deg": 33}, tiltrotor.NoSteadyFlight, "the lever has detents at"),
        ({"rpm": 500}, tiltrotor.NoSteadyFlight, "the governor offers"),
        ({"speed": 80}, tiltrotor.TiltrotorError, "speed: no such condition; there are nacelle_deg"),
        ({"speed_kt": "fast"}, tiltrotor.TiltrotorError, "speed_kt: expected a number"),
        ({"gear_down": "yes"}, tiltrotor.TiltrotorError, "gear_down: expected True or False"),
    ],
)
def test_what_does_not_fly_is_refused_in_words(condition, error, words):
    for ask in (tiltrotor.Aircraft().trim, tiltrotor.Aircraft().linearize):
        with pytest.raises(error) as refused:
            ask(**condition)
        assert words in str(refused.value)


def test_an_aircraft_with_other_numbers_is_another_aircraft():
    xv15 = tiltrotor.Aircraft()
    key = next(key for key in xv15.values() if key.endswith("zero_fuel_mass_lb"))
    heavier = xv15.with_({key: 11_000.0})
    assert heavier != xv15 and heavier.values()[key] != xv15.values()[key]
    assert pickle.loads(pickle.dumps(heavier)) == heavier
    assert "changed in Python" in heavier.toml
    with pytest.raises(KeyError, match="wings"):
        xv15.with_({"wings": 3})
    with pytest.raises(tiltrotor.TiltrotorError):
        xv15.with_({key: -1.0})
