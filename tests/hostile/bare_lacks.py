"""What alvord without nginx cannot promise."""

# By attack: why. docs/security.md repeats this table. All of it is in Debian's gRPC 1.51, which reads frames without these limits.
BARE_LACKS = {
    "rapid_reset": "each reset stream costs gRPC a call that it must wind up; mostly it keeps up, but not always (of 25 floods one took 73 MB, "
                   "and in one health waited for 5 s)",
    "rapid_reset_with_a_token": "each reset stream costs gRPC a call that it must wind up; it winds them up more slowly than they come",
    "endless_header_value": "gRPC keeps a header block until it is whole, however long it is",
    "endless_small_headers": "gRPC keeps a header block until it is whole, however long it is",
    "pings_without_reading": "gRPC queues an answer to each ping until the socket takes it",
    "empty_data": "gRPC reads frames as fast as they come, and keeps what it has not looked at",
    "window_updates": "gRPC reads frames as fast as they come, and keeps what it has not looked at",
}
