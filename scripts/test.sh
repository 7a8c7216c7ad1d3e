#!/usr/bin/env bash
# Checks everything that a change must pass: format, lints, documentation, tests, each with and
# without the editor, the quick part first. Stops at the first failure and says which step it was.
#
#   scripts/test.sh            everything
#   scripts/test.sh --quick    without the editor and the graphics driver: seconds once built
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$here/scripts/prepare.sh"
cd "$here"

quick=no
case "${1:-}" in
'') ;;
--quick) quick=yes ;;
*) stop "usage: scripts/test.sh [--quick]" ;;
esac

step() {
    local title=$1 start=$SECONDS
    shift
    say "$title: $*"
    "$@" || {
        printf '\nhairline: FAILED: %s (%s)\n' "$title" "$*" >&2
        exit 1
    }
    note "$title: done in $((SECONDS - start)) s"
}

prepare_build
core=(--no-default-features)
full=(--all-features)

step "format" cargo fmt --all --check
step "lints of the core" cargo clippy "${core[@]}" --all-targets -- -D warnings
step "tests of the core" cargo test "${core[@]}"
RUSTDOCFLAGS="-D warnings" step "documentation of the core" cargo doc "${core[@]}" --no-deps
[ "$quick" = no ] || {
    say "all quick checks passed"
    exit 0
}

prepare_graphics
prepare_screen
step "lints" cargo clippy "${full[@]}" --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" step "documentation" cargo doc "${full[@]}" --no-deps
screen=()
if [ -z "${DISPLAY:-}" ] && has_command xvfb-run; then
    screen=(xvfb-run --auto-servernum --server-args="-screen 0 1280x900x24")
fi
step "tests" "${screen[@]}" cargo test "${full[@]}"
say "all checks passed"
