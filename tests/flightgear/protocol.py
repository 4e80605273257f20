#!/usr/bin/env python3
"""A flight in the real FlightGear, and every property it shows beside what the log says of that tick.

Usage: protocol.py TILTROTOR WORK FLIGHTGEAR_ARGUMENT…

FlightGear is started by the command itself. It sends every drawn frame as doubles by a protocol of this
test; the log is replayed at real time into a socket here, tick by tick, and both are compared. In the middle
of the flight FlightGear gets a twentieth of the time, and over its end it stands still for five seconds.
"""
import bisect
import itertools
import json
import math
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as tree
from pathlib import Path

FLIGHT_S, STARVED_S, FROZEN_S = 24, (8, 14), 5
PLACE_DEG_PER_RAD = 57.2957763671875
DEG = 180 / math.pi
KNOTS_150_MPS = 77.2
METRES_PER_DEGREE = 111_319.49
# FlightGear's tree: offset and code in FGNetFDM, factor, tolerance. Single precision where FlightGear keeps it so.
NATIVE = {
    "position/longitude-deg": (8, "d", PLACE_DEG_PER_RAD, 1e-9),
    "position/latitude-deg": (16, "d", PLACE_DEG_PER_RAD, 1e-9),
    "position/altitude-ft": (24, "d", 1 / 0.3048, 1e-4),
    "orientation/roll-deg": (36, "f", DEG, 1e-4),
    "orientation/pitch-deg": (40, "f", DEG, 1e-4),
    "orientation/heading-deg": (44, "f", DEG, 1e-3),
    "orientation/alpha-deg": (48, "f", DEG, 1e-3),
    "velocities/airspeed-kt": (68, "f", 1, 1e-3),
    "velocities/vertical-speed-fps": (72, "f", 1, 1e-3),
    "velocities/speed-north-fps": (76, "f", 1, 1e-3),
    "velocities/speed-east-fps": (80, "f", 1, 1e-3),
    "velocities/speed-down-fps": (84, "f", 1, 1e-3),
    "velocities/uBody-fps": (88, "f", 1, 1e-3),
    "velocities/vBody-fps": (92, "f", 1, 1e-3),
    "velocities/wBody-fps": (96, "f", 1, 1e-3),
    "accelerations/pilot/z-accel-fps_sec": (108, "f", 1, 1e-3),
    "sim/alarms/stall-warning": (112, "f", 1, 1e-6),
    "engines/engine[0]/rpm": (140, "f", 1, 1e-3),
    "engines/engine[1]/rpm": (144, "f", 1, 1e-3),
    "engines/engine[0]/fuel-flow-gph": (156, "f", 1, 1e-3),
    "engines/engine[1]/fuel-flow-gph": (160, "f", 1, 1e-3),
    "engines/engine[0]/fuel-px-psi": (172, "f", 1, 1e-3),
    "engines/engine[0]/egt-degf": (188, "f", 1, 1e-2),
    "engines/engine[1]/egt-degf": (192, "f", 1, 1e-2),
    "engines/engine[0]/oil-temperature-degf": (252, "f", 1, 1e-2),
    "engines/engine[0]/oil-pressure-psi": (268, "f", 1, 1e-3),
    "consumables/fuel/tank[0]/level-gal_us": (288, "f", 1, 1e-2),
    "gear/gear[0]/wow": (308, "I", 1, 0),
    "gear/gear[1]/wow": (312, "I", 1, 0),
    "gear/gear[2]/wow": (316, "I", 1, 0),
    "gear/gear[0]/position-norm": (320, "f", 1, 1e-6),
    "gear/gear[2]/position-norm": (328, "f", 1, 1e-6),
    "gear/gear[0]/steering-norm": (332, "f", 1, 1e-6),
    "gear/gear[0]/compression-norm": (344, "f", 1, 1e-6),
    "gear/gear[1]/compression-norm": (348, "f", 1, 1e-6),
    "gear/gear[2]/compression-norm": (352, "f", 1, 1e-6),
    "surface-positions/elevator-pos-norm": (368, "f", 1, 1e-6),
    "surface-positions/flap-pos-norm": (380, "f", 1, 1e-6),
    "surface-positions/left-aileron-pos-norm": (384, "f", 1, 1e-6),
    "surface-positions/right-aileron-pos-norm": (388, "f", 1, 1e-6),
    "surface-positions/rudder-pos-norm": (392, "f", 1, 1e-6),
}
# A replay has lamps of its own.
LAMPS = {"tiltrotor/lamp/recording", "tiltrotor/lamp/replay"}


