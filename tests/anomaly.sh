#!/usr/bin/env bash
# The story of docs/anomaly.md as it runs: every command of it, in order, and what each one prints. Fails when
# the page says otherwise; lines that tell how long something took are not compared.
# Usage: tests/anomaly.sh [--write] [TILTROTOR]   (--write puts today's outputs into the page)
set -euo pipefail
cd "$(dirname "$0")/.."

write=
if [ "${1:-}" = --write ]; then
    write=1
    shift
fi
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
tiltrotor=$(realpath "$tiltrotor")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/flight"
ln -s "$tiltrotor" "$work/bin/tiltrotor"
cp tests/anomaly/hidden.toml "$work/flight"

PATH="$work/bin:$PATH" python3 - docs/anomaly.md "$work/flight" "$write" <<'PYTHON'
import difflib
import re
import subprocess
import sys
from pathlib import Path

page, folder, write = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
# How long something took, and how well it packs beside what tells that.
TIMING = re.compile(r"^((tiltrotor: )?the clock slipped|overruns|late by|step|hand-over|to picture|writer|self-check|reflown in)\b")
# When the flight was flown, and what follows from it.
MOMENT = re.compile(r"(seal|started_unix_ns): .*")
# How many pictures a wall second of a fast replay holds is the machine's.
PACKETS = re.compile(r"\d+ pictures sent to (\S+), \d+ not")
SIZE = re.compile(r"\d+(\.\d+)? (B|kB|MB)\b")


def run(command):
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    said = done.stdout.rstrip("\n").splitlines()
    return said + ([f"(exit status {done.returncode})"] if done.returncode else [])


def compared(lines):
    told = [line for line in lines if not TIMING.match(line)]
    for pattern, words in ((PACKETS, "packets"), (SIZE, "SIZE"), (MOMENT, "moment")):
        told = [pattern.sub(words, line) for line in told]
    return told


old = page.read_text().splitlines()
new, in_console, commands = [], False, 0
for line in old:
    if line.startswith("```"):
        in_console = line == "```console"
        new.append(line)
    elif not in_console:
        new.append(line)
    elif line.startswith("$ "):
        commands += 1
        new += [line, *run(line[2:])]
assert commands > 0, "no command in the page"
if write:
    page.write_text("\n".join(new) + "\n")
difference = list(difflib.unified_diff(compared(old), compared(new), "the page", "today", lineterm=""))
if difference and not write:
    print("\n".join(difference))
    sys.exit(f"{page} is stale: look at what changed, then tests/anomaly.sh --write")
print(f"{page}: {commands} commands, their outputs are those of the page")
PYTHON
