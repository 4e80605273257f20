"""Decodes every channel of a flight log with rosbags, by the types of the generated ROS 2 package.

Every number must be the one that `mcap-ros2-support` finds and that `tiltrotor log cat` prints, to the bit.

Usage: rosbags_cdr.py FLIGHT.mcap TILTROTOR PACKAGE_FOLDER
"""

import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from cdr import RECORDED, VIEWED, flatten, same

MESSAGE_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")
FIELD_NAME = re.compile(r"[a-z](_?[a-z0-9])*")


def numbers(value, path, into):
    """Numbers and texts of a message that rosbags decoded, by their path."""
    fields = getattr(value, "__dataclass_fields__", None)
    if fields is not None:
        for name in fields:
            if name != "__msgtype__":
                numbers(getattr(value, name), f"{path}.{name}" if path else name, into)
    elif isinstance(value, numpy.ndarray):
        for index, item in enumerate(value.tolist()):
            into[f"{path}[{index}]"] = item
    elif isinstance(value, (list, tuple)):
        for index, item in enumerate(value):
            numbers(item, f"{path}[{index}]", into)
    else:
        into[path] = value


def package_types(folder):
    """The types of the package, each file parsed; every name is one that ROS 2 allows."""
    package = folder.name
    types = {}
    files = sorted((folder / "msg").glob("*.msg"))
    for file in files:
        assert MESSAGE_NAME.fullmatch(file.stem), file
        for line in file.read_text().splitlines():
            kind, name = line.split()
            assert FIELD_NAME.fullmatch(name), (file, name)
            assert "/" not in kind, (file, line)
        types.update(get_types_from_msg(file.read_text(), f"{package}/msg/{file.stem}"))
    listed = re.findall(r'"msg/(\w+)\.msg"', (folder / "CMakeLists.txt").read_text())
    assert listed == [file.stem for file in files], listed
    assert f"<name>{package}</name>" in (folder / "package.xml").read_text()
    return types


def main():
    log, tiltrotor, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    ours = subprocess.Popen([tiltrotor, "log", "cat", log], stdout=subprocess.PIPE, text=True)
    by_package, by_schema = get_typestore(Stores.EMPTY), get_typestore(Stores.EMPTY)
    by_package.register(package_types(folder))
    counts, compared = Counter(), 0
    with open(log, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema in reader.get_summary().schemas.values():
            # One at a time: a name with two definitions is refused by rosbags.
            by_schema.register(get_types_from_msg(schema.data.decode(), schema.name))
        for schema, channel, raw, message in reader.iter_decoded_messages(log_time_order=False):
            topic = channel.topic
            counts[topic] += 1
            theirs, rosbags = {}, {}
            flatten(message, "", theirs)
            numbers(by_schema.deserialize_cdr(raw.data, schema.name), "", rosbags)
            compare(topic, rosbags, theirs)
            if topic in RECORDED:
                line = json.loads(next(ours.stdout))
                assert line.pop("topic") == topic and line.pop("time_ns") == raw.log_time, topic
                compare(topic, rosbags, line)
                packaged, name = {}, schema.name.replace("tiltrotor", folder.name, 1)
                numbers(by_package.deserialize_cdr(raw.data, name), "", packaged)
                compare(topic, packaged, line)
            compared += len(rosbags)
    assert ours.stdout.read() == "" and ours.wait() == 0
    missing = (RECORDED | VIEWED) - counts.keys()
    assert not missing, missing
    print(f"rosbags: {len(counts)} channels, {compared} values as mcap-ros2-support and ours have them")


def compare(topic, ours, theirs):
    """Two readers' values of a message, to the bit."""
    assert ours.keys() == theirs.keys(), (topic, ours.keys() ^ theirs.keys())
    for path, value in ours.items():
        assert same(value, theirs[path]), (topic, path, value, theirs[path])


if __name__ == "__main__":
    main()
