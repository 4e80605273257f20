#!/usr/bin/env bash
# Every verb that writes a file, with a fault at its first, second, middle, last but one and last write,
# at sync and at rename, and killed there: the old file or the whole new one is there, never half.
# Usage: tests/faults.sh [PROGRAM]   (without one it is built)
set -euo pipefail
cd "$(dirname "$0")/.."
if ! command -v strace >/dev/null; then
    as_root=()
    [ "$(id -u)" = 0 ] || as_root=(sudo)
    "${as_root[@]}" apt-get update --quiet
    "${as_root[@]}" apt-get install --yes --no-install-recommends strace
fi
program=${1:-}
if [ -z "$program" ]; then
    cargo build --quiet --release --workspace --no-default-features --target-dir target/headless
    program=target/headless/release/tiltrotor
fi
program=$(realpath "$program")
root=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export LC_ALL=C
writes=write,writev,pwrite64
renames=rename,renameat,renameat2,link,linkat
runs=0

fly=(fly --from-trim --pilot hover --fast --duration 1 --no-flightgear)
"$program" "${fly[@]}" --out log.mcap >/dev/null
"$program" log compact log.mcap --out small.mcap >/dev/null
head -c $(($(stat -c %s log.mcap) * 2 / 3)) log.mcap >cut.mcap
"$program" fly --from-trim --pilot hover --fast --duration 0.3 --no-flightgear --out older.mcap >/dev/null
sed 's/^area_ft2 = { value = 181\.0/area_ft2 = { value = 190.0/' "$root/aircraft/xv15.toml" >larger.toml

fail() {
    echo "tests/faults.sh: $*" >&2
    cat said >&2
    exit 1
}

# Numbers of the writes to files, first, second, middle, last but one and last, as strace counts them:
# a thread at a time.
places() { # trace
    awk '
        /(write|writev|pwrite64)\(/ {
            thread = $1
            number[thread]++
            if ($0 ~ /\.unfinished|'"$out_pattern"'/) of[++n] = number[thread]
        }
        END {
            if (n == 0) exit 1
            want[1]; want[2]; want[int((n + 1) / 2)]; want[n - 1]; want[n]
            for (place in want) if (place >= 1 && place <= n) print of[place]
        }' "$1" | sort -nu
}

# The verb with one fault. What is at "$out" afterwards is the old file or the new one, and the status
# says which.
one() { # what inject...
    local what=$1 status=0
    shift
    restore
    strace --quiet=all -f -o /dev/null -e "trace=$writes,$renames,fsync,fdatasync" "$@" "$program" "${verb[@]}" >said 2>&1 || status=$?
    runs=$((runs + 1))
    "$judge" "$what" "$status"
}

# For a verb that writes "$out" whole: old.bytes or new.bytes.
whole() { # what status
    local killed=
    case $1 in *kill*) killed=yes ;; esac
    if cmp -s "$out" new.bytes; then
        # In place, and then nobody could be told of it.
        [ "$2" = "$done" ] || [ -n "$killed" ] || [ "$1" = "no more space" ] ||
            grep -q 'standard output' said ||
            fail "$name, $1: the new file, status $2"
    elif cmp -s "$out" old.bytes; then
        [ "$2" != "$done" ] || fail "$name, $1: the old file, status $done"
    else
        fail "$name, $1: half a file, status $2"
    fi
    # What a killed one left, the next one has removed.
    [ -n "$killed" ] || [ -z "$(find . -name '*.unfinished')" ] || fail "$name, $1: something hidden is left"
}

