#!/usr/bin/env python3
"""flightgear-python reads our native packets and finds what the log says.

Usage: other_decoder.py TILTROTOR LOG
"""
import json
import math
import socket
import subprocess
import sys
import threading

from flightgear_python.fdm_v24 import fdm_struct

tiltrotor, log = sys.argv[1:]
sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sock.bind(("127.0.0.1", 0))
sock.settimeout(10)
packets = []


def listen():
    while True:
        try:
            packets.append(sock.recv(2048))
        except OSError:
            return


threading.Thread(target=listen, daemon=True).start()
until = "5"
subprocess.run([tiltrotor, "replay", log, "--until", until, "--hold", "0",
                "--flightgear", f"127.0.0.1:{sock.getsockname()[1]}"], check=True)
cat = subprocess.run([tiltrotor, "log", "cat", log, "--topic", "/outputs"], capture_output=True, text=True, check=True)
outputs = {int(row["tick"]): row for row in map(json.loads, cat.stdout.splitlines())}
compared = 0
for tick, packet in enumerate(packets[: int(float(until) * 250)], start=1):
    if tick not in outputs:
        continue
    read, said = fdm_struct.parse(packet), outputs[tick]
    assert read.version == 24 and read.num_engines == 2 and read.num_tanks == 1 and read.num_wheels == 3
    metres = 6_378_137.0
    assert abs(read.alt_m - said["place.height_m"]) < 0.01, (tick, read.alt_m)
    # In FlightGear's radians, which are longer by its pi.
    true = 57.2957763671875 * math.pi / 180
    assert abs(read.lat_rad * true - said["place.latitude_rad"]) * metres < 0.01, tick
    assert abs(read.lon_rad * true - said["place.longitude_rad"]) * metres < 0.01, tick
    for ours, theirs in (("euler.roll_rad", "phi_rad"), ("euler.pitch_rad", "theta_rad"), ("alpha_rad", "alpha_rad")):
        assert abs(read[theirs] - said[ours]) < 1e-6, (tick, ours)
    assert abs(read.rpm[0] - said["rotor_speed_radps"] * 30 / math.pi) < 1e-3, tick
    compared += 1
assert compared > 50, compared
print(f"flightgear-python reads {compared} packets and finds the log's values")
