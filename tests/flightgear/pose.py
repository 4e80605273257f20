#!/usr/bin/env python3
"""Sends FlightGear one state of the XV-15 over both channels until it is told to stop.

Usage: pose.py [--fdm PORT] [--channel PORT] [--protocol FILE] [--seconds S] NAME=VALUE…
NAME is a property below tiltrotor/, or latitude-deg, longitude-deg, height-m, as FlightGear has them.
For pictures and tests of the aircraft package; a flight is sent by tiltrotor itself.
"""
import argparse
import math
import socket
import struct
import time
import xml.etree.ElementTree as tree

# FlightGear's degrees per radian for places: 180/pi in single precision.
PLACE_DEG_PER_RAD = 57.2957763671875
BESIDE = {"latitude-deg": 19.7203, "longitude-deg": -155.0480, "height-m": 40.0}


def chunks(path):
    """Node and struct code of every number of the channel, in order."""
    codes = {"int": "i", "float": "f", "double": "d"}
    for chunk in tree.parse(path).getroot().find("generic/input").iter("chunk"):
        yield chunk.findtext("node").removeprefix("/tiltrotor/"), codes[chunk.findtext("type")]


def native(value):
    """FGNetFDM version 24: place and attitude, everything else at rest."""
    packet = bytearray(408)
    roll, pitch, heading = (
        math.radians(value.get(f"attitude/{name}-deg", 0.0)) for name in ("roll", "pitch", "heading")
    )
    struct.pack_into(">I4xddd", packet, 0, 24, *(value[f"{name}-deg"] / PLACE_DEG_PER_RAD
                     for name in ("longitude", "latitude")), value["height-m"])
    struct.pack_into(">ffff", packet, 32, -9999.0, roll, pitch, heading % math.tau)
    struct.pack_into(">f", packet, 68, value.get("air/cas-kt", 0.0))
    return bytes(packet)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fdm", type=int, default=5501)
    parser.add_argument("--channel", type=int, default=5502)
    parser.add_argument("--protocol", default="flightgear/data/Protocol/tiltrotor.xml")
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("values", nargs="*")
    arguments = parser.parse_args()
    value = dict(BESIDE)
    for pair in arguments.values:
        name, number = pair.split("=")
        value[name] = float(number)
    table = list(chunks(arguments.protocol))
    unknown = set(value) - {node for node, _ in table} - set(BESIDE)
    if unknown:
        raise SystemExit(f"not in {arguments.protocol}: {', '.join(sorted(unknown))}")
    value.setdefault("schema", 1)
    code = ">" + "".join(letter for _, letter in table)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    start = time.monotonic()
    while (elapsed := time.monotonic() - start) < arguments.seconds:
        value["tick"], value["time-s"] = elapsed * 250.0, elapsed
        for side in (0, 1):
            # Rotors turn by their speed.
            rpm = value.get(f"rotor[{side}]/rpm", 0.0)
            if rpm:
                value[f"rotor[{side}]/azimuth-deg"] = elapsed * rpm * 6.0 % 360.0
        numbers = (value.get(node, 0.0) for node, _ in table)
        packed = struct.pack(code, *(int(x) if letter == "i" else x
                                     for x, (_, letter) in zip(numbers, table)))
        out.sendto(native(value), ("127.0.0.1", arguments.fdm))
        out.sendto(packed, ("127.0.0.1", arguments.channel))
        time.sleep(0.02)


if __name__ == "__main__":
    main()