def channel():
    """Node and code of every number of the second channel, in order."""
    codes = {"int": "i", "float": "f", "double": "d"}
    chunks = tree.parse("flightgear/data/Protocol/tiltrotor.xml").getroot().find("generic/input").iter("chunk")
    return [(chunk.findtext("node").lstrip("/"), codes[chunk.findtext("type")]) for chunk in chunks]


CHANNEL = channel()
CHANNEL_FORM = ">" + "".join(code for _, code in CHANNEL)
NODES = ["sim/time/elapsed-sec", *NATIVE, *(node for node, _ in CHANNEL)]


def protocol(folder):
    """The protocol by which FlightGear sends this test what it shows."""
    chunks = "".join(f"<chunk><node>/{node}</node><type>double</type></chunk>\n" for node in NODES)
    (folder / "Protocol").mkdir(parents=True, exist_ok=True)
    (folder / "Protocol/samples.xml").write_text(
        "<?xml version='1.0'?>\n<PropertyList><generic><output><binary_mode>true</binary_mode>"
        f"<byte_order>network</byte_order>\n{chunks}</output></generic></PropertyList>\n"
    )


def bound(port=0):
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    sock.bind(("127.0.0.1", port))
    sock.settimeout(0.2)
    return sock


def in_a_row():
    while True:
        first = bound()
        try:
            return first, bound(first.getsockname()[1] + 1)
        except OSError:
            first.close()


class Listener(threading.Thread):
    """Keeps what comes to a socket, and when."""

    def __init__(self, sock):
        super().__init__(daemon=True)
        self.sock, self.packets, self.over = sock, [], False
        self.start()

    def run(self):
        while not self.over:
            try:
                self.packets.append((time.monotonic(), self.sock.recv(4096)))
            except TimeoutError:
                pass

    def finish(self):
        self.over = True
        self.join()
        self.sock.close()
        return self.packets


def flightgear_of(process):
    """The process that the command started."""
    while process.poll() is None:
        found = subprocess.run(["pgrep", "-P", str(process.pid), "fgfs"], capture_output=True, text=True)
        if found.stdout.split():
            return int(found.stdout.split()[0])
        time.sleep(0.1)
    sys.exit("no FlightGear was started")


def fly(tiltrotor, work, arguments, samples):
    """A flight in a FlightGear of its own; its ticks as FlightGear showed them."""
    first, second = in_a_row()
    port = first.getsockname()[1]
    first.close(), second.close()
    listener = Listener(samples)
    log = work / "flight.mcap"
    command = [tiltrotor, "fly", "--pilot", "takeoff", "--duration", str(FLIGHT_S), "--out", str(log)]
    command += ["--launch-flightgear", "--terrasync", "off", "--flightgear", f"127.0.0.1:{port}", "--ground", "flat"]
    sample_port = samples.getsockname()[1]
    ours = [f"--data={work / 'data'}", f"--generic=socket,out,250,127.0.0.1,{sample_port},udp,samples"]
    command += [f"--fgfs-arg={argument}" for argument in ours + arguments]
    process = subprocess.Popen(command)
    flightgear = flightgear_of(process)
    tick = lambda packet: struct.unpack_from(">d", packet, 8 * NODES.index("tiltrotor/tick"))[0]
    while not listener.packets or tick(listener.packets[-1][1]) < 1000:
        if process.poll() is not None:
            sys.exit(f"the flight ended before it was shown, with {process.returncode}")
        time.sleep(0.01)
    # A frame may be late, and never early.
    began = min(came - tick(packet) * 0.004 for came, packet in listener.packets if tick(packet) >= 1)
    until = lambda moment: time.sleep(max(0, began + moment - time.monotonic()))
    until(STARVED_S[0])
    while time.monotonic() < began + STARVED_S[1]:
        os.kill(flightgear, signal.SIGSTOP)
        time.sleep(0.95)
        os.kill(flightgear, signal.SIGCONT)
        time.sleep(0.05)
    until(FLIGHT_S - 2)
    os.kill(flightgear, signal.SIGSTOP)
    until(FLIGHT_S - 2 + FROZEN_S)
    woken = time.monotonic()
    os.kill(flightgear, signal.SIGCONT)
    assert process.wait() == 0, f"fly ended with {process.returncode}"
    return log, began, woken, listener.finish()


