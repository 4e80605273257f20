#!/usr/bin/env python3
"""Writes the message types of a flight log as a ROS 2 package: msg/*.msg, package.xml, CMakeLists.txt.

The types are those that the log itself defines, so that they are right for the log whatever its version.

Usage: generate.py FLIGHT.mcap FOLDER [PACKAGE]        (needs `pip install mcap lz4 zstandard`)
"""

import re
import sys
from pathlib import Path

from mcap.reader import make_reader

# The package of our types in the log.
OURS = "tiltrotor"
RULE = re.compile(r"^=+\n", re.MULTILINE)

PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>{version}</version>
  <description>Message types of tiltrotor flight logs, log format {format}</description>
  <maintainer email="nobody@example.com">nobody</maintainer>
  <license>MIT OR Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""

CMAKE = """cmake_minimum_required(VERSION 3.8)
project({package})
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${{PROJECT_NAME}}
{messages}
)
ament_export_dependencies(rosidl_default_runtime)
ament_package()
"""


def definitions(schemas):
    """Name and fields of each of our types; a name means one type in the whole log."""
    found = {}
    for schema in schemas:
        if schema.name.split("/")[0] != OURS:
            continue
        first, *others = RULE.split(schema.data.decode())
        parts = [(schema.name.rsplit("/", 1)[1], first)]
        for part in others:
            head, body = part.split("\n", 1)
            parts.append((head.removeprefix("MSG: ").rsplit("/", 1)[1], body))
        for name, body in parts:
            # A type of one's own package is named without it.
            body = re.sub(rf"^{OURS}/(?:msg/)?", "", body, flags=re.MULTILINE)
            if found.setdefault(name, body) != body:
                sys.exit(f"two definitions of {name}")
    return found


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    package = sys.argv[3] if len(sys.argv) == 4 else f"{OURS}_msgs"
    with open(sys.argv[1], "rb") as log:
        reader = make_reader(log)
        types = definitions(reader.get_summary().schemas.values())
        facts = next(m.metadata for m in reader.iter_metadata() if m.name == OURS)
    if not types:
        sys.exit(f"{sys.argv[1]}: no message type of {OURS} in it")
    folder = Path(sys.argv[2]) / package
    (folder / "msg").mkdir(parents=True, exist_ok=True)
    for name, body in sorted(types.items()):
        (folder / "msg" / f"{name}.msg").write_text(body)
    said = {"version": facts["program"].split()[-1], "format": facts["format_version"], "package": package}
    (folder / "package.xml").write_text(PACKAGE_XML.format(**said))
    messages = "\n".join(f'  "msg/{name}.msg"' for name in sorted(types))
    (folder / "CMakeLists.txt").write_text(CMAKE.format(package=package, messages=messages))
    print(f"{folder}: {len(types)} message types")


if __name__ == "__main__":
    main()
