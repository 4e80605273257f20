#!/usr/bin/env bash
# Hardware for real: a small virtual machine with Debian's kernel and the real systemd-udevd, in which
# the kernel makes a stick and button-less pedals (uinput). tiltrotor flies with them, they are moved, the
# pedals unplugged and plugged in again; the log is brought out, verified bit for bit on the host, and
# compared with what a second reader of the same nodes wrote down: every event of the kernel, in order, with
# its time, none missing and none besides.
# The emulated processor cannot hold real time; nothing here depends on it.
# Usage: tests/qemu_stick.sh        (PROFILE=debug for a debug build; KEEP=1 keeps the folder)
set -euo pipefail
cd "$(dirname "$0")/.."
profile=${PROFILE:-release}
target=${CARGO_TARGET_DIR:-target}

need() { command -v "$1" >/dev/null || missing+=("$2"); }
missing=()
need qemu-system-x86_64 qemu-system-x86
need busybox busybox-static
need dpkg-deb dpkg
need gzip gzip
need python3 python3
if [ "${#missing[@]}" != 0 ] || ! command -v apt-get >/dev/null || [ "$(uname -m)" != x86_64 ]; then
    echo "skipped  a stick in a virtual machine: needs Debian on x86-64 with: ${missing[*]}"
    [ "${CI:-}" != true ] || exit 1
    exit 77
fi

build=(cargo build --quiet --no-default-features --features sticks)
[ "$profile" = debug ] || build+=(--release)
"${build[@]}"
"${build[@]}" --package recorder --example virtual_devices
program=$target/$profile/tiltrotor
conductor=$target/$profile/examples/virtual_devices

work=$(mktemp -d)
[ "${KEEP:-}" = 1 ] || trap 'rm -rf "$work"' EXIT
root=$work/root
mkdir -p "$root"/{bin,sbin,dev,proc,sys,run,tmp,etc,out,lib,usr/lib,modules}

# Debian's kernel, its modules for input, and udevd with its rules; nothing of it is installed here.
mkdir "$work/debs" "$work/deb"
fetch() {
    local kernel
    kernel=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: \(linux-image-[^ ]*\)/\1/p' | head -1)
    (cd "$work/debs" && apt-get download --quiet "$kernel" udev libsystemd-shared libkmod2)
}
if [ -n "${DEBS:-}" ]; then
    cp "$DEBS"/*.deb "$work/debs"
elif ! fetch 2>/dev/null; then
    # The package list was never fetched, or is an old one.
    apt-get update --quiet >/dev/null
    fetch
fi
for deb in "$work"/debs/*.deb; do dpkg-deb -x "$deb" "$work/deb"; done
cp "$(command -v busybox)" "$root/bin/busybox"
for module in evdev uinput; do
    find "$work/deb" -name "$module.ko" -exec cp {} "$root/modules" \;
done
mkdir -p "$root/lib/udev"
cp -r "$work"/deb/lib/udev/* "$root/lib/udev" 2>/dev/null || cp -r "$work"/deb/usr/lib/udev/* "$root/lib/udev"
udevadm=$(find "$work/deb" -path '*/bin/udevadm' -type f | head -1)
cp "$udevadm" "$root/bin/udevadm"
ln -s /bin/udevadm "$root/sbin/systemd-udevd"
cp "$program" "$conductor" "$root/bin"
export LD_LIBRARY_PATH="$work/deb/usr/lib/x86_64-linux-gnu:$work/deb/lib/x86_64-linux-gnu:$work/deb/usr/lib/x86_64-linux-gnu/systemd:$work/deb/lib/systemd"
mkdir -p "$root/lib/x86_64-linux-gnu" "$root/lib64"
ldd "$root/bin/udevadm" "$root/bin/tiltrotor" "$root/bin/virtual_devices" |
    sed -n 's/.*=> \(\/[^ ]*\).*/\1/p; s/^\t\(\/[^ ]*\) (.*/\1/p' | sort -u |
    while read -r library; do
        case $library in
        */ld-linux*) cp -L "$library" "$root/lib64/" ;;
        *) cp -L "$library" "$root/lib/x86_64-linux-gnu/" ;;
        esac
    done
