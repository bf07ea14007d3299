# shellcheck shell=bash
# The form of a gate. Each is a program `tests/checks/NAME [TREE]` that reads TREE (default: this one), writes below
# TREE/build/checks/NAME only, and ends with status 0 (holds), 1 (does not hold; the lines before say what and where) or
# 77 (a tool is missing; one line says which). seeded_faults.sh shows of each that it can fail. To be sourced, never run.

# shellcheck source=tests/lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
tree=$(cd "${1-$root}" && pwd)
out=$tree/build/checks/$me
rm -rf "$out"
mkdir -p "$out"
cd "$tree" || exit 1

# need TOOL...: ends the gate as skipped when one is not there.
need() {
    local tool
    for tool in "$@"; do
        have "$tool" || { say "skipped, $tool is not installed"; exit 77; }
    done
}

# own_files PATTERN...: the project's own files that match the git patterns, committed or about to be, NUL-separated.
own_files() {
    git ls-files -z -co --exclude-standard --deduplicate -- "$@" |
        while IFS= read -r -d '' file; do [ ! -f "$file" ] || printf '%s\0' "$file"; done
}
