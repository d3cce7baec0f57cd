# Sourced by scripts that need a daemon of their own.
# shellcheck shell=bash

say() { printf '\n== %s\n' "$*" >&2; }

# start_daemon BIN_FOLDER FOLDER: with its data and its log below FOLDER; sets DRTV_SERVER. It ends with the script.
start_daemon() {
  local bin=$1 folder=$2 address=
  rm -f "$folder/bakerd.log"  # an old one names an old address
  # Port 0: the daemon takes a free one and says which.
  "$bin/bakerd" serve --data "$folder/data" --listen 127.0.0.1:0 2>"$folder/bakerd.log" &
  daemon=$!
  trap 'kill "$daemon" 2>/dev/null; wait "$daemon" 2>/dev/null || true' EXIT
  for _ in $(seq 100); do
    address=$(sed -n 's/.*bakerd listens on \([^,]*\),.*/\1/p' "$folder/bakerd.log" | tail -n 1)
    [[ -n $address ]] && break
    kill -0 "$daemon" 2>/dev/null || { cat "$folder/bakerd.log" >&2; exit 1; }
    sleep 0.1
  done
  [[ -n $address ]] || { echo "bakerd did not start within 10 s, see $folder/bakerd.log" >&2; exit 1; }
  export DRTV_SERVER=$address
}
