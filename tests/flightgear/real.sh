# The real FlightGear, headless, for scripts of tests: sourced by them, from the tree's root.
#
# Installs what is missing where it can (Debian, root); says `skipped:` with the reason and leaves with 77
# where it cannot. FlightGear's home with its navigation cache stays in target/ between runs.

skip() { echo "skipped: $*"; exit 77; }

fgfs=$(command -v fgfs || echo /usr/games/fgfs)
need=()
[ -x "$fgfs" ] || need+=(flightgear)
command -v Xvfb >/dev/null || need+=(xvfb)
command -v curl >/dev/null || need+=(curl)
# A program of that name may be a stand-in that does less.
convert --version 2>/dev/null | grep --quiet ImageMagick || need+=(imagemagick)
if [ ${#need[@]} -gt 0 ]; then
    command -v apt-get >/dev/null && [ "$(id -u)" = 0 ] || skip "not installed: ${need[*]}"
    { apt-get update && apt-get install -y --no-install-recommends "${need[@]}" libgl1-mesa-dri; } >/dev/null 2>&1 ||
        skip "cannot install ${need[*]}"
fi
command -v python3 >/dev/null || skip "python3 is not installed"

# Mesa of before 23 draws a frame in a minute and dies of shaders: a newer one beside the system's.
newer_mesa() {
    local system folder=$PWD/target/mesa libraries
    system=$(dpkg-query -W -f '${Version}' libgl1-mesa-dri 2>/dev/null || echo 99)
    [ "${system%%.*}" -lt 23 ] || return 0
    libraries=$folder/tree/usr/lib/x86_64-linux-gnu
    if ! ls "$libraries"/libgallium-*.so >/dev/null 2>&1; then
        mkdir -p "$folder"/{lists,cache/archives/partial}
        printf 'deb http://deb.debian.org/debian %s main\n' bookworm bookworm-backports >"$folder/sources.list"
        local apt=(-o "Dir::Etc::sourcelist=$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null
            -o "Dir::State::lists=$folder/lists" -o "Dir::Cache=$folder/cache")
        (
            cd "$folder"
            apt-get "${apt[@]}" update
            for package in mesa-libgallium libgl1-mesa-dri libglx-mesa0 libegl-mesa0 libgbm1 libdrm2 libllvm19 \
                libdrm-amdgpu1 libdrm-intel1 libdrm-nouveau2 libdrm-radeon1; do
                apt-get "${apt[@]}" download -t bookworm-backports "$package"
            done
            for package in *.deb; do dpkg -x "$package" tree; done
        ) >"$folder/log" 2>&1 || { echo "note: no newer Mesa, see $folder/log"; return 0; }
    fi
    mesa=(LD_LIBRARY_PATH="$libraries" LIBGL_DRIVERS_PATH="$libraries/dri")
}
mesa=()
newer_mesa

fg_home=$PWD/target/flightgear-home
work=$(mktemp -d)
mkdir -p "$fg_home" "$work/empty/Terrain"
mkdir -m 700 "$work/xdg"
processes=()
finish() {
    local status=$?
    # FlightGear hangs when asked to quit; it ends at once when told to.
    for process in "${processes[@]}"; do kill "$process" 2>/dev/null || true; done
    wait 2>/dev/null || true
    if [ "$status" != 0 ] && [ "$status" != 77 ]; then tail -20 "$work"/fgfs*.log 2>/dev/null || true; fi
    rm -rf "$work"
    exit "$status"
}
trap finish EXIT

free_port() { # SOCK_DGRAM or SOCK_STREAM; with the port after it
    python3 - "$1" <<'P'
import socket, sys
kind = getattr(socket, sys.argv[1])
while True:
    with socket.socket(socket.AF_INET, kind) as one, socket.socket(socket.AF_INET, kind) as other:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
        try:
            other.bind(("127.0.0.1", port + 1))
        except OSError:
            continue
        print(port)
        break
P
}

start_screen() { # WIDTHxHEIGHT [XVFB OPTIONS]
    exec 3>"$work/display"
    Xvfb -displayfd 3 -screen 0 "$1x24" -nolisten tcp +extension GLX -noreset "${@:2}" 2>/dev/null &
    processes+=($!)
    for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
    DISPLAY=":$(cat "$work/display")"
    export DISPLAY
}

# Starts FlightGear with our aircraft; sets fdm, http, flightgear (its process).
start_flightgear() { # WIDTHxHEIGHT [OPTIONS]
    fdm=$(free_port SOCK_DGRAM)
    http=$(free_port SOCK_STREAM)
    env "${mesa[@]}" LIBGL_ALWAYS_SOFTWARE=1 DBUS_FATAL_WARNINGS=0 ALSOFT_DRIVERS=null \
        FG_HOME="$fg_home" XDG_RUNTIME_DIR="$work/xdg" \
        "$fgfs" --fg-aircraft="$PWD/flightgear/Aircraft" --aircraft=xv15 --data="$PWD/flightgear/data" \
        --airport=PHTO --fdm=null --native-fdm="socket,in,60,127.0.0.1,$fdm,udp" \
        --generic="socket,in,60,127.0.0.1,$((fdm + 1)),udp,tiltrotor" \
        --generic="socket,in,60,127.0.0.1,$((fdm + 3)),udp,tiltrotor-ghost" --httpd="127.0.0.1:$http" \
        --geometry="$1" --wind=0@0 --disable-terrasync --disable-splash-screen \
        --disable-real-weather-fetch --disable-ai-traffic --disable-ai-models --disable-random-objects \
        --disable-random-vegetation --disable-random-buildings --disable-clouds --disable-clouds3d \
        --disable-save-on-exit --disable-fgcom --disable-hud --start-date-gmt=2020:06:21:21:00:00 \
        --prop:int:/sim/rendering/shaders/quality-level=0 "${@:2}" >"$work/fgfs$http.log" 2>&1 &
    flightgear=$!
    processes+=("$flightgear")
}

property() { # PATH
    curl --silent --max-time 60 "http://127.0.0.1:$http/json$1" |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["value"])' 2>/dev/null || true
}

set_property() { # PATH VALUE
    curl --silent --max-time 60 "http://127.0.0.1:$http/props$(dirname "$1")?submit=set&$(basename "$1")=$2" >/dev/null || true
}

# Ready: the scenery is loaded, and time has been seen to advance five times.
wait_until_ready() {
    local deadline=$((SECONDS + ${1:-240})) last='' now moves=0
    while [ "$moves" -lt 5 ]; do
        [ "$SECONDS" -lt "$deadline" ] || { echo "FlightGear is not ready after ${1:-240} s"; exit 1; }
        kill -0 "$flightgear" 2>/dev/null || { echo "FlightGear died"; exit 1; }
        now=$(property /sim/time/elapsed-sec)
        if [ -n "$now" ] && [ "$now" != "$last" ] && [ "$now" != 0 ] &&
            [ "$(property /sim/sceneryloaded | tr '[:upper:]' '[:lower:]')" = true ]; then
            moves=$((moves + 1))
        fi
        last=$now
        sleep 0.3
    done
    no_complaints
}

# FlightGear tells of faults in the aircraft's scripts, model and sounds in its log only.
no_complaints() {
    local complaints='Nasal (runtime|parse) error|[Ff]ailed to load|Error reading|could not find.*Aircraft/XV-15'
    if grep -E -A4 "$complaints" "$work/fgfs$http.log"; then
        echo "FlightGear complains of the aircraft"
        exit 1
    fi
}

# A small and cheap FlightGear that our command starts: its arguments in `options`, its homes in the environment.
small_flightgear() {
    export XDG_CACHE_HOME=$work/cache FG_HOME=$fg_home XDG_RUNTIME_DIR=$work/xdg
    export LIBGL_ALWAYS_SOFTWARE=1 ALSOFT_DRIVERS=null
    options=(--geometry=320x240 --disable-sound --disable-splash-screen --disable-random-objects
        --disable-random-vegetation --disable-random-buildings --disable-clouds --disable-clouds3d
        --disable-ai-models --prop:int:/sim/rendering/shaders/quality-level=0)
}

stop() { # PROCESS
    kill "$1" 2>/dev/null || true
    wait "$1" 2>/dev/null || true
}

# The command under test: given, or built.
the_tiltrotor() { # [TILTROTOR]
    tiltrotor=${1:-}
    if [ -z "$tiltrotor" ]; then
        cargo build --release --no-default-features --target-dir target/headless
        tiltrotor=target/headless/release/tiltrotor
    fi
}
