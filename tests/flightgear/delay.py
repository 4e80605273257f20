#!/usr/bin/env python3
"""Transport delay: from a step of the stick to the first changed pixel of the stick in FlightGear's window.

Usage: delay.py TILTROTOR SCREEN.xwd FDM-PORT FOLDER
What is looked at is the stick in the cockpit, which moves by what is sent and stands still before the cockpit:
no dynamics of the aircraft are in it. The step is an event of a script. It counts from the first packet
that carries it, as a second receiver of the same flight gets it; the flight itself measures what is
before that, from the event to the packet, and prints it at its end.
"""
import mmap
import select
import socket
import statistics
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree as tree

PROTOCOL = "flightgear/data/Protocol/tiltrotor.xml"
LIMIT_MS = 150.0
STICK = 0.5
# Steps that tell where to look, and steps that are measured.
LEARNED = 2
STEPS = 10


class Screen:
    """The screen of Xvfb as it is in memory."""

    def __init__(self, path):
        file = open(path, "rb")
        self.memory = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        head = struct.unpack(">25I", self.memory[:100])
        self.start = head[0] + head[19] * 12
        self.wide, self.high, self.stride = head[4], head[5], head[12]

    def bytes(self):
        return self.memory[self.start:self.start + self.stride * self.high]


def field_of(node):
    """Offset and code of a number of the channel."""
    codes = {"int": "i", "float": "f", "double": "d"}
    at = 0
    for chunk in tree.parse(PROTOCOL).getroot().find("generic/input").iter("chunk"):
        code = codes[chunk.findtext("type")]
        if chunk.findtext("node") == node:
            return at, ">" + code
        at += struct.calcsize(code)
    raise SystemExit(f"{PROTOCOL} has no {node}")


def telling(pairs):
    """The pixels that change most with every one of some steps, and by how much they do together at least."""
    def change(i):
        return min(abs(before[i] - after[i]) for before, after in pairs)
    most = sorted(((change(i), i - 1) for i in range(1, len(pairs[0][0]), 4)), reverse=True)[:24]
    pixels = [at for by, at in most if by > 10]
    assert len(pixels) >= 8, f"the stick is not seen to move: {most[:8]}"
    together = min(sum(abs(before[at + 1] - after[at + 1]) for at in pixels) for before, after in pairs)
    return pixels, together


def script_of(steps):
    """Steps of the stick to either side, in turn, half a second each."""
    events = ["[[event]]\nat_s = 0.0\naxis = { stick_right = 0.0 }\n"]
    for step in range(steps):
        at_s, way = 2.0 + 1.6 * step, STICK if step % 2 else -STICK
        events.append(f"[[event]]\nat_s = {at_s}\naxis = {{ stick_right = {way} }}\n")
        events.append(f"[[event]]\nat_s = {at_s + 0.5}\naxis = {{ stick_right = 0.0 }}\n")
    return "\n".join(events)


def measure(tiltrotor, screen, fdm, folder, name, start):
    """Delays of one flight, s, and what it says of itself. The first steps tell where to look."""
    script = f"{folder}/{name}.toml"
    with open(script, "w") as file:
        file.write(script_of(LEARNED + STEPS))
    twin = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    twin.bind(("127.0.0.1", 0))
    twin.setblocking(False)
    at, code = field_of("/tiltrotor/control/stick-right-norm")
    flight = subprocess.Popen(
        [tiltrotor, "fly", "--script", script, "--from-trim", *start, "--duration",
         str(3 + 1.6 * (LEARNED + STEPS)), "--no-panel", "--force", "--hold", "0", "--out", f"{folder}/{name}.mcap",
         "--flightgear", f"127.0.0.1:{fdm}", "--flightgear", f"127.0.0.1:{twin.getsockname()[1] - 1}"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    pairs, pixels, together, delays, missed = [], None, 0, [], 0
    last, stepped, before = 0.0, None, None
    while flight.poll() is None:
        ready, _, _ = select.select([twin], [], [], 0.0005)
        while ready:
            try:
                packet = twin.recv(2048)
            except BlockingIOError:
                break
            stick = struct.unpack_from(code, packet, at)[0]
            if abs(stick) > 0.4 and abs(last) < 0.1:
                stepped, before = time.monotonic(), screen.bytes()
            last = stick
        if stepped is None:
            continue
        since = time.monotonic() - stepped
        if pixels is None:
            if since > 0.42:
                pairs.append((before, screen.bytes()))
                stepped = None
            if len(pairs) == LEARNED:
                pixels, together = telling(pairs)
        elif sum(abs(screen.memory[screen.start + 1 + i] - before[i + 1]) for i in pixels) > 0.4 * together:
            delays.append(since)
            stepped = None
        elif since > 0.48:
            # It goes back to the middle.
            missed += 1
            stepped = None
    return delays, missed, flight.stdout.read()


def main():
    tiltrotor, path, fdm, folder = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
    screen = Screen(path)
    worst = 0.0
    for name, start in [("helicopter", ["--nacelle", "90", "--speed-kt", "0", "--altitude-ft", "1500"]),
                        ("aeroplane", ["--nacelle", "0", "--speed-kt", "160", "--altitude-ft", "1500"])]:
        delays, missed, said = measure(tiltrotor, screen, fdm, folder, name, start)
        assert len(delays) >= STEPS // 2, f"{name}: {len(delays)} of {STEPS} steps seen\n{said[-2000:]}"
        ms = sorted(delay * 1e3 for delay in delays)
        median = statistics.median(ms)
        worst = max(worst, median)
        print(f"{name}: packet to pixel: median {median:.1f} ms, {ms[0]:.1f} to {ms[-1]:.1f} ms; {len(ms)} steps,"
              f" {missed} not seen within 480 ms")
        for line in said.splitlines():
            if "to picture" in line or "sent to" in line:
                print(f"  {line.strip()}")
    print(f"limit {LIMIT_MS:.0f} ms (CS-FSTD(A), transport delay); the greater median is {worst:.1f} ms")
    raise SystemExit(0 if worst <= LIMIT_MS else 1)


if __name__ == "__main__":
    main()
