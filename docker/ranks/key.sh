#!/usr/bin/env bash
# key.sh DIRECTORY: makes the key by which hosts of ranks reach each other, id_rsa and id_rsa.pub, to be mounted at /etc/alvor/ssh on all of them.
# Leaves alone what is there.
set -euo pipefail
(umask 077 && mkdir -p "$(dirname "$1")")
mkdir -p "$1"
[ -e "$1/id_rsa" ] || ssh-keygen -q -t ed25519 -N '' -C alvor -f "$1/id_rsa"
# The containers' user, 10001, must read it. Others are kept out by the rights of the directory above, if it is made here.
chmod 644 "$1/id_rsa"
