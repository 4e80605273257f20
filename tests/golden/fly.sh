#!/bin/sh
# Flies the golden flights anew, from scripts and pilot models, and cuts out what is kept. For changes
# after which the recorded inputs no longer make sense (another cockpit map, another layout of the log);
# after a change of motion alone, `tiltrotor verify --bless tests/golden/*.mcap` keeps the inputs.
set -eu
cd "$(dirname "$0")/../.."
tiltrotor() { ${TILTROTOR:-cargo run --quiet --release --no-default-features --} "$@"; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fly() { # NAME ARGUMENTS
    name=$1
    shift
    tiltrotor fly --fast --no-flightgear --out "$work/$name.mcap" "$@" > "$work/said" || {
        cat "$work/said"
        exit 1
    }
}
golden() { # FLIGHT NAME REASON WINDOW
    flight=$1 name=$2 reason=$3
    shift 3
    tiltrotor log clip "$work/$flight.mcap" --force --as-golden "$name" --reason "$reason" "$@"
}

fly demo --pilot demo
golden demo lift-off "From the wheels into the hover, with ground effect, SCAS and the start of a flight" --until 14
golden demo marker "Eight seconds around the pilot's marker, cut out of the middle of a flight" --around marker:1 --window 4
golden demo landing "Touchdown: struts, tyre treads, weight on wheels, the end of a flight" --from "$(
    tiltrotor log info "$work/demo.mcap" | awk '/touchdown/ { print $1 - 5; exit }'
)"
fly conversion --script tests/golden/flown/conversion.toml \
    --from-trim --nacelle 60 --speed-kt 110 --altitude-ft 2000
golden conversion conversion "Nacelles forward and back in flight: mixer, phasing, wake on the tail"
fly gust --script tests/golden/flown/gust.toml \
    --from-trim --nacelle 0 --speed-kt 180 --altitude-ft 5000
golden gust gust "Turbulence from its seed and a discrete gust at 180 kt as an aeroplane"
fly engine --script tests/golden/flown/engine_failure.toml \
    --from-trim --nacelle 0 --speed-kt 180 --altitude-ft 5000
golden engine engine-failure "One engine stops and comes back: cross shaft, governor, ratings"
