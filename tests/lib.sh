# shellcheck shell=bash
# What tests/prepare, tests/run, sim/demo and the gates share: where things are, and how a step speaks. A step prints one
# line; what its commands print goes to a log, whose tail is shown when the step fails. To be sourced, never run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
# shellcheck disable=SC2034 # used by the scripts that source this file
venv=$build/venv
# The virtual environment comes first: where the system's CMake is too old, a newer one is there.
PATH=$build/venv/bin:$PATH
export PATH

# The name that the user called stands before each message.
me=${0##*/}

say() {
    printf '%s: %s\n' "$me" "$*"
}

# die STATUS MESSAGE: one line on stderr, and the end.
die() {
    printf '%s: %s\n' "$me" "$2" >&2
    exit "$1"
}

have() {
    command -v "$1" >/dev/null 2>&1
}

# logged NAME COMMAND...: runs the command into build/logs/NAME.log; on failure shows the log's tail and returns the
# command's status.
logged() {
    local log=$build/logs/$1.log status=0
    shift
    mkdir -p "$build/logs"
    "$@" >"$log" 2>&1 || status=$?
    if [ "$status" -ne 0 ]; then
        printf '%s: failed (status %d): %s\n' "$me" "$status" "$*" >&2
        tail -n 20 "$log" | cut -c -200 | sed 's/^/    /' >&2
        printf '%s: the whole log: %s\n' "$me" "${log#"$root"/}" >&2
    fi
    return "$status"
}
