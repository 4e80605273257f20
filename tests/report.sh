#!/usr/bin/env bash
# The report of a flight in a real browser without a screen: no message of an error, nothing wider than its page at
# desktop and phone width, pictures and a print of it. Ends with 77 where no browser is.
# Usage: tests/report.sh [TILTROTOR]   (BROWSER names another one than chromium; pictures go to target/report)
set -euo pipefail
cd "$(dirname "$0")/.."

browser=${BROWSER:-}
for name in chromium chromium-browser google-chrome; do
    [ -n "$browser" ] || browser=$(command -v "$name" || true)
done
if [ -z "$browser" ]; then
    echo "$0: no browser: apt-get install chromium, or name one in BROWSER" >&2
    exit 77
fi
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

out=target/report
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tiltrotor" report tests/golden/landing.mcap --force --out "$work/report.html"
"$tiltrotor" report tests/golden/landing.mcap --force --compact --out "$work/compact.html"

# No network, a profile of its own, what goes wrong on standard error.
see() {
    timeout 120 "$browser" --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$work/profile" \
        --allow-file-access-from-files --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr --v=0 \
        "$@" 2>"$work/said"
    if grep -E 'CONSOLE|ERR_' "$work/said"; then
        echo "$0: the browser has something to say" >&2
        exit 1
    fi
}

failed=0
for page in report compact; do
    see --window-size=1200,2400 --screenshot="$out/$page-desktop.png" "file://$work/$page.html" >/dev/null
    see --no-pdf-header-footer --print-to-pdf="$out/$page.pdf" "file://$work/$page.html" >/dev/null
    # A window has a least width; a frame in it has not.
    for width in 1200 390; do
        cat >"$work/frame.html" <<HTML
<!DOCTYPE html><body style="margin:0"><iframe id="page" src="$page.html" style="border:0;width:${width}px;height:2400px"></iframe>
<script>
const page = document.getElementById("page");
page.onload = () => {
  const inside = page.contentDocument.documentElement;
  document.body.dataset.seen = inside.scrollWidth + " " + page.contentDocument.querySelectorAll("figure svg").length;
};
</script></body>
HTML
        seen=$(see --virtual-time-budget=5000 --window-size=1200,2400 --dump-dom "file://$work/frame.html" |
            sed -n 's/.*data-seen="\([0-9 ]*\)".*/\1/p')
        read -r wide figures <<<"$seen"
        echo "$page at $width px: $wide px wide, $figures figures"
        if [ "${wide:-9999}" -gt "$width" ] || [ "${figures:-0}" -lt 3 ]; then
            echo "$0: $page.html is wider than its page, or has no figures" >&2
            failed=1
        fi
        see --window-size="1200,2400" --screenshot="$out/$page-$width.png" "file://$work/frame.html" >/dev/null
    done
done
echo "pictures and prints are in $out"
exit $failed
