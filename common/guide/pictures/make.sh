#!/bin/sh
# Makes the pictures of the guide: runs the demonstration with `launch`, looks at it with `monitor` in tmux and captures the page, and then makes the
# `report` of the recorded run and photographs it.
# Usage: make.sh PROGRAM, from the top of the repository; needs tmux and chromium-headless-shell. Takes about three minutes.
set -eu
program=$(realpath "${1:?usage: make.sh PROGRAM}")
folder=$(realpath "$(dirname "$0")")
run=$(mktemp -d /tmp/dfpXXXXXX)
export XDG_RUNTIME_DIR="$run"
trap 'tmux -L deckflex_pictures kill-server 2>/dev/null || true; rm -rf "$run"' EXIT

# long enough for the captures and for curves in the report; the launch ends by itself
"$program" launch config/demo.toml --duration 150s --record "$run/recording" >"$run/launch.txt" 2>&1 &
launch=$!
for size in 80x24 120x40; do
    tmux -L deckflex_pictures -f /dev/null new-session -d -s "$size" -x "${size%x*}" -y "${size#*x}" \
        "'$program' monitor config/demo.toml --events '$run/events.csv'"
done
sleep 60
for size in 80x24 120x40; do
    tmux -L deckflex_pictures capture-pane -p -t "$size" >"$folder/monitor_$size.txt"
    tmux -L deckflex_pictures send-keys -t "$size" q
done
wait "$launch"

"$program" report "$run"/recording/*.mcap --out "$run/report.html"
# a browser that is root has no sandbox, and it says much that means nothing
chromium-headless-shell --no-sandbox --disable-gpu --hide-scrollbars --window-size=1100,1500 \
    --screenshot="$folder/report.png" "file://$run/report.html" >"$run/browser.txt" 2>&1 || { cat "$run/browser.txt"; exit 1; }
