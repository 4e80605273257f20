"""The second simulator beside this project's: steady flight, modes, the task, recorded inputs.

Usage: compare.py TILTROTOR [PICTURES]    figures are written into the folder PICTURES
"""

import math
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import flight
import limits
import model
import steady
import windows
from ours import Ours
from published import Published

DATA = Published(Path(__file__).resolve().parents[2] / "aircraft" / "xv15.toml")


def second(folder):
    """A second simulator of its own."""
    return model.Simulator(folder, DATA)


def task(folder, pitched):
    """One flight, for a process of its own."""
    record, pilot = flight.fly(second(folder), DATA, pitched)
    return record, pilot.log, flight.summary(record, pilot)


def trims(ours, sim):
    """The table of steady flights; how many are beyond a limit, and how much further forward ours has the stick."""
    allowed = f"pitch ±{limits.PITCH_DEG:g} deg, power ±{limits.POWER_PERCENT:g} %"
    print(f"\nSteady flight at 13,000 lb, sea level. Limits: {allowed}.")
    print(f"{'':24}{'pitch deg':>22}{'power kW':>24}{'stick in':>14}{'collective deg':>17}")
    pair = f"{'ours':>7}{'second':>7}"
    print(f"{'nacelle, speed':24}{pair}{'':>8}{'ours':>8}{'second':>8}{'':>8}{pair}{pair}")
    beyond, forward_in = 0, 0.0
    for case in limits.TRIMS:
        a = ours.trim(case)
        b = steady.trim(sim, dict(case, speed_kt=max(0.01, case["speed_kt"])))
        pitch = b["pitch_deg"] - a["pitch_deg"]
        power = 100 * (b["power_kw"] / a["power_kw"] - 1)
        if case is limits.TRIMS[0]:
            forward_in = a["stick_in"] - b["stick_in"]
        bad = abs(pitch) > limits.PITCH_DEG or abs(power) > limits.POWER_PERCENT or b["left"] > 1e-4
        beyond += bad
        print(
            f"{case['nacelle_deg']:3} deg, {case['speed_kt']:3} kt         "
            f"{a['pitch_deg']:7.1f}{b['pitch_deg']:7.1f}{pitch:+8.1f}"
            f"{a['power_kw']:8.0f}{b['power_kw']:8.0f}{power:+7.1f}%"
            f"{a['stick_in']:7.2f}{b['stick_in']:7.2f}{a['collective_deg']:7.1f}{b['collective_deg']:7.1f}"
            f"{'  BEYOND' if bad else ''}"
        )
    return beyond, forward_in


def show(values):
    """Eigenvalues in a line, one of each pair."""
    kept = sorted((v for v in values if v.imag > -1e-9), key=lambda v: (-abs(v.imag), v.real))
    return "  ".join(f"{v.real:+.3f}" + (f" ± {v.imag:.3f}j" if v.imag > 1e-6 else "") for v in kept)


def modes(ours, sim):
    """Modes beside `linearize`, and what flight identified."""
    print(
        "\nModes, SCAS off, 1/s. Shown, not limited: the second simulator's rotor speed and collective are held."
    )
    for nacelle, knots in limits.MODES:
        if nacelle == 90:
            case = limits.TRIMS[0]
            flown = "pitch +0.268 ± 0.513j  -1.320  -0.105 (TM-89428)"
        else:
            case = dict(limits.TRIMS[-2], speed_kt=knots, start=(3, 44, 0.4))
            flown = "short period -1.083 ± 1.706j (TM-89428, 8,000 ft)"
        case = dict(case, speed_kt=max(0.01, knots))
        along, side = steady.modes(sim, case, steady.trim(sim, case))
        print(f"nacelle {nacelle} deg, {knots} kt")
        print(f"  second, along    {show(along)}\n  second, sideways {show(side)}")
        for name, value in ours.modes(nacelle, knots):
            print(f"  ours             {show([value]):24} {name}")
        print(f"  flight           {flown}")


def our_record(outputs):
    """Our flight in the second simulator's columns."""
    return {
        "time": outputs["time_s"], "north": outputs["position_m_x"], "east": outputs["position_m_y"],
        "down": outputs["position_m_z"], "roll": outputs["euler_roll_rad"], "pitch": outputs["euler_pitch_rad"],
        "heading": outputs["euler_heading_rad"], "wheels": 0 * outputs["time_s"],
    }  # fmt: skip


def from_start(record):
    """Positions from where it stands first."""
    return dict(record, north=record["north"] - record["north"][0], east=record["east"] - record["east"][0])


def spans(phases, end):
    """Name, beginning and end of each phase; a second one of a name is told apart."""
    seen = {}
    for (begin, name), (until, _) in zip(phases, [*phases[1:], (end, "")]):
        seen[name] = seen.get(name, 0) + 1
        if name == "hover" and seen[name] == 2:
            name = "hover over the start"
        yield name, begin, until


def by_phase(ours, phases, theirs, log):
    """RMS of the difference of roll, pitch and yaw by phase, both phases drawn to one length."""
    print("\nEuler angles by phase, both flights' phases drawn to one length: RMS of the difference, deg")
    print(f"{'phase':24}{'ours s':>8}{'second s':>9}{'roll':>7}{'pitch':>7}{'yaw':>7}")
    mine = {name: (begin, end) for name, begin, end in spans(log, theirs["time"][-1])}
    for name, begin, end in spans(phases, ours["time"][-1]):
        if name not in mine or end - begin < 0.5:
            continue
        part = np.linspace(0, 1, 400)
        line = f"{name:24}{end - begin:8.1f}{mine[name][1] - mine[name][0]:9.1f}"
        for angle in ("roll", "pitch", "heading"):
            a = np.interp(begin + part * (end - begin), ours["time"], np.unwrap(ours[angle]))
            b = np.interp(
                mine[name][0] + part * (mine[name][1] - mine[name][0]),
                theirs["time"],
                np.unwrap(theirs[angle]),
            )
            off = (a - b + math.pi) % (2 * math.pi) - math.pi
            line += f"{math.degrees(math.sqrt(np.mean(off**2))):7.1f}"
        print(line)


