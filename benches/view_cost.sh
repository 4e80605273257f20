#!/usr/bin/env bash
# What drawing a recording costs beside rerun's own conversion of the same log in the same run: CPU and memory.
# Usage: benches/view_cost.sh LOG.mcap [TILTROTOR]
# Fails above 0.35 times the CPU of `rerun mcap convert`, and above 60 MB.
set -euo pipefail
# As given, from where it is called.
log=$(realpath -e "${1:?a log}")
tiltrotor=${2:+$(realpath -e "$2")}
cd "$(dirname "$0")/.."

RATIO_MAX=0.35
KB_MAX=61440
tiltrotor=${tiltrotor:-target/release/tiltrotor}
rerun=target/rerun-0.36.3/bin/rerun
[ -x "$rerun" ] || { echo "$0: no viewer: tests/rerun_screenshot.sh brings it" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# CPU in s and memory in kB of a command, in the file.
cost() {
    local to=$1
    shift
    python3 - "$to" "$@" <<'PYTHON'
import resource, subprocess, sys

subprocess.run(sys.argv[2:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
with open(sys.argv[1], "w") as out:
    print(used.ru_utime + used.ru_stime, used.ru_maxrss, file=out)
PYTHON
}
cost "$work/ours" "$tiltrotor" view "$log" --save "$work/ours.rrd"
cost "$work/theirs" "$rerun" mcap convert "$log" -o "$work/theirs.rrd"
read -r ours ours_kb <"$work/ours"
read -r theirs theirs_kb <"$work/theirs"
python3 - "$ours" "$ours_kb" "$theirs" "$theirs_kb" "$RATIO_MAX" "$KB_MAX" <<'PYTHON'
import sys

ours, ours_kb, theirs, theirs_kb, ratio_max, kb_max = map(float, sys.argv[1:])
print(f"view --save: {ours:.2f} s of CPU, {ours_kb / 1024:.0f} MB; "
      f"rerun mcap convert: {theirs:.2f} s, {theirs_kb / 1024:.0f} MB; ratio {ours / theirs:.2f}")
if ours > ratio_max * theirs or ours_kb > kb_max:
    sys.exit(f"beyond {ratio_max} times or {kb_max / 1024:.0f} MB")
PYTHON
