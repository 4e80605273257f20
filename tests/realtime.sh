#!/bin/sh
# Real time under load: a flight at 250 Hz beside cyclictest, at the same priority and with the same method
# (an absolute sleep, no spin), while every processor is busy and the disk is written to. Ours may be later
# than cyclictest by 0.2 ms at p99.9, no more. Then the system calls of the loop's thread are counted: one
# sleep a tick, one send for each channel of FlightGear, and nothing else.
#
#   tests/realtime.sh [SECONDS]      600 without; 20 for a first look
#
# TILTROTOR names the program; without it, the release build is taken. Needs cyclictest (rt-tests), strace,
# and the permission for real-time scheduling.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-600}
program=$(realpath "${TILTROTOR:-target/release/tiltrotor}")
for tool in cyclictest strace; do
    command -v $tool >/dev/null || { echo "needs $tool (Debian: rt-tests, strace)"; exit 2; }
done
folder=$(mktemp -d)
children=
trap 'for child in $children; do kill "$child" 2>/dev/null || true; done; rm -rf "$folder"' EXIT

echo "machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1), $(nproc) processors, $(uname -r)"

# The load: a busy loop for each processor, and a writer.
for _ in $(seq "$(nproc)"); do
    sh -c 'while :; do :; done' &
    children="$children $!"
done
sh -c "while :; do dd if=/dev/zero of=$folder/load bs=1M count=32 conv=fdatasync 2>/dev/null; sleep 1; done" &
children="$children $!"

# Pictures go to a port where nobody listens.
"$program" fly --pilot hover --no-panel --spin-us 0 --duration "$seconds" \
    --flightgear 127.0.0.1:45501 --out "$folder/flight.mcap" >"$folder/said" &
flight=$!
children="$children $flight"
sleep 1
# The priority of the loop's thread, as the system has it: field 40 of its stat.
priority=0
for stat in /proc/$flight/task/*/stat; do
    found=$(sed 's/.*) //' "$stat" | cut -d' ' -f38)
    [ "$found" -le "$priority" ] || priority=$found
done
[ "$priority" -gt 0 ] || { echo "no real-time scheduling here: nothing to compare"; exit 2; }
echo "SCHED_FIFO, priority $priority, both"
loops=$(((seconds - 2) * 250))
cyclictest -q -m -t1 -p "$priority" -i 4000 -l "$loops" -h 200000 >"$folder/cyclictest"
wait "$flight"
for child in $children; do kill "$child" 2>/dev/null || true; done
children=
cat "$folder/said"

# Part of the wake-ups, by the histogram: a line a µs, with its count.
theirs() {
    awk -v part="$1" '/^[0-9]+ [0-9]+$/ { us[NR] = $1; n[NR] = $2; all += $2 }
        END { for (i = 1; i <= NR; i++) { seen += n[i]; if (seen >= part * all) { print us[i]; exit } } }' \
        "$folder/cyclictest"
}
their_max=$(sed -n 's/^# Max Latencies: 0*\([0-9]\)/\1/p' "$folder/cyclictest")
printf 'cyclictest p50 %d us, p99 %d, p99.9 %d, max %d us\n' \
    "$(theirs 0.5)" "$(theirs 0.99)" "$(theirs 0.999)" "$their_max"
ours=$(sed -n 's/^late by .*p99.9 \([0-9.]*\),.*/\1/p' "$folder/said")
echo "ours       p99.9 $ours ms late, the limit is cyclictest's and 0.2 ms"
"$program" verify "$folder/flight.mcap"
awk -v ours="$ours" -v theirs="$(theirs 0.999)" 'BEGIN { exit !(ours <= theirs / 1000 + 0.2) }' ||
    { echo "later than cyclictest by more than 0.2 ms at p99.9"; exit 1; }

# System calls of the loop's thread: the one that sends, between its hundredth picture and its last.
strace -ff -o "$folder/trace" "$program" fly --pilot hover --no-panel --duration 10 \
    --flightgear 127.0.0.1:45501 --out "$folder/traced.mcap" >/dev/null
loop=$(grep -lE '^sendto|^sendmsg|^send\(|^write.*E<' "$folder"/trace.* | head -1)
[ -n "$loop" ] || { echo "no thread sends pictures"; exit 1; }
awk -F'(' '
    /^send/ { sends++ }
    sends >= 100 && /^[a-z_0-9]+\(/ { calls[$1]++; held[NR] = $1; if ($1 ~ /^send/) { for (c in calls) kept[c] = calls[c]; } }
    /TIMER_ABSTIME/ && sends >= 100 { slept++; ticks = slept }
    END {
        bad = 0
        for (call in kept) {
            printf "system calls %-18s %6d, %.3f a tick\n", call, kept[call], kept[call] / ticks
            if (call !~ /^(send|clock_nanosleep|restart_syscall)/) bad = bad + kept[call]
            # FlightGear'"'"'s own packets, and the second channel.
            if (call ~ /^send/ && kept[call] > 2.02 * ticks) bad = bad + kept[call]
            if (call == "clock_nanosleep" && kept[call] > 1.02 * ticks) bad = bad + kept[call]
        }
        if (bad > 0) { print "the loop asks the system for more than one sleep and one send a channel"; exit 1 }
    }' "$loop"
echo "real time held: late as cyclictest is, one sleep a tick, one send a channel"
