# For tests that talk to a server.

# start_alvord OPTIONS...: runs $alvord, logging to `log` in this folder, until it says where it listens; sets `server` and `address`.
start_alvord() {
  : > log  # not the address of a server before it
  "$alvord" --listen 127.0.0.1:0 "$@" 2> log & server=$!
  until address=$(sed -n 's/.*listening on \(127[0-9.:]*\).*/\1/p' log) && [ -n "$address" ]; do
    kill -0 "$server" || { cat log; exit 1; }
    sleep 0.05
  done
}
