#!/bin/sh
# Makes the list of topics that a viewer sees: runs the demonstration with `launch`, shows it with `live`, and connects as a viewer does.
# Usage: topics.sh PROGRAM, from the top of the repository; PROGRAM is built with `--features foxglove`. Needs Python with venv, and PyPI.
# Takes about a minute.
set -eu
program=$(realpath "${1:?usage: topics.sh PROGRAM}")
folder=$(realpath "$(dirname "$0")")
run=$(mktemp -d /tmp/dfpXXXXXX)
export XDG_RUNTIME_DIR="$run"
live=
trap 'test -z "$live" || kill "$live"; rm -rf "$run"' EXIT

python3 -m venv "$run/venv"
"$run/venv/bin/pip" --quiet install websockets protobuf
"$program" live --listen 127.0.0.1:0 >"$run/live.txt" 2>&1 &
live=$!
# long enough for a valid solution; the launch ends by itself
"$program" launch config/demo.toml --duration 45s >"$run/launch.txt" 2>&1 &
launch=$!
sleep 40
address=$(sed -n 's|.*listening on \(ws://.*\)|\1|p' "$run/live.txt")
"$run/venv/bin/python" "$folder/topics.py" "$address" >"$run/topics.txt"
mv "$run/topics.txt" "$folder/topics.txt"
wait "$launch"
