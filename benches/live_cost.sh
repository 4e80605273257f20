#!/usr/bin/env bash
# What a viewer that is attached costs a flight in real time: CPU of the whole program, and how its ticks kept time,
# without one and with one.
# Usage: benches/live_cost.sh [TILTROTOR [SECONDS]]
set -euo pipefail
tiltrotor=$(realpath -e "${1:-$(dirname "$0")/../target/release/tiltrotor}")
seconds=${2:-30}
cd "$(dirname "$0")/.."

rerun=target/rerun-0.36.3/bin/rerun
[ -x "$rerun" ] || { echo "$0: no viewer: tests/rerun_screenshot.sh brings it" >&2; exit 2; }
# The program itself: the script that starts it would be ended in its place.
viewer=$(find target/rerun-0.36.3/lib -path '*rerun_cli/rerun' -type f | head -1)
work=$(mktemp -d)
port=$(python3 -c 'import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
"$viewer" --serve-grpc --bind 127.0.0.1 --port "$port" >/dev/null 2>&1 &
listening=$!
trap 'kill "$listening" 2>/dev/null || true; rm -rf "$work"' EXIT
sleep 3

python3 - "$tiltrotor" "$work" "$seconds" "$port" <<'PYTHON'
import resource, subprocess, sys

tiltrotor, work, seconds, port = sys.argv[1:]
fly = [tiltrotor, "fly", "--pilot", "hover", "--no-flightgear", "--no-panel", "--ground", "flat", "--duration", seconds]
used = 0.0
for name, more in ("alone", []), ("shown", ["--rerun", f"127.0.0.1:{port}"]):
    ran = subprocess.run(fly + ["--out", f"{work}/{name}.mcap"] + more, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL)
    if ran.returncode:
        sys.exit(ran.stdout)
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu, used = now.ru_utime + now.ru_stime - used, now.ru_utime + now.ru_stime
    print(f"{name}: {cpu:.2f} s of CPU in {seconds} s of flight")
    for line in ran.stdout.splitlines():
        if line.startswith(("step", "hand-over", "late", "wake", "live:", "jitter", "tick")):
            print("   ", line)
PYTHON