unset LD_LIBRARY_PATH
echo 'root:x:0:0:root:/:/bin/sh' >"$root/etc/passwd"
printf 'root:x:0:\ninput:x:104:\n' >"$root/etc/group"

cat >"$root/init" <<'INIT'
#!/bin/busybox sh
/bin/busybox --install -s /bin
export PATH=/bin:/sbin LD_LIBRARY_PATH=/lib/x86_64-linux-gnu HOME=/tmp
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mount -t tmpfs none /run
insmod /modules/evdev.ko
insmod /modules/uinput.ko
/sbin/systemd-udevd --daemon
udevadm trigger --type=subsystems --action=add
udevadm trigger --type=devices --action=add
udevadm settle
echo "udevd: $(udevadm --version), kernel: $(uname -r)"
virtual_devices /out /bin/tiltrotor fly --stick --no-flightgear --force --duration 600
echo "conductor: $?"
tiltrotor log info /out/flight.mcap | grep -E "device|unplug|connected"
stty -F /dev/ttyS1 raw 2>/dev/null
cd /out && tar cf - flight.mcap kernel.txt | gzip >/dev/ttyS1
sync
poweroff -f
INIT
chmod +x "$root/init"
(cd "$root" && find . | busybox cpio -o -H newc 2>/dev/null | gzip -1) >"$work/initramfs"
vmlinuz=$(find "$work/deb/boot" -name 'vmlinuz*' | head -1)

timeout 1500 qemu-system-x86_64 -machine q35 -cpu max -accel tcg -smp 2 -m 1024 -nodefaults -no-reboot \
    -display none -kernel "$vmlinuz" -initrd "$work/initramfs" \
    -append "console=ttyS0 quiet loglevel=3 panic=-1" \
    -chardev file,id=console,path="$work/console.txt" -serial chardev:console \
    -chardev file,id=out,path="$work/out.tgz" -serial chardev:out || true
tr -d '\r' <"$work/console.txt" | grep -v '^\s*$' | tail -60
mkdir "$work/out"
if ! tar xzf "$work/out.tgz" -C "$work/out"; then
    echo "FAILED   nothing came out of the virtual machine"
    exit 1
fi

"$program" verify "$work/out/flight.mcap"
"$program" log cat "$work/out/flight.mcap" --channel hardware >"$work/hardware.jsonl" 2>/dev/null
python3 - "$work/out/kernel.txt" "$work/hardware.jsonl" <<'PYTHON'
import json
import sys

names = {"Virtual T.16000M": 0, "Virtual Pedals": 1}
kinds = {3: 1, 1: 2}  # the kernel's EV_ABS and EV_KEY, the log's axis and button
kernel = {0: [], 1: []}
for line in open(sys.argv[1]):
    name, ns, kind, code, value = line.rstrip("\n").split("\t")
    kernel[names[name]].append((int(ns), kinds[int(kind)], int(code), int(value)))
log, others = {0: [], 1: []}, {}
for line in open(sys.argv[2]):
    event = json.loads(line)
    if event["kind"] in (1, 2):
        log[event["device"]].append(
            tuple(event[key] for key in ("kernel_time_ns", "kind", "code", "value")))
    else:
        key = (event["device"], event["kind"])
        others[key] = others.get(key, 0) + 1
failed = False
for number, said in kernel.items():
    same = said == log[number]
    failed |= not same or not said
    print(f"device {number}: the kernel said {len(said)} events, the log has {len(log[number])}:",
          "the same, in order, with the same times" if same else "NOT the same")
    if not same:
        first = next((i for i, pair in enumerate(zip(said, log[number])) if pair[0] != pair[1]),
                     min(len(said), len(log[number])))
        print("  first difference at", first, said[first:first + 2], log[number][first:first + 2])
# Plugged in twice, unplugged once, and where the axes stood each time.
for key, count in {(0, 3): 1, (1, 3): 2, (1, 4): 1, (0, 6): 6, (1, 6): 6}.items():
    if others.get(key) != count:
        failed = True
        print(f"device {key[0]}: {others.get(key)} events of kind {key[1]}, expected {count}")
sys.exit(failed)
PYTHON
echo "passed   a stick and pedals of the kernel's in a virtual machine: flown, replugged, exact"