def replayed(tiltrotor, log):
    """Every tick's two packets, from the log."""
    first, second = in_a_row()
    place = f"127.0.0.1:{first.getsockname()[1]}"
    native, beside = Listener(first), Listener(second)
    subprocess.run([tiltrotor, "replay", str(log), "--flightgear", place, "--hold", "0"], check=True)
    ticks = {}
    for (_, fdm), (_, packet) in zip(native.finish(), beside.finish()):
        values = dict(zip((node for node, _ in CHANNEL), struct.unpack(CHANNEL_FORM, packet)))
        for node, (offset, code, factor, _) in NATIVE.items():
            values[node] = struct.unpack_from(">" + code, fdm, offset)[0] * factor
        ticks[int(values["tiltrotor/tick"])] = (values, fdm)
    return ticks


def differs(shown, expected, node):
    tolerance = NATIVE[node][3] if node in NATIVE else 1e-5 * max(1, abs(expected))
    return abs(shown - expected) > max(tolerance, 2e-7 * abs(expected))


def compare(frames, ticks):
    """Frames of one tick, frames whose native packet is a neighbour's or, after a stall, of another tick, and
    what is of no tick. The system keeps two queues: when both overflowed, the frame that empties them may find
    them at different ends; the next one has the newest of both.
    """
    whole, beside, torn, wrong, place_m = 0, 0, 0, [], 0.0
    heights = sorted((values["position/altitude-ft"], tick) for tick, (values, _) in ticks.items())
    for frame in frames:
        tick = int(frame["tiltrotor/tick"])
        expected = ticks.get(tick)
        if expected is None:
            wrong.append(f"tick {tick} is in no log")
            continue
        bad = [n for n, _ in CHANNEL if n not in LAMPS and differs(frame[n], expected[0][n], n)]
        if bad:
            wrong.append(f"tick {tick}: {bad[0]} {frame[bad[0]]} is not {expected[0][bad[0]]}")
            continue
        for away in (0, 1, -1, 2, -2):
            near = ticks.get(tick + away)
            if near and not (bad := [n for n in NATIVE if differs(frame[n], near[0][n], n)]):
                whole, beside = (whole + 1, beside) if away == 0 else (whole, beside + 1)
                north = (frame["position/latitude-deg"] - near[0]["position/latitude-deg"]) * METRES_PER_DEGREE
                east = (frame["position/longitude-deg"] - near[0]["position/longitude-deg"]) * METRES_PER_DEGREE
                up = (frame["position/altitude-ft"] - near[0]["position/altitude-ft"]) * 0.3048
                place_m = max(place_m, math.hypot(north, east, up))
                break
        else:
            at = bisect.bisect(heights, (frame["position/altitude-ft"] - 1e-3,))
            near = itertools.takewhile(lambda row: row[0] < frame["position/altitude-ft"] + 1e-3, heights[at:])
            if any(not any(differs(frame[n], ticks[t][0][n], n) for n in NATIVE) for _, t in near):
                torn += 1
                continue
            bad = [n for n in NATIVE if differs(frame[n], expected[0][n], n)]
            wrong.append(f"tick {tick}: {bad[0]} {frame[bad[0]]} is not {expected[0][bad[0]]}")
    return whole, beside, torn, wrong, place_m


