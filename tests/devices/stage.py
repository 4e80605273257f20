#!/usr/bin/env python3
"""A program among input devices that come and go, made of umockdev's files by its library.

    umockdev-wrapper /usr/bin/python3 stage.py < JOB > RESULT

JOB is JSON: folder; program with its arguments; devices, those that are there at the start; plan, a list
of [seconds, action, device] or [seconds, "play", device, file]; limit, seconds. The plan's clock starts
when the program has said `begin` and the file `log`, if there is to be one, has been begun. The actions:
    plug      the device appears, udev says so; the library can plug in each once, and play one file of each
    unplug    it is gone, udev says so
    vanish    udev alone says that it is gone
    appear    udev alone says that it is there
    hang_up   reads fail, udev says nothing
    play      its events of the file
RESULT is JSON: status, said, cpu (seconds of the program)."""
import glob
import json
import os
import resource
import subprocess
import sys
import threading
import time

import gi

gi.require_version("UMockdev", "1.0")
from gi.repository import UMockdev  # noqa: E402

job = json.load(sys.stdin)
bed = UMockdev.Testbed.new()


def path(device, kind):
    return os.path.join(job["folder"], f"{device}.{kind}")


def node(device):
    with open(path(device, "ioctl")) as lines:
        return next(lines).split()[1]


def in_sysfs(device):
    with open(path(device, "umockdev")) as lines:
        return "/sys" + next(lines).split()[1]


def add(device):
    bed.add_from_file(path(device, "umockdev"))
    bed.load_ioctl(node(device), path(device, "ioctl"))


def unplug(device):
    bed.uevent(in_sysfs(device), "remove")
    bed.remove_device(os.path.dirname(in_sysfs(device)))


def plug(device):
    add(device)
    bed.uevent(in_sysfs(device), "add")


ACTIONS = {
    "plug": plug,
    "unplug": unplug,
    "vanish": lambda device: bed.uevent(in_sysfs(device), "remove"),
    "appear": lambda device: bed.uevent(in_sysfs(device), "add"),
    "hang_up": lambda device: os.close(bed.get_dev_fd(node(device))),
    "play": lambda device, events: bed.load_evemu_events(node(device), events),
}

for device in job["devices"]:
    add(device)
program = subprocess.Popen(
    job["program"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
    text=True, errors="replace")
said, begun = [], threading.Event()


def listen():
    for line in program.stdout:
        said.append(line)
        if job["begin"] in line:
            begun.set()
    begun.set()


listener = threading.Thread(target=listen)
listener.start()
begun.wait(job["limit"])
while job["log"] and program.poll() is None and not glob.glob(job["log"] + "*"):
    time.sleep(0.01)
start = time.monotonic()
for seconds, action, *what in sorted(job["plan"], key=lambda step: step[0]):
    time.sleep(max(0.0, start + seconds - time.monotonic()))
    ACTIONS[action](*what)
try:
    status = program.wait(job["limit"])
except subprocess.TimeoutExpired:
    program.kill()
    status = program.wait()
listener.join()
used = resource.getrusage(resource.RUSAGE_CHILDREN)
json.dump({"status": status, "said": "".join(said), "cpu": used.ru_utime + used.ru_stime}, sys.stdout)
