"""The rotor of a steady flight beside `dynbem`, other people's blade-element and momentum theory, in axial flow.

Thrust, rotor speed and speed through the disc are ours, from `tiltrotor trim`; `dynbem` finds the collective that
gives that thrust, and the power that it takes. Independent: the inflow, the summation, the tip loss, the blade's
section (one for the whole blade, where ours has four). Shared: chord, twist, radius, and that section's table.
In a hover ours takes some power more than a rotor alone, `rotors.inflow.recirculation` of the aircraft file.

Usage: rotor_alone.py TILTROTOR
"""

import csv
import math
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np
from dynbem import (
    BladeGeometry,
    QuasiStaticBEM,
    QuasiStaticRotorState,
    RotorDefinition,
    RotorInputs,
    TabulatedPolar,
)
from dynbem.rotor_definition import LinearPolarParameters

HERE = Path(__file__).resolve().parent
FLIGHTS = ((90, 0), (0, 160), (0, 200))
# Stated beforehand.
POWER_PERCENT = 6.0

FOOT_M = 0.3048
INCH_M = 0.0254
LBF_N = 4.4482216
KNOT_MPS = 0.514444
DENSITY = 1.225


def section(rotors):
    """The blade's section at 3/4 radius, from .55 to .80: the table, and a flat plate far beyond it."""
    lift, drag = (
        rotors["blade"]["section"]["lift_coefficient"],
        rotors["blade"]["section"]["drag_coefficient"],
    )
    at = lift["radius_norm"].index(0.80)
    known = np.radians(lift["alpha_deg"])
    alpha = np.radians(np.arange(-180.0, 180.5, 1.0))
    # Beyond the table: lift goes over into sin 2α within ten degrees, drag into .01 + 1.9 sin²α.
    far = np.clip((np.abs(alpha - np.clip(alpha, known[0], known[-1]))) / math.radians(10), 0, 1)
    cl = (1 - far) * np.interp(alpha, known, lift["value"][at]) + far * np.sin(2 * alpha)
    known = np.radians(drag["alpha_deg"])
    far = np.clip((np.abs(alpha - np.clip(alpha, known[0], known[-1]))) / math.radians(10), 0, 1)
    cd = (1 - far) * np.interp(alpha, known, drag["value"][at]) + far * (0.01 + 1.9 * np.sin(alpha) ** 2)
    return TabulatedPolar(alpha_rad=alpha, cl=cl, cd=cd)


def rotor(rotors):
    """The published blade, as `dynbem` wants it."""
    radius = rotors["radius_ft"]["value"] * FOOT_M
    blade = rotors["blade"]
    root = blade["root_norm"]["value"]
    chord, twist = blade["blade_chord_in"], blade["twist_deg"]
    stations = np.linspace(root, 1.0, 46)
    geometry = BladeGeometry(
        int(blade["count"]["value"]), radius, root * radius, chord["value"][-1] * INCH_M, n_elements=60,
        r_stations_m=list(stations * radius),
        chord_stations_m=list(np.interp(stations, chord["radius_norm"], chord["value"]) * INCH_M),
        twist_stations_deg=list(np.interp(stations, twist["radius_norm"], twist["value"])),
    )  # fmt: skip
    nothing = LinearPolarParameters(CL0=0.0, CL_alpha_per_rad=5.8, CD0=0.01, alpha_stall_deg=12.0)
    return QuasiStaticBEM(RotorDefinition(blade=geometry, airfoil=nothing), section(rotors), 12)


def loads(model, collective_rad, axial_mps, omega):
    """Thrust in N and power in W of a rotor that goes along its mast."""
    inputs = RotorInputs(
        collective_rad=collective_rad, tilt_lon=0.0, tilt_lat=0.0, R_hub=np.eye(3),
        v_hub_world=np.array([0.0, 0.0, -axial_mps]), wind_world=np.zeros(3), omega_rad_s=omega, rho_kg_m3=DENSITY,
    )  # fmt: skip
    result, _ = model.compute_forces(inputs, QuasiStaticRotorState())
    return -result.F_world[2], abs(result.Q_spin) * omega


def at_thrust(model, thrust_n, axial_mps, omega):
    """Collective and power for a thrust, by bisection below the stall."""
    low, high = math.radians(0.0), math.radians(60.0)
    if axial_mps < 1:
        high = math.radians(20.0)
    for _ in range(40):
        middle = 0.5 * (low + high)
        if loads(model, middle, axial_mps, omega)[0] < thrust_n:
            low = middle
        else:
            high = middle
    return middle, loads(model, middle, axial_mps, omega)[1]


def main():
    """Prints the table; exit 1 when a power is beyond its limit."""
    rotors = tomllib.loads((HERE.parent / "aircraft" / "xv15.toml").read_text())["rotors"]
    model = rotor(rotors)
    failed = 0
    print(f"{'flight':22} {'thrust N':>9} {'collective deg':>21} {'power of both kW':>23}")
    print(f"{'':22} {'':>9} {'ours':>10} {'dynbem':>10} {'ours':>8} {'dynbem':>8} {'':>6}")
    for nacelle, knots in FLIGHTS:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "trim.csv"
            command = [
                sys.argv[1],
                "trim",
                "--nacelle",
                str(nacelle),
                "--speed-kt",
                str(knots),
                "--csv",
                str(file),
            ]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            row = {name: float(value) for name, value in next(csv.DictReader(file.open())).items()}
        thrust = 0.5 * (row["thrust_left_lbf"] + row["thrust_right_lbf"]) * LBF_N
        omega = row["power_kw"] * 1e3 / (2 * row["mast_torque_kn_m"] * 1e3)
        axial = knots * KNOT_MPS * math.cos(math.radians(row["alpha_deg"])) if nacelle == 0 else 0.0
        collective, power = at_thrust(model, thrust, axial, omega)
        off = 100 * (2 * power / 1e3 / row["power_kw"] - 1)
        verdict = "" if abs(off) <= POWER_PERCENT else f"  beyond {POWER_PERCENT:g} %"
        failed += abs(off) > POWER_PERCENT
        print(
            f"nacelle {nacelle:2} deg, {knots:3} kt {thrust:9.0f} {row['collective_deg']:10.1f}"
            f" {math.degrees(collective):10.1f} {row['power_kw']:8.0f} {2 * power / 1e3:8.0f} {off:+5.1f} %{verdict}"
        )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