def place_of_log(tiltrotor, log, ticks):
    """The place that the packets tell beside the log's own outputs, m."""
    lines = subprocess.run([tiltrotor, "log", "cat", str(log), "--topic", "/outputs"], capture_output=True, text=True, check=True)
    worst, count = 0.0, 0
    for line in lines.stdout.splitlines():
        outputs = json.loads(line)
        if (tick := int(outputs["tick"])) not in ticks:
            continue
        fdm = ticks[tick][1]
        longitude, latitude, height = struct.unpack_from(">ddd", fdm, 8)
        north = (latitude * PLACE_DEG_PER_RAD - outputs["place.latitude_rad"] * DEG) * METRES_PER_DEGREE
        east = (longitude * PLACE_DEG_PER_RAD - outputs["place.longitude_rad"] * DEG) * METRES_PER_DEGREE
        worst = max(worst, math.hypot(north, east, height - outputs["place.height_m"]))
        count += 1
    assert count > 500, f"{count} outputs"
    return worst


def main():
    tiltrotor, work, *arguments = sys.argv[1:]
    work = Path(work)
    protocol(work / "data")
    log, began, woken, packets = fly(tiltrotor, work, arguments, bound())
    form = ">" + "d" * len(NODES)
    frames = [(came, dict(zip(NODES, struct.unpack(form, packet)))) for came, packet in packets]
    frames = [(came, frame) for came, frame in frames if frame["tiltrotor/tick"] >= 1]
    ticks = replayed(tiltrotor, log)
    assert len(ticks) == FLIGHT_S * 250, f"{len(ticks)} ticks replayed"
    whole, beside, torn, wrong, place_m = compare([frame for _, frame in frames], ticks)
    log_m = place_of_log(tiltrotor, log, ticks)
    shown = [frame["tiltrotor/tick"] for _, frame in frames]
    rate = sum(1 for came, _ in frames if came < began + STARVED_S[0]) / STARVED_S[0]
    print(f"{len(frames)} frames, {rate:.1f} a second: {whole} of one tick, {beside} of neighbouring ones, {torn} of two after a stall, {len(wrong)} of none")
    print(f"{len(NODES) - 1} properties a frame; place within {place_m * 1000:.3f} mm of the packets', those within {log_m * 1000:.3f} mm of the log's")
    for words in wrong[:5]:
        print("  " + words)
    assert not wrong, f"{len(wrong)} frames"
    assert len(frames) >= 60 and whole >= 0.9 * len(frames), "frames of one tick"
    assert torn <= 0.05 * len(frames), "frames after a stall"
    assert place_m < 0.01 and log_m < 0.01, "a centimetre"
    assert all(a <= b for a, b in zip(shown, shown[1:])), "never backwards"
    # As the eye sees it, before the program is starved: at the rate that it reaches here. How late a frame comes is
    # told and not judged: this reader is late, too, on a machine that others use.
    smooth = [(came, frame["tiltrotor/tick"]) for came, frame in frames if came < began + STARVED_S[0]]
    repeats = sum(a == b for (_, a), (_, b) in zip(smooth, smooth[1:])) / max(1, len(smooth) - 1)
    late_s = sorted(came - began - tick * 0.004 for came, tick in smooth)
    late_m = (late_s[len(late_s) * 99 // 100] - late_s[0]) * KNOTS_150_MPS
    print(f"smooth: {len(smooth)} frames at {rate:.1f} a second, none backwards, {repeats * 100:.1f} % repeats; "
          f"at 150 kt 99 % are drawn within {late_m:.2f} m of their place")
    assert repeats <= 0.01, "at most 1 % of repeats"
    # A twentieth of the time: what is drawn is no older than the second that it stood still.
    starved = [(came - began) / 0.004 - frame["tiltrotor/tick"] for came, frame in frames
               if began + STARVED_S[0] + 1 < came < began + STARVED_S[1]]
    print(f"at a twentieth of the time {len(starved)} frames, {max(starved, default=0) * 0.004:.2f} s behind at most")
    assert starved, "it draws now and then"
    newest = next((came for came, frame in frames if frame["tiltrotor/tick"] == FLIGHT_S * 250), None)
    assert newest, f"the end is never shown: {shown[-1]}"
    print(f"the end is shown {newest - woken:.2f} s after it woke")
    assert newest - woken < 1.0, "within a second of waking"


main()
