#!/usr/bin/env python3
"""What the display costs: FlightGear's CPU time per frame with it and without, by turns, in one view.

Usage: cost.py PROCESS HTTP-PORT FRAMES-PORT [--pairs N] [--seconds S] [--most PER-CENT]
Frames are counted by the records that FlightGear sends, one each; the display is switched by a property.
"""
import argparse
import os
import socket
import statistics
import time
import urllib.request

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def cpu_s(process):
    """User and system time of all its threads."""
    with open(f"/proc/{process}/stat") as stat:
        fields = stat.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("process", type=int)
    parser.add_argument("http", type=int)
    parser.add_argument("frames", type=int)
    parser.add_argument("--pairs", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=6.0)
    parser.add_argument("--most", type=float, default=15.0)
    arguments = parser.parse_args()
    frames = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    frames.bind(("127.0.0.1", arguments.frames))
    frames.settimeout(20)

    def switch(on):
        urllib.request.urlopen(f"http://127.0.0.1:{arguments.http}/props/sim/tiltrotor?submit=set&display={int(on)}",
                               timeout=60).read()

    def per_frame(on):
        switch(on)
        # What is under way goes by first.
        frames.setblocking(True)
        settle = time.monotonic() + 1.0
        while time.monotonic() < settle:
            frames.recv(64)
        start, count, end = cpu_s(arguments.process), 0, time.monotonic() + arguments.seconds
        while time.monotonic() < end:
            frames.recv(64)
            count += 1
        return (cpu_s(arguments.process) - start) / count * 1e3, count

    pairs = []
    for i in range(arguments.pairs):
        # Which one is first changes, so that a drift of the machine favours neither.
        first = per_frame(i % 2 == 0)
        second = per_frame(i % 2 == 1)
        (with_ms, drawn), (without_ms, _) = (first, second) if i % 2 == 0 else (second, first)
        pairs.append((with_ms, without_ms))
        print(f"with {with_ms:6.1f} ms, without {without_ms:6.1f} ms a frame ({drawn} frames)", flush=True)
    with_ms, without_ms = (statistics.median(side) for side in zip(*pairs))
    more = statistics.median(a / b for a, b in pairs) * 100 - 100
    print(f"median of {len(pairs)} pairs: with {with_ms:.1f} ms, without {without_ms:.1f} ms of CPU a frame:"
          f" {more:+.1f} %, limit {arguments.most:+.0f} %")
    raise SystemExit(0 if more <= arguments.most else 1)


if __name__ == "__main__":
    main()
