#!/usr/bin/env bash
# Would the tests notice? A sample of small changes to the code, each built and tested: at least 92 % have to be
# noticed, and not by what blessing rewrites (golden flights, snapshots, recorded bits).
#
#   tests/mutants.sh [COUNT [SEED]]    200 and 1 without; some minutes a change
#
# The changes are those of cargo-mutants (`cargo install cargo-mutants --locked`): an operator for another, a constant
# for a function, a deleted field or arm. They are drawn from the crates that fly, record, verify and send. Pictures
# (the viewer's, figures, FlightGear's models) are left to the eye. Each change meets the tests of its own crate
# first, and those of the flight model all that fly it; what survives meets every test of the workspace.
# What survived is in target/mutants/survivors.txt; docs/mutants.md says why each of the last time did.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-200} seed=${2:-1} noticed_min_percent=92
if ! cargo mutants --version >/dev/null 2>&1; then
    echo "skipped: needs cargo-mutants (cargo install cargo-mutants --locked)"
    exit 77
fi
export CARGO_PROFILE_DEV_DEBUG=0 INSTA_UPDATE=no CARGO_TERM_COLOR=never
work=target/mutants
rm -rf "$work"
mkdir -p "$work"

cargo mutants --no-config --workspace --list --json >"$work/all.json"
python3 - "$work" "$count" "$seed" <<'PYTHON'
import json, random, re, sys

work, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
CRATES = {"aircraft", "analysis", "engine", "flightgear", "logs", "recorder", "replay", "tiltrotor"}
#: The flight model's tests lie where there is an aircraft to fly.
FLIGHT_MODEL = {"aircraft", "analysis", "engine"}
with open(f"{work}/all.json") as file:
    every = [mutant for mutant in json.load(file)
             if mutant["package"] in CRATES and not mutant["file"].startswith("replay/src/view/")]
drawn = random.Random(seed).sample(every, min(count, len(every)))
groups: dict[str, list[str]] = {}
for mutant in drawn:
    package = mutant["package"]
    tested = ",".join(sorted(FLIGHT_MODEL)) if package in FLIGHT_MODEL else package
    groups.setdefault(tested, []).append(mutant["name"])
for number, (tested, names) in enumerate(sorted(groups.items())):
    with open(f"{work}/group-{number}", "w") as file:
        print(tested, *(f"^{re.escape(name)}$" for name in names), sep="\n", file=file)
print(f"{len(drawn)} of {len(every)} changes, seed {seed}")
PYTHON

# What blessing rewrites, by the names of its tests.
unblessed=(--skip regress_ --skip listings:: --skip the_protocol_file_is_the_table
    --skip the_written_validation)
# meet TESTED NAMES OUT: each change named in the file meets the tests of the packages, or of all.
meet() {
    local chosen=() tested=() status=0
    while read -r pattern; do chosen+=(--re "$pattern"); done <"$2"
    if [ "$1" = all ]; then tested=(--test-workspace=true); else tested=(--test-package "$1"); fi
    cargo mutants --no-config --workspace --no-default-features --no-shuffle --baseline=run \
        --minimum-test-timeout 300 --output "$3" "${chosen[@]}" "${tested[@]}" \
        -- --lib --bins --tests -- "${unblessed[@]}" || status=$?
    # 2: some were missed, 3: some took too long, which is noticed.
    [ "$status" = 0 ] || [ "$status" = 2 ] || [ "$status" = 3 ] || exit "$status"
    cat "$3/mutants.out/missed.txt" >>"$work/missed"
    cat "$3/mutants.out/"{caught,timeout}.txt >>"$work/noticed"
}
: >"$work/missed" >"$work/noticed"
for group in "$work"/group-*; do
    tail -n +2 "$group" >"$work/names"
    meet "$(head -1 "$group")" "$work/names" "$work/out-$(basename "$group")"
done
if [ -s "$work/missed" ]; then
    python3 -c 'import re, sys
for line in sys.stdin: print("^" + re.escape(line.rstrip("\n")) + "$")' <"$work/missed" >"$work/names"
    : >"$work/missed"
    meet all "$work/names" "$work/out-all"
fi
sort "$work/missed" >"$work/survivors.txt"
noticed=$(wc -l <"$work/noticed") missed=$(wc -l <"$work/survivors.txt")
cat "$work/survivors.txt"
percent=$((100 * noticed / (noticed + missed)))
echo "$noticed of $((noticed + missed)) changes that compile noticed, $percent %, at least $noticed_min_percent %"
[ "$percent" -ge "$noticed_min_percent" ]
