"""What alvord without nginx cannot promise."""

# By attack: why. docs/security.md repeats this table.
BARE_LACKS = {
}
