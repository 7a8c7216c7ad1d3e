# Makes sure that this machine can build (and, if asked, test) Hairline. Sourced by the other scripts.
#
# Debian and Ubuntu: what is missing is installed with apt-get, through sudo when not root. Elsewhere,
# or when that fails, the script says what is missing and stops only if it cannot do without.

HAIRLINE_RUST_MINOR=95 # the oldest Rust that builds this: 1.95

say() { printf '\n== %s\n' "$*" >&2; }
note() { printf '   %s\n' "$*" >&2; }
stop() {
    printf '\nhairline: %s\n' "$*" >&2
    exit 3
}

has_command() { command -v "$1" >/dev/null 2>&1; }

# Whether the dynamic linker finds a shared library of this name.
has_library() {
    local ldconfig
    ldconfig=$(PATH="$PATH:/usr/sbin:/sbin" command -v ldconfig) || return 1
    "$ldconfig" -p 2>/dev/null | grep -qF "$1 "
}

# Whether a Vulkan driver is registered, a software one included.
has_vulkan() {
    has_library libvulkan.so.1 || return 1
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    local folder
    for folder in /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d \
        "${XDG_DATA_HOME:-${HOME:-/nonexistent}/.local/share}/vulkan/icd.d"; do
        compgen -G "$folder/*.json" >/dev/null && return 0
    done
    return 1
}

# apt_install PACKAGE...: 0 when installed, 1 when that is not possible here.
apt_install() {
    local as_root=()
    has_command apt-get || return 1
    if [ "$(id -u)" -ne 0 ]; then
        has_command sudo || return 1
        # Without a terminal a password prompt would wait for ever.
        if [ -t 0 ]; then as_root=(sudo); else as_root=(sudo -n); fi
    fi
    say "installing $*"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@" >&2 && return 0
    note "the package lists may be old: updating them"
    "${as_root[@]}" apt-get update >&2 || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@" >&2
}

# The compiler: a linker for Rust, and Rust itself.
prepare_build() {
    if ! has_command cc; then
        apt_install gcc libc6-dev || stop "a C compiler is missing (it links the program). Install gcc or clang."
    fi
    if ! has_command cargo && [ -x "${CARGO_HOME:-${HOME:-/nonexistent}/.cargo}/bin/cargo" ]; then
        PATH="${CARGO_HOME:-$HOME/.cargo}/bin:$PATH"
    fi
    if ! has_command cargo; then
        # Newer Debian and Ubuntu package rustup; elsewhere its own page is one command away.
        apt_install rustup >/dev/null 2>&1 && rustup default stable >&2 || true
    fi
    has_command cargo || stop "Rust is missing. Install it as https://rustup.rs says, then run this again:
          curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y && . \"\$HOME/.cargo/env\""
    local version minor
    version=$(rustc --version 2>/dev/null | cut -d' ' -f2)
    minor=$(printf '%s' "$version" | cut -d. -f2)
    case "$version" in
    1.*) [ "$minor" -ge "$HAIRLINE_RUST_MINOR" ] || stop "Rust $version is too old; 1.$HAIRLINE_RUST_MINOR or newer is needed: rustup update stable" ;;
    '') stop "rustc does not run; reinstall Rust with rustup" ;;
    esac
}

# What a window and a Vulkan picture need while the program runs. Missing parts are only named: the
# program itself says what it cannot do without them.
prepare_graphics() {
    local wanted=() library
    has_vulkan || wanted+=(mesa-vulkan-drivers libvulkan1)
    for library in libX11.so.6:libx11-6 libX11-xcb.so.1:libx11-xcb1 libXcursor.so.1:libxcursor1 libXi.so.6:libxi6 \
        libXrandr.so.2:libxrandr2 libxkbcommon.so.0:libxkbcommon0 libxkbcommon-x11.so.0:libxkbcommon-x11-0; do
        has_library "${library%%:*}" || wanted+=("${library##*:}")
    done
    [ ${#wanted[@]} -eq 0 ] || apt_install "${wanted[@]}" ||
        note "could not install ${wanted[*]}: without them there may be no window or no Vulkan"
}

# A virtual screen for the window tests.
prepare_screen() {
    local wanted=()
    has_command Xvfb || wanted+=(xvfb)
    has_command xauth || wanted+=(xauth)
    [ ${#wanted[@]} -eq 0 ] || apt_install "${wanted[@]}" ||
        note "could not install ${wanted[*]}: tests that open a window cannot run"
}
