#!/usr/bin/env bash
# make.sh BINARIES DIRECTORY: what the alvord of BINARIES leaves in DIRECTORY when it is killed: two scenes, and solves that have ended, are paused, run
# and wait. The write-ahead log that older servers leave is moved into the database, to keep it small.
set -euo pipefail
bin=$1 data=$2 at=127.0.0.1:50777
cd "$(dirname "$0")"
rm -rf "$data"
"$bin/alvord" --listen $at --data "$data" --checkpoint-interval 0.05 --max-solves 1 2> "$data.log" &
server=$!
until grep -q 'listening on' "$data.log"; do sleep 0.05; done
solve() { "$bin/alvor" solve "$@" --server $at --threads 1 --tolerance 0.001 --patience 0 > /dev/null 2>&1 || true; }
solve room.obj --max-elements 60
solve room.obj --max-elements 20 --pace 0.3 --seed 2 &
sleep 0.45
"$bin/alvor" solves pause --server $at "$("$bin/alvor" solves list --server $at | awk '/RUNNING/ { print $1 }')"
until "$bin/alvor" solves list --server $at | grep -q PAUSED; do sleep 0.1; done
solve triangles.obj --max-elements 30 --pace 0.4 --seed 3 &
sleep 0.4
solve room.obj --max-elements 20 --seed 4 &
until "$bin/alvor" solves list --server $at | grep -q QUEUED; do sleep 0.05; done
"$bin/alvor" solves list --server $at
kill -9 $server
sqlite3 "$data/alvor.db" "PRAGMA wal_checkpoint(TRUNCATE)" > /dev/null
rm -f "$data/ballast"
sleep 1
ls -l "$data"
