#!/bin/sh
# Is this commit's motion that of a recorded flight? For `git bisect run`, see bisect.md.
#
#   bisect.sh FLIGHT.mcap
#
# Exit 0 good, 1 bad, 125 skip.
set -u

[ $# -eq 1 ] && [ -r "$1" ] || { echo "usage: $0 FLIGHT.mcap" >&2; exit 255; }

# What does not build can say nothing of the flight.
cargo build --release --no-default-features --quiet || exit 125

"${CARGO_TARGET_DIR:-target}/release/tiltrotor" verify "$1"
case $? in
    0 | 3) exit 0 ;;
    1) exit 1 ;;
    # Refused: another model version or log format, or a command from before it could.
    *) exit 125 ;;
esac
