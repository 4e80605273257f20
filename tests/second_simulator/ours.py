"""What this project's program says: steady flight, modes, the demonstration's flight. All of it at run time."""

import csv
import io
import re
import subprocess
from pathlib import Path

import numpy as np


class Ours:
    """The program, asked."""

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)

    def _run(self, *arguments):
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(arguments)}: exit {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def trim(self, case):
        """A row of `tiltrotor trim --csv`."""
        file = self.folder / f"trim-{case['nacelle_deg']}-{case['speed_kt']}.csv"
        self._run(
            "trim", "--nacelle", str(case["nacelle_deg"]), "--speed-kt", str(case["speed_kt"]),
            "--rpm", str(case["rpm"]), "--flap", str(case["flap_deg"]), "--csv", str(file),
        )  # fmt: skip
        row = next(csv.DictReader(io.StringIO(file.read_text())))
        return {name: float(value) for name, value in row.items()}

    def modes(self, nacelle, knots):
        """Names and eigenvalues that `tiltrotor linearize` prints, drive apart."""
        text = self._run("linearize", "--nacelle", str(nacelle), "--speed-kt", str(knots))
        found = []
        for line in text.splitlines():
            at = re.match(r"\s*(.*?)\s{2,}(-?\d+\.\d+)(?:\s*±\s*(\d+\.\d+)j)?\s", line)
            if at and at[1] and at[1] != "drive":
                found.append((at[1], complex(float(at[2]), float(at[3] or 0))))
        return found

    def demonstration(self):
        """Flies it, and returns the log's tables of states, and the phases' beginnings."""
        log = self.folder / "demo.mcap"
        self._run("demo", "--fast", "--no-flightgear", "--force", "--out", str(log))
        self._run("log", "export", str(log), "--csv", str(self.folder / "tables"), "--force")
        phases = []
        for line in self._run("log", "summary", str(log)).splitlines():
            at = re.match(r"\s*(\d+\.\d+) s  (.*)", line)
            if at:
                phases.append((float(at[1]), at[2]))
        return self._table("outputs"), self._table("state"), phases

    def play(self, name, record, until_s, forward_in=0.0):
        """Another simulator's hands, the stick so much further forward, from the ground on; the log's outputs."""
        script, log = self.folder / f"{name}.toml", self.folder / f"{name}.mcap"
        axes = ("stick_aft", "stick_right", "pedal_right", "collective")
        aft = np.clip(record["stick_aft"] - forward_in / 4.8, -1, 1)
        columns = [aft, *(record[control] for control in ("stick_right", "pedal_right", "lever"))]
        with open(script, "w") as text:
            for time, *hands in zip(record["time"], *columns):
                if time > until_s:
                    break
                axis = ", ".join(f"{control} = {value:.6f}" for control, value in zip(axes, hands))
                text.write(f"[[event]]\nat_s = {time:.3f}\naxis = {{ {axis} }}\n")
        self._run(
            "fly", "--fast", "--no-flightgear", "--force", "--script", str(script),
            "--duration", str(until_s), "--out", str(log),
        )  # fmt: skip
        self._run("log", "export", str(log), "--csv", str(self.folder / name), "--force")
        return self._table("outputs", name)

    def _table(self, channel, folder="tables"):
        file = next((self.folder / folder / channel).glob("*/data.csv"))
        with open(file) as text:
            names = text.readline().strip().split(",")
            numbers = np.loadtxt(
                text, delimiter=",", usecols=range(1, len(names)), converters={1: float}, ndmin=2
            )
        return {name: numbers[:, i] for i, name in enumerate(names[1:])}
