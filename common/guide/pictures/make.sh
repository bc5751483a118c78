#!/bin/sh
# Makes the pictures of the monitor: runs the demonstration with `launch`, looks at it with `monitor` in tmux, and captures the page.
# Usage: make.sh PROGRAM, from the top of the repository; needs tmux. Takes about a minute.
set -eu
program=$(realpath "${1:?usage: make.sh PROGRAM}")
folder=$(realpath "$(dirname "$0")")
run=$(mktemp -d /tmp/dfpXXXXXX)
export XDG_RUNTIME_DIR="$run"
trap 'tmux -L deckflex_pictures kill-server 2>/dev/null || true; rm -rf "$run"' EXIT

# long enough for both captures; the launch ends by itself
"$program" launch config/demo.toml --duration 75s >"$run/launch.txt" 2>&1 &
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
