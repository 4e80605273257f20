#!/bin/sh
# Every pilot model from every start that the command offers: nacelles at 0, 30, 60 and 90 degrees, each
# rotor speed that the governor offers there, and the runway. Each flies its task, or gives up in words
# and ends with 4; anything else fails. Prints the table.
#
#   tests/pilot_matrix.sh
set -eu
cd "$(dirname "$0")/.."
cargo build --release --no-default-features
tiltrotor=${CARGO_TARGET_DIR:-target}/release/tiltrotor
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# The phase in which a pilot's task is done when it is reached; those that land end by themselves.
goal() {
    case $1 in
    hover | reconvert) echo hover ;;
    takeoff) echo helicopter ;;
    convert) echo aeroplane ;;
    turn) echo "left turn" ;;
    *) echo "end of the flight: the pilot model or script has ended" ;;
    esac
}

# fly NAME PILOT ARGUMENTS...: one line of the table
fly() {
    name=$1 pilot=$2
    shift 2
    # Who lands ends the flight; what has no end is given longer than any phase before it should take.
    case $pilot in land | demo | sideways | sweep-*) ;; *) set -- --duration 420 "$@" ;; esac
    status=0
    "$tiltrotor" fly --pilot "$pilot" --fast --force --no-flightgear "$@" \
        --out "$work/flight.mcap" >"$work/said" 2>&1 || status=$?
    story=$("$tiltrotor" log info "$work/flight.mcap" 2>/dev/null || true)
    case $status in
    0) if echo "$story" | grep -qx "  *[0-9.]* s  $(goal "$pilot")"; then
        answer="flew it"
    else
        answer="WRONG: neither flown nor given up"
    fi ;;
    4) answer="$(grep -h -o 'the pilot gave up.*' "$work/said" | head -1)"
        [ -n "$answer" ] || answer="WRONG: 4 without a word" ;;
    *) answer="WRONG: status $status: $(tail -1 "$work/said")" ;;
    esac
    case $answer in WRONG*) failures=$((failures + 1)) ;; esac
    took=$(sed -n 's/^flown *\([0-9.]*\) s.*/\1/p' "$work/said")
    printf '%-28s %-10s %s  %6s s  %s\n' "$name" "$pilot" "$status" "$took" "$answer"
}

for pilot in hover takeoff convert turn reconvert land demo sideways sweep-pitch; do
    fly "runway" "$pilot"
    # nacelle, speed in kt, rotor speed in rpm
    for start in "0 180 458" "0 180 517" "0 180 589" "30 130 589" "60 100 589" "90 0 589" "90 60 589"; do
        set -- $start
        fly "nacelle $1, $2 kt, $3 rpm" "$pilot" --from-trim --nacelle "$1" --speed-kt "$2" --rpm "$3"
    done
done
[ "$failures" = 0 ] || { echo "$failures wrong" >&2; exit 1; }
