#!/bin/sh
# The live page of a real-time run in a real browser without a screen (Debian's chromium): nothing fails in it, everything shows
# something, and a picture of it as a user sees it after twelve seconds, written where the first argument says (live_page.png without).
# Installs websocket-client into a virtual environment that is thrown away.
. "$(dirname "$0")/live_run.sh"
picture=${1:-live_page.png}
for browser in chromium chromium-browser google-chrome; do command -v "$browser" > /dev/null && break; done
command -v "$browser" > /dev/null || { echo "there is no chromium: apt-get install chromium" >&2; exit 1; }
python_with websocket-client
start_run --rate 0.6 --loop 40s --live
wait_for "live page: "
url=$(sed -n 's/^live page: //p' "$place/said")
"$python" "$here/photograph.py" "$browser" "$place/profile" "$url" "$picture" 12
wait "$run"
cat "$place/told"
grep -q "^http://127.0.0.1:[0-9]*/: [1-9][0-9]* poses were sent to 1 receivers" "$place/told" || { echo "no pose reached the page" >&2; exit 1; }
echo "$picture shows the page"
