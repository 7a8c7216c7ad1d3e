#!/usr/bin/env bash
# Builds Hairline and runs it with the arguments given; without any, the editor on the demo scene.
#
#   scripts/run.sh                            the editor
#   scripts/run.sh part.igs                   the editor on a file
#   scripts/run.sh render demo -o demo.png    a sub-command; needs no display
#   scripts/run.sh --release [...]            optimised throughout; takes longer to build
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$here/scripts/prepare.sh"

profile=()
if [ "${1:-}" = --release ]; then
    profile=(--release)
    shift
fi

features=(--features editor)
case "${1:-}" in
render | info | classify | check | mend | convert | tessellate | edit | bench | help | -h | --help | -V | --version)
    # No window: leave the editor out, which builds in a tenth of the time.
    features=(--no-default-features --features gpu)
    ;;
*)
    if [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        stop "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set), so the editor cannot open a window.
          Run this from a desktop session, or draw a picture instead:
          scripts/run.sh render demo -o demo.png"
    fi
    ;;
esac

prepare_build
prepare_graphics
say "building (the first time takes minutes)"
cargo build --manifest-path "$here/Cargo.toml" "${profile[@]}" "${features[@]}" >&2
exec cargo run --quiet --manifest-path "$here/Cargo.toml" "${profile[@]}" "${features[@]}" -- "$@"