# For a flight: the older log under its name or set aside, or the new one whole.
flown() { # what status
    local exact=0
    "$program" verify "$out" >verified 2>&1 || exact=$?
    if cmp -s "$out" old.bytes; then
        [ "$2" != 0 ] || fail "$name, $1: the older log, status 0"
    elif [ $exact = 3 ] || [ "$2" != 0 ]; then
        [ $exact = 3 ] || [ $exact = 0 ] || fail "$name, $1: $(cat verified)"
        [ $exact = 0 ] && [ ! -e "$out.old" ] || cmp -s "$out.old" old.bytes ||
            fail "$name, $1: the older log is lost, status $2"
    else
        [ $exact = 0 ] || fail "$name, $1: $(cat verified)"
    fi
    rm -f "$out".old*
    case $1 in *kill*) ;; *) [ -z "$(find . -name '*.unfinished')" ] || fail "$name, $1: something hidden is left" ;; esac
}

# Restores what was there, runs every fault.
faults() { # name judge out old verb...
    name=$1 judge=$2 out=$3 old=$4
    shift 4
    verb=("$@")
    out_pattern=$(basename "$out" | sed 's/\./\\./g')
    cp "$old" old.bytes
    restore
    # What is recovered is never a whole flight: that is no failure.
    done=0
    strace --quiet=all -f -y -o trace -e trace=$writes "$program" "${verb[@]}" >said 2>&1 || done=$?
    [ "$done" = 0 ] || [ "$done $name" = "3 log recover" ] || fail "$name"
    cp "$out" new.bytes
    ! cmp -s old.bytes new.bytes || fail "$name: nothing to be told apart"
    local number
    for number in $(places trace); do
        one "write $number: no space" -e "inject=$writes:error=ENOSPC:when=$number"
        one "write $number: kill" -e "inject=$writes:signal=KILL:when=$number"
    done
    one "sync: error" -e inject=fsync,fdatasync:error=EIO
    one "sync: kill" -e inject=fsync,fdatasync:signal=KILL
    one "rename: error" -e inject=$renames:error=EIO
    one "rename: kill" -e inject=$renames:signal=KILL
    one "no more space" -e "inject=$writes:error=ENOSPC:when=2+"
    echo "$name: $(places trace | wc -l) writes"
}

restore() {
    mkdir -p "$(dirname "$out")"
    cp old.bytes "$out"
    rm -f "$out".old*
}

printf 'precious' >precious
faults "fly" flown out.mcap older.mcap "${fly[@]}" --force --out out.mcap
faults "log compact" whole out.mcap precious log compact log.mcap --force --out out.mcap
faults "log expand" whole out.mcap precious log expand small.mcap --force --out out.mcap
part=$("$program" log --help | grep -qw clip && echo clip || echo trim)
faults "log $part" whole out.mcap precious log "$part" log.mcap --from 50t --until 150t \
    --force --out out.mcap
faults "log recover" whole out.mcap precious log recover cut.mcap --force --out out.mcap
faults "whatif" whole out.mcap precious whatif log.mcap --set fcc.travel.pedal_in=2 --force \
    --out out.mcap
faults "trim --csv" whole out.csv precious trim --speed-kt 0 --nacelle 90 --csv out.csv
faults "linearize --csv" whole out.csv precious linearize --speed-kt 0 --nacelle 90 --csv out.csv
flight=$("$program" log export log.mcap --csv tables | sed -n '1s/^log.mcap: \([^,]*\),.*/\1/p')
faults "log export --csv" whole "tables/state/flight=$flight/data.csv" precious \
    log export log.mcap --force --csv tables
if "$program" view log.mcap --save seen.rrd >/dev/null 2>&1; then
    faults "view --save" whole out.rrd precious view log.mcap --force --save out.rrd
fi

for kept in log small; do
    faults "verify --bless ($kept)" whole golden.mcap $kept.mcap verify golden.mcap --bless \
        --aircraft larger.toml
done

mkdir -p tests/golden
printf '# Golden flights\n' >tests/golden/README.md
faults "log $part --as-golden" whole tests/golden/part.mcap precious log "$part" log.mcap \
    --from 50t --until 150t --force --as-golden part --reason "it is kept for the faults"
echo "$runs faults: the old file or the whole new one, every time"
