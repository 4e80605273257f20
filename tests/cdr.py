"""Reads every channel of a flight log with other people's readers, and compares with ours.

The authoritative channels must hold the numbers that `tiltrotor log cat` prints, bit for bit; the
channels for viewers must say the same as the outputs they were made from.

Usage: cdr.py FLIGHT.mcap TILTROTOR
"""

import json
import math
import struct
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

RECORDED = {"/hardware", "/inputs", "/state", "/timing", "/events", "/outputs", "/restart"}
# The demonstration has no input device, and goes back to no other state.
SILENT = {"/devices", "/restart"}
VIEWED = {"/tf", "/robot_description", "/joy", "/fix", "/joint_states", "/log"}


def flatten(value, path, into):
    """Numbers of a decoded message by their path."""
    if hasattr(value, "__slots__"):
        for name in value.__slots__:
            flatten(getattr(value, name), f"{path}.{name}" if path else name, into)
    elif isinstance(value, (list, tuple)):
        for index, item in enumerate(value):
            flatten(item, f"{path}[{index}]", into)
    else:
        into[path] = value


def same(a, b):
    """The same to the bit."""
    if isinstance(a, float) or isinstance(b, float):
        return struct.pack("<d", a) == struct.pack("<d", b)
    return a == b


def single(number):
    """As a 32-bit float holds it."""
    return struct.unpack("<f", struct.pack("<f", number))[0]


def check_view(topic, message, outputs):
    """A view message against the outputs of its moment."""
    if topic == "/joy":
        pilot = outputs.cockpit
        assert message.axes[0] == single(pilot.stick_right_norm), "stick right"
        assert message.axes[1] == single(pilot.stick_aft_norm), "stick aft"
        assert message.axes[2] == single(pilot.collective_norm), "collective"
        assert message.buttons[5] == pilot.markers, "markers"
    elif topic == "/fix":
        place = outputs.place
        assert math.isclose(message.latitude, math.degrees(place.latitude_rad), rel_tol=1e-15)
        assert math.isclose(message.longitude, math.degrees(place.longitude_rad), rel_tol=1e-15)
        assert message.altitude == place.height_m
    elif topic == "/tf":
        aircraft = message.transforms[0]
        assert aircraft.header.frame_id == "tf#/" and aircraft.child_frame_id == "base_link"
        at, p = aircraft.transform.translation, outputs.position_m
        assert (at.x, at.y, at.z) == (p.y, p.x, -p.z), "position"
        q = aircraft.transform.rotation
        norm = math.sqrt(q.x**2 + q.y**2 + q.z**2 + q.w**2)
        assert math.isclose(norm, 1.0, rel_tol=1e-12), "unit quaternion"
        # Forward in the world, from the quaternion and from heading and pitch.
        forward_up = 2 * (q.x * q.z - q.w * q.y)
        assert math.isclose(forward_up, math.sin(outputs.euler.pitch_rad), abs_tol=1e-9), "pitch"
        assert len(message.transforms) == 5
    elif topic == "/joint_states":
        joints = dict(zip(message.name, message.position))
        tilt = outputs.actuators.mast_tilt_rad
        assert math.isclose(joints["nacelle_left"], math.pi / 2 - tilt.left, rel_tol=1e-15)
        assert joints["elevator"] == outputs.actuators.elevator_rad


def main():
    log, tiltrotor = sys.argv[1:]
    ours = subprocess.Popen([tiltrotor, "log", "cat", log], stdout=subprocess.PIPE, text=True)
    counts = Counter()
    numbers = 0
    outputs = {}
    viewed = []
    with open(log, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        topics = {channel.topic for channel in summary.channels.values()}
        assert topics == RECORDED | VIEWED | SILENT, topics ^ (RECORDED | VIEWED | SILENT)
        # In the order of the file, which is ours.
        for _, channel, raw, message in reader.iter_decoded_messages(log_time_order=False):
            topic = channel.topic
            counts[topic] += 1
            if topic in RECORDED:
                line = json.loads(next(ours.stdout))
                assert line.pop("topic") == topic, (line, topic)
                assert line.pop("time_ns") == raw.log_time
                theirs = {}
                flatten(message, "", theirs)
                assert line.keys() == theirs.keys(), line.keys() ^ theirs.keys()
                for path, value in theirs.items():
                    assert same(value, line[path]), (topic, raw.log_time, path, value, line[path])
                numbers += len(theirs)
                if topic == "/outputs":
                    outputs[raw.log_time] = message
            elif topic == "/robot_description":
                robot = ElementTree.fromstring(message.data)
                assert robot.tag == "robot" and robot.find("link") is not None
            elif topic == "/log":
                assert message.msg
            else:
                viewed.append((topic, raw.log_time, message))
        names = {attachment.name for attachment in reader.iter_attachments()}
        assert names == {"aircraft.toml", "cockpit.toml", "scenario.toml"}, names
        facts = {metadata.name: metadata.metadata for metadata in reader.iter_metadata()}
        assert facts["tiltrotor"]["model_version"], facts
    assert ours.stdout.read() == "", "ours has more"
    assert ours.wait() == 0
    compared = 0
    for topic, time, message in viewed:
        if time in outputs:
            check_view(topic, message, outputs[time])
            compared += 1
    assert compared > 0
    for topic in sorted(topics):
        number = next(i for i, channel in summary.channels.items() if channel.topic == topic)
        counted = summary.statistics.channel_message_counts.get(number, 0)
        assert counts[topic] == counted, topic
        assert (counted == 0) == (topic in SILENT), topic
        print(f"{topic:20} {counts[topic]:7} messages")
    print(f"{numbers} numbers equal ours to the bit; {compared} view messages agree with the outputs")


if __name__ == "__main__":
    main()
