# shellcheck shell=bash
# What a compiler makes of firmware/src, for the gates that look at objects. To be sourced after gate.sh, never run.

# check_objects PREFIX ALLOWED FLAG...: compiles firmware/src with PREFIX-gcc. Each object may call the four functions of
# string.h that a compiler assumes and what the pattern ALLOWED names, its integer helpers; no software floating point, no
# libc. None may hold a variable: state belongs to the caller.
check_objects() {
    local prefix=$1 allowed="^(mem(cpy|set|cmp|move)|$2)\$" source object
    shift 2
    while IFS= read -r -d '' source; do
        # shellcheck disable=SC2154 # gate.sh gives `out`
        object=$out/$(echo "${source#firmware/src/}" | tr / _).o
        "$prefix-gcc" "$@" -std=c11 -Os -ffreestanding -Ifirmware/src -c "$source" -o "$object"
    done < <(find firmware/src -name '*.c' -print0 | sort -z)
    [ -n "$(find "$out" -name '*.o')" ] || { say "firmware/src holds no C source"; exit 1; }

    # nm -P -A: "object: symbol type value size"; the first pass learns what the layers give one another.
    "$prefix-nm" -P -A "$out"/*.o >"$out/symbols"
    awk -v allowed="$allowed" '
        { sub(".*/", "", $1); sub("\\.o:$", "", $1) }
        NR == FNR { if ($3 ~ /^[TRWV]$/) defined[$2] = 1; next }
        $3 ~ /^[Uw]$/ && !($2 in defined) && $2 !~ allowed { print $1 ": calls " $2; bad = 1 }
        $3 ~ /^[dDbBC]$/ { print $1 ": variable " $2 ", but state belongs to the caller"; bad = 1 }
        END { exit bad }' "$out/symbols" "$out/symbols"
}
