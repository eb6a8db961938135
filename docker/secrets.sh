#!/usr/bin/env bash
# secrets.sh DIRECTORY HOST TENANT...: makes what a server for others wants: a certificate for HOST (and `front`, `server`, `localhost`, 127.0.0.1)
# that signs itself, tls.crt and tls.key; and tokens, with TENANT.token for each tenant. Leaves alone what is there.
set -euo pipefail
directory=$1 host=$2
shift 2
mkdir -p "$directory"
cd "$directory"

if [ ! -e tls.crt ]; then
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 365 -subj "/CN=$host" \
    -addext "subjectAltName=DNS:$host,DNS:front,DNS:server,DNS:localhost,IP:127.0.0.1" -keyout tls.key -out tls.crt 2> /dev/null
fi
for tenant; do
  [ -e "$tenant.token" ] && continue
  openssl rand -hex 32 > "$tenant.token"
  echo "$tenant $(tr -d '\n' < "$tenant.token" | sha256sum | cut -d' ' -f1)" >> tokens
done
# The containers' users, 10001 and 10002, must read them: keep others out by the rights of the directory above.
chmod 644 -- tls.crt tls.key tokens ./*.token
