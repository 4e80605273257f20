"""CPU time of a tick of the XV-15 over that of a frame of JSBSim's ah1s: jsbsim_ratio.py HOVER ROUNDS.

Each round times a stretch of JSBSim, our hover, and JSBSim again, so that a machine that slows down
slows both. What is printed is the median of the rounds' ratios. JSBSim is asked from Python, which is
some 0.3 µs of a frame; its helicopter stands on its skids with its rotor, which costs what it costs in
flight. Our tick gives state and outputs.
"""

import os
import statistics
import sys
import time

os.environ.setdefault("JSBSIM_DEBUG", "0")
import jsbsim  # noqa: E402 (it reads the environment)

FRAMES = 5_000
TICKS = 20_000


def ah1s():
    fdm = jsbsim.FGFDMExec(None)
    fdm.set_debug_level(0)
    if not (fdm.load_model("ah1s") and fdm.load_ic("reset00", True) and fdm.run_ic()):
        sys.exit("ah1s does not start")
    return fdm


def frame_us(fdm):
    begin = time.process_time()
    for _ in range(FRAMES):
        fdm.run()
    return (time.process_time() - begin) / FRAMES * 1e6


def cpu_s(command):
    child = os.posix_spawn(command[0], command, os.environ)
    _, status, used = os.wait4(child, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)}: status {status}")
    return used.ru_utime + used.ru_stime


def tick_us(hover):
    # What comes before the first tick is in both.
    flown_s = cpu_s([hover, str(TICKS)]) - cpu_s([hover, "0"])
    return flown_s / TICKS * 1e6


def main():
    hover, rounds = sys.argv[1], int(sys.argv[2])
    if rounds < 1:
        sys.exit(f"ROUNDS: expected 1 or more, got {rounds}")
    fdm = ah1s()
    frame_us(fdm)
    ours, theirs, ratios = [], [], []
    for _ in range(rounds):
        before_us, tick, after_us = frame_us(fdm), tick_us(hover), frame_us(fdm)
        frame = 0.5 * (before_us + after_us)
        ours.append(tick)
        theirs.append(frame)
        ratios.append(tick / frame)
    middle = statistics.median(ratios)
    low, _, high = statistics.quantiles(ratios, n=4) if rounds > 1 else (middle, middle, middle)
    print(f"JSBSim {jsbsim.__version__} ah1s  {statistics.median(theirs):6.2f} us a frame")
    print(f"XV-15              {statistics.median(ours):6.2f} us a tick")
    print(f"ratio              {middle:6.3f}  (half of {rounds} rounds within {low:.3f} to {high:.3f})")


main()
