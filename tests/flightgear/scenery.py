#!/usr/bin/env python3
"""Wheels on FlightGear's ground: at the start, while taxiing, at a landing, and as replayed.

Usage: scenery.py TILTROTOR WORK FLIGHTGEAR_ARGUMENT…
"""
import json
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

NODES = ["tiltrotor/tick", "sim/sceneryloaded", "position/ground-elev-m", *(f"tiltrotor/ground/wheel[{i}]/height-m" for i in range(3)),
         "position/altitude-ft", *(f"tiltrotor/gear/unit[{i}]/compression-m" for i in range(3))]
# From the reference point down to an extended tyre, m; nose and mains: aircraft/xv15.toml.
DOWN = [(81.65 + 8.1) * 0.0254, (81.65 + 8.65) * 0.0254, (81.65 + 8.65) * 0.0254]
WITHIN_M = 0.05
FLIGHTS = {
    "taxi": ["--script", "tests/flightgear/taxi.toml", "--duration", "40"],
    "landing": ["--pilot", "land", "--start", "hover-50ft", "--duration", "40"],
}


def main():
    import struct

    tiltrotor, work, *arguments = sys.argv[1:]
    work = Path(work)
    chunks = "".join(f"<chunk><node>/{node}</node><type>double</type></chunk>\n" for node in NODES)
    (work / "data/Protocol").mkdir(parents=True)
    (work / "data/Protocol/samples.xml").write_text(
        "<?xml version='1.0'?>\n<PropertyList><generic><output><binary_mode>true</binary_mode>"
        f"<byte_order>network</byte_order>\n{chunks}</output></generic></PropertyList>\n")
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.bind(("127.0.0.1", 0))
    frames = []

    def listen():
        while True:
            frames.append(dict(zip(NODES, struct.unpack(">" + "d" * len(NODES), sock.recv(1024)))))

    threading.Thread(target=listen, daemon=True).start()
    probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
    probe.close()
    ours = [f"--data={work / 'data'}", f"--generic=socket,out,250,127.0.0.1,{sock.getsockname()[1]},udp,samples"]
    for name, who in FLIGHTS.items():
        frames.clear()
        log = work / f"{name}.mcap"
        command = [tiltrotor, "fly", *who, "--out", str(log), "--hold", "2", "--launch-flightgear", "--terrasync", "off",
                   "--flightgear", f"127.0.0.1:{port}", "--ground", "flightgear"]
        command += [f"--fgfs-arg={argument}" for argument in ours + arguments]
        flight = subprocess.run(command, capture_output=True, text=True)
        print(flight.stdout + flight.stderr)
        assert flight.returncode == 0, f"fly ended with {flight.returncode}"
        judge(name, [frame for frame in frames if frame["tiltrotor/tick"] >= 1])
        verify = subprocess.run([tiltrotor, "verify", str(log)], capture_output=True, text=True)
        print(verify.stdout + verify.stderr)
        assert verify.returncode == 0, "the flight replays exactly, without FlightGear"


def judge(name, shown):
    # Level enough on its wheels for the height of the reference point to be that of the wheels' below it.
    errors = []
    for frame in shown:
        for i in (1, 2):
            if (compression := frame[f"tiltrotor/gear/unit[{i}]/compression-m"]) > 0:
                wheel = frame["position/altitude-ft"] * 0.3048 - DOWN[i] + compression
                errors.append((abs(wheel - frame[f"tiltrotor/ground/wheel[{i}]/height-m"]), frame["tiltrotor/tick"], i))
    errors.sort()
    grounds = [frame["tiltrotor/ground/wheel[1]/height-m"] for frame in shown]
    print(f"{name}: {len(shown)} frames, ground from {min(grounds):.2f} to {max(grounds):.2f} m; {len(errors)} wheels on it: "
          f"median {errors[len(errors) // 2][0] * 100:.1f}, worst {errors[-1][0] * 100:.1f} cm at tick {errors[-1][1]:.0f}")
    assert len(shown) > 50 and len(errors) > 50, "frames on the ground"
    assert errors[-1][0] < WITHIN_M, "within 5 cm"


main()
