"""Time of 10,000 ticks from Python over that of the same ticks in Rust: python_ratio.py STEPPED ROUNDS.

Each round times Rust, Python, and Rust again, so that a machine that slows down slows both; then frames of JSBSim's
wheel, also a call each. What is printed is the median of the rounds' ratios. Ends with 1 when Python takes more than
1.1 of Rust's time.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time

import tiltrotor

os.environ.setdefault("JSBSIM_DEBUG", "0")
try:
    import jsbsim
except ImportError:
    jsbsim = None

TICKS = 10_000
RATIO_MAX = 1.1


def native_us(stepped: str) -> float:
    said = subprocess.run([stepped, str(TICKS)], capture_output=True, text=True, check=True)
    return float(said.stdout)


def python_us(start: tiltrotor.Flight) -> float:
    flight = start.copy()
    begun = time.perf_counter()
    for _ in range(TICKS):
        flight.step()
    return (time.perf_counter() - begun) / TICKS * 1e6


def frame_us(model: str) -> float:
    fdm = jsbsim.FGFDMExec(None)
    fdm.set_debug_level(0)
    fdm.disable_output()
    if not (fdm.load_model(model) and fdm.load_ic("reset00", True) and fdm.run_ic()):
        sys.exit(f"{model} does not start")
    begun = time.perf_counter()
    for _ in range(TICKS):
        fdm.run()
    return (time.perf_counter() - begun) / TICKS * 1e6


def main() -> int:
    stepped, rounds = sys.argv[1], int(sys.argv[2])
    if rounds < 1:
        sys.exit(f"ROUNDS: expected 1 or more, got {rounds}")
    start = tiltrotor.Flight(start="hover-50ft")
    python_us(start)
    ours, natives, ratios = [], [], []
    for _ in range(rounds):
        before_us, tick_us, after_us = native_us(stepped), python_us(start), native_us(stepped)
        native = 0.5 * (before_us + after_us)
        ours.append(tick_us)
        natives.append(native)
        ratios.append(tick_us / native)
    ratio = statistics.median(ratios)
    low, _, high = statistics.quantiles(ratios, n=4) if rounds > 1 else (ratio, ratio, ratio)
    print(f"Rust, engine::step        {statistics.median(natives):7.2f} us a tick")
    print(f"Python, flight.step()     {statistics.median(ours):7.2f} us a tick")
    print(f"ratio                     {ratio:7.3f}  (half of {rounds} rounds within {low:.3f} to {high:.3f})")
    for model in ["ah1s", "c172x"] if jsbsim else []:
        print(f"JSBSim {jsbsim.__version__}, {model:<6} {frame_us(model):15.2f} us a frame")
    return 0 if ratio <= RATIO_MAX else 1


sys.exit(main())
