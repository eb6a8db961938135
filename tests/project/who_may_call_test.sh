#!/usr/bin/env bash
# who_may_call_test.sh BINARIES: with TLS, client certificates and tokens, the server lets in those it should, and nobody else.
set -euo pipefail
. "$(dirname "$0")/start_alvord.sh"
alvor=$1/alvor alvord=$1/alvord
work=$(mktemp -d)
server=
trap 'kill $server 2> /dev/null; rm -rf "$work"' EXIT
cd "$work"

# certificate NAME: its own authority.
certificate() {
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj "/CN=$1" \
    -addext "subjectAltName=DNS:localhost,IP:127.0.0.1" -keyout "$1.key" -out "$1.pem" 2> /dev/null
}
for name in server client stranger; do certificate $name; done
echo "open sesame" > token
echo "close sesame" > wrong_token
echo "ali $(printf %s "open sesame" | sha256sum | cut -d' ' -f1)" > tokens

serve() {
  [ -z "$server" ] || { kill "$server"; wait "$server" || true; }
  start_alvord --tls-cert server.pem --tls-key server.key "$@"
}
# expect STATUS WORDS OPTIONS...: `alvor scenes list` ends so, and says that.
expect() {
  local status=0 said
  said=$("$alvor" scenes list --server "$address" "${@:3}" 2>&1) || status=$?
  [ "$status" = "$1" ] && [[ $said == *"$2"* ]] && return
  echo "expected status $1 and '$2', got $status and '$said' for: ${*:3}"
  exit 1
}

# status_of OPTIONS...: the status of gRPC that a browser is told.
status_of() {
  local url
  url=$(sed -n 's/.*web page on //p' log)
  printf '\0\0\0\0\0' | curl -s --cacert server.pem -H 'Content-Type: application/grpc-web+proto' --data-binary @- "$@" \
    "${url}alvor.v1.SceneService/ListScenes" | tr -d '\0\r' | LC_ALL=C sed -n 's/.*grpc-status: \([0-9]*\).*/\1/p'
}
# expect_web STATUS OPTIONS...
expect_web() {
  local status
  status=$(status_of "${@:2}" || true)
  [ "$status" = "$1" ] && return
  echo "expected '$1', got '$status' in a browser with: ${*:2}"
  exit 1
}

mkdir page && echo > page/index.html
web=(--web 127.0.0.1:0 --page page)
serve --tokens tokens "${web[@]}"
expect_web 0 -H "Authorization: Bearer open sesame"
expect_web 16 -H "Authorization: Bearer close sesame"
expect_web 16
expect 0 "" --tls-ca server.pem --token-file token
expect 5 "is missing" --tls-ca server.pem
expect 5 "not a token" --tls-ca server.pem --token-file wrong_token
expect 4 "cannot be reached" --tls-ca stranger.pem --token-file token
expect 4 "cannot be reached"

serve --tls-client-ca client.pem "${web[@]}"
expect_web 0 --cert client.pem --key client.key
expect_web "" --cert stranger.pem --key stranger.key
expect_web ""
expect 0 "" --tls-ca server.pem --tls-cert client.pem --tls-key client.key
expect 4 "cannot be reached" --tls-ca server.pem --tls-cert stranger.pem --tls-key stranger.key
expect 4 "cannot be reached" --tls-ca server.pem
echo "those were let in who should be"
