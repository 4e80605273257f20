#!/usr/bin/env bash
# Other people's readers read every channel of a flight log, and find our numbers.
# Usage: tests/cdr.sh [TILTROTOR]   (a headless release build without one)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

venv=target/venv-cdr
if [ ! -x "$venv/bin/python" ] || ! "$venv/bin/python" -c "import lz4, mcap_ros2, numpy, rosbags, zstandard"; then
    make_venv "$venv" mcap==1.6.0 mcap-ros2-support==0.6.0 numpy==2.4.6 rosbags==0.11.9 \
        lz4==4.4.5 zstandard==0.25.0
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tiltrotor" demo --fast --no-flightgear --out "$work/flight.mcap"
"$venv/bin/python" tests/cdr.py "$work/flight.mcap" "$tiltrotor"

# A recovered log is a proper file to others: index, attachments, every message.
head -c $(($(stat -c %s "$work/flight.mcap") * 2 / 3)) "$work/flight.mcap" >"$work/cut.mcap"
"$tiltrotor" log recover "$work/cut.mcap" --out "$work/recovered.mcap" || [ $? = 3 ]
"$venv/bin/python" - "$work/recovered.mcap" <<'PYTHON'
import sys
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    expected = reader.get_summary().statistics.message_count
    messages = sum(1 for _ in reader.iter_decoded_messages())
    facts = {record.name: record.metadata for record in reader.iter_metadata()}
assert messages == expected > 0, (messages, expected)
assert facts["tiltrotor"]["recovered_from"] == "cut.mcap", facts
print(f"recovered: {messages} messages, all read")
PYTHON

# rosbags decodes every channel by the ROS 2 package that is generated from the log's own definitions.
printf '[[event]]\nat_s = 2.0\nrestart = "start"\n' >"$work/restart.toml"
"$tiltrotor" fly --pilot hover --script "$work/restart.toml" --fast --duration 3 --out "$work/again.mcap"
"$venv/bin/python" docs/ros2/generate.py "$work/again.mcap" "$work"
"$venv/bin/python" tests/rosbags_cdr.py "$work/again.mcap" "$tiltrotor" "$work/tiltrotor_msgs"

# Logs that other tools wrote anew: the same flight, or refused for the same true reason by every verb.
mkdir "$work/tools"
"$tiltrotor" fly --pilot hover --fast --duration 3 --out "$work/hover.mcap"
"$venv/bin/python" tests/tools.py "$work/hover.mcap" "$tiltrotor" "$work/tools"