def balance(sim):
    """The weight and the inertias that JSBSim adds up are the published ones, or nothing here means anything."""
    sim["tilt"] = 0.0
    sim.place((0, 0, 0), (0, 0, 0))
    sim.settle(3)
    for axis in ("xx", "yy", "zz", "xz"):
        wanted = DATA.number(f"weight_balance.inertia.{axis}_slug_ft2")
        found = sim[f"inertia/i{axis}-slugs_ft2"] * (
            -1 if axis == "xz" else 1
        )  # JSBSim shows the matrix's own
        if abs(found - wanted) > 0.01 * wanted:
            raise SystemExit(
                f"I{axis} of the second simulator is {found:.0f} slug ft2, published is {wanted:.0f}"
            )
    station = sim["inertia/cg-x-in"] - DATA.number("weight_balance.cg_in")[0]
    if abs(station) > 0.05:
        raise SystemExit(
            f"the second simulator's centre of gravity is {station:.2f} in aft of the published one"
        )


def tasks(results):
    """What is promised of the task, flown by the second simulator."""
    promised = f"every phase, no touch on the way, ends within {limits.END_M:g} m"
    print(f"\nThe task in the second simulator. Promised: {promised}.")
    failed = 0
    for name, (_, _, said) in results:
        bad = not said["done"] or said["touched"] or said["bounced"] or said["off_m"] > limits.END_M
        failed += bad
        print(
            f"{name:26} {said['phases']} phases in {said['took_s']:.1f} s, ends {said['off_m']:.2f} m from the start,"
            f" {'touches the ground on the way' if said['touched'] else 'no touch between lift-off and touchdown'}"
            f"{', bounces' if said['bounced'] else ''}"
            f"{'' if not said['gave_up'] else ', gave up: ' + said['gave_up']}{'  BEYOND' if bad else ''}"
        )
    return failed


def handed_over(ours, record, forward_in):
    """The hands of the pitch-forward take-off, played into ours: how far that carries."""
    print("\nThe pitch-forward take-off's hands in ours: difference of attitude after lift-off, deg")
    for name, forward in (("as they are", 0.0), (f"stick {forward_in:.2f} in further forward", forward_in)):
        outputs = ours.play(f"hands-{forward != 0.0:d}", record, limits.HANDS_S, forward)
        time, down = outputs["time_s"], outputs["position_m_z"]
        off = 0.0
        for angle in ("roll", "pitch", "heading"):
            mine = np.interp(time, record["time"], np.unwrap(record[angle]))
            off = off + ((outputs[f"euler_{angle}_rad"] - mine + math.pi) % (2 * math.pi) - math.pi) ** 2
        off = np.degrees(np.sqrt(off))
        free = time[np.argmax(down < down[25] - 0.2)]
        parts = "  ".join(f"{np.interp(free + s, time, off):4.1f} after {s} s" for s in (0, 2, 4))
        print(f"{name:32} in the air at {free:.1f} s:  {parts}")


def growth(found):
    """When attitudes part by 2 deg in each window."""

    def until(difference):
        over = np.nonzero(difference[:, 1] > 2.0)[0]
        return f"{difference[over[0], 0]:.1f}" if len(over) else f"> {limits.WINDOW_S:g}"

    print(
        "\nRecorded inputs from recorded states: s until attitudes differ by 2 deg, and the difference after 2 s"
    )
    print(f"{'window':24}{'at s':>7}{'as recorded':>24}{'first acceleration matched':>30}")
    for name, at_s, raw, matched in found:
        both = "".join(
            f"{until(each):>8} s{each[50, 1]:6.1f} deg{each[50, 2]:5.1f} m/s" for each in (raw, matched)
        )
        print(f"{name:24}{at_s:7.1f}{both}")


def main():
    """Everything; exit 1 when something promised is not kept."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor(2) as pool:
        flights = [pool.submit(task, f"{folder}/{pitched:d}", pitched) for pitched in (False, True)]
        ours, sim = Ours(sys.argv[1], folder), second(f"{folder}/2")
        balance(sim)
        beyond, forward_in = trims(ours, sim)
        modes(ours, sim)
        outputs, state, phases = ours.demonstration()
        phases = [
            each for each in phases if "," not in each[1] and not each[1].startswith(("marker", "end "))
        ]
        flights = [each.result() for each in flights]
        failed = beyond + tasks(list(zip(("vertical take-off", "pitch-forward take-off"), flights)))
        mine = our_record(outputs)
        by_phase(mine, phases, flights[0][0], flights[0][1])
        found = windows.compare(sim, outputs, state, phases)
        growth(found)
        handed_over(ours, flights[1][0], forward_in)
        if len(sys.argv) > 2:
            import figures

            pictures = Path(sys.argv[2])
            drawn = [
                ("ours", from_start(mine), phases),
                ("second simulator", from_start(flights[0][0]), flights[0][1]),
                ("second, pitch-forward take-off", from_start(flights[1][0]), flights[1][1]),
            ]
            figures.trajectory(drawn, pictures / "second_trajectory.svg")
            figures.euler(drawn, pictures / "second_euler.svg")
            figures.growth(found, pictures / "second_growth.svg")
    said = f"{failed} of {len(limits.TRIMS) + 2} promises are not kept" if failed else "every promise is kept"
    print(f"\n{said}; {time.monotonic() - begun:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
