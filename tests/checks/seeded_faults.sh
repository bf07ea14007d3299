# shellcheck shell=bash
# Shows of each gate that it can fail, and fails for its own reason. A small tree that all gates accept is made, then
# one fault at a time is put into a copy of it: the gate must end with status 1 and say the words that belong to the
# fault. One line each: "found GATE: FAULT", "missed ...", "skipped ...". Status 1 when one was missed. Run it with
# `bash tests/checks/seeded_faults.sh`; what is executable in this folder is a gate.
set -uo pipefail
# shellcheck source=tests/lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"
checks=$root/tests/checks
work=$build/checks/seeded_faults
rm -rf "$work"
mkdir -p "$work"
missed=0

# verdict GATE TREE STATUS WORDS NAME: runs the gate; the status and the words must be as given.
verdict() {
    local status=0 log=$2.log
    "$checks/$1" "$2" >"$log" 2>&1 || status=$?
    if [ "$status" -eq 77 ]; then
        echo "skipped $1: $5"
    elif [ "$status" -eq "$3" ] && { [ -z "$4" ] || grep -qF -e "$4" "$log"; }; then
        echo "found $1: $5"
    else
        echo "missed $1: $5 (status $status, wanted $3 and '$4')"
        missed=1
    fi
}

# --- the tree that holds ----------------------------------------------------------------------------------------------

sound=$work/sound
mkdir -p "$sound"/firmware/src/{base,raster} "$sound"/build/{clang,sim/firmware} "$sound"/host/edgeline "$sound/tests"
cp "$root/.clang-format" "$root/.clang-tidy" "$sound/"
echo /build/ >"$sound/.gitignore"
cp "$root/host/pyproject.toml" "$sound/host/"
printf '#!/bin/sh\necho "hello"\n' >"$sound/tests/run"
mkdir -p "$sound/firmware/boards/a_board"
cat >"$sound/CMakePresets.json" <<'JSON'
{"version": 6, "configurePresets": [{"name": "a_board"}]}
JSON
cat >"$sound/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
project(a_board LANGUAGES C)
add_subdirectory(firmware/boards/a_board)
CMAKE
echo 'add_library(a_board start.c)' >"$sound/firmware/boards/a_board/CMakeLists.txt"
: >"$sound/firmware/boards/a_board/start.c"
printf '"""Nothing."""\n\nANSWER: int = 42\n' >"$sound/host/edgeline/__init__.py"
cat >"$sound/firmware/src/base/low.h" <<'C'
#pragma once
#include <stdint.h>
/* A third. */
uint32_t el_low(uint32_t x);
C
cat >"$sound/firmware/src/base/low.c" <<'C'
#include "base/low.h"

/* Neither float nor malloc: comments may say so. */
uint32_t el_low(uint32_t x)
{
    return x / 3u;
}
C
cat >"$sound/firmware/src/raster/high.h" <<'C'
#pragma once
#include "base/low.h"
C
echo '#include "base/low.h"' >"$sound/firmware/src/edgeline.h"
cat >"$sound/README.md" <<'MD'
```c
#include "edgeline.h"
int main(void) { return (int)el_low(0); }
```
MD
git -C "$sound" init -q
cc -std=c11 -I "$sound/firmware/src" -c "$sound/firmware/src/base/low.c" -o "$sound/build/low.o"
ar rc "$sound/build/sim/firmware/libedgeline_base.a" "$sound/build/low.o"
commands() {
    printf '[{"directory": "%s", "file": "%s", "command": "clang -std=c11 -I %s -c %s"}]\n' \
        "$1" "$1/firmware/src/base/low.c" "$1/firmware/src" "$1/firmware/src/base/low.c" >"$1/build/clang/compile_commands.json"
}
commands "$sound"
for gate in "$checks"/*; do
    [ ! -x "$gate" ] || verdict "${gate##*/}" "$sound" 0 "" "a sound tree passes"
done

# --- one fault at a time ----------------------------------------------------------------------------------------------

number=0
# fault GATE NAME WORDS FILE: standard input is added to FILE of a fresh copy of the sound tree.
fault() {
    number=$((number + 1))
    local copy=$work/$number
    cp -a "$sound" "$copy"
    mkdir -p "$(dirname "$copy/$4")"
    cat >>"$copy/$4"
    commands "$copy"
    verdict "$1" "$copy" 1 "$3" "$2"
}

low=firmware/src/base/low.c
fault words "a float" "low.c:8: 'float'" $low <<<'static float el_f;'
fault words "a heap" "low.c:8: 'malloc'" $low <<<'void *malloc(int);'
fault words "a libc header" "<stdio.h> is not one of" $low <<<'#include <stdio.h>'
fault words "a path upwards" "leaves its layer" $low <<<'#include "../raster/high.h"'
fault arm_objects "soft floating point" "calls __aeabi_f" $low <<<'int el_f(int x) { return (int)(x * 0.1f); }'
fault arm_objects "a libc function" "calls puts" $low <<<'int puts(const char *); void el_f(void) { puts(""); }'
fault arm_objects "a variable" "variable el_state" $low <<<'int el_state; int el_f(void) { return el_state++; }'
fault arm_objects "a local static" "variable count" $low \
    <<<'int el_f(void) { static int count = 1; return count++; }'
fault riscv_objects "soft floating point" "calls __mulsf3" $low <<<'int el_f(int x) { return (int)(x * 0.1f); }'
fault riscv_objects "a variable" "variable el_state" $low <<<'int el_state; int el_f(void) { return el_state++; }'
fault layers "an upward include" "low.c does not compile" $low <<<'#include "raster/high.h"'
fault layers "a header that leans on its user" "own.h does not compile" firmware/src/base/own.h <<<'uint32_t el_own(void);'
fault layers "an unknown layer" "no layer that this gate knows" firmware/src/extra/x.h <<<'#pragma once'
fault c_format "a line out of form" "clang-format-violations" $low <<<'int  el_f ( void );'
fault c_lint "an assignment in a condition" "low.c:10" $low <<C
int el_f(int x)
{
    if (x = 1)
        return 0;
    return x;
}
C
fault c_lint "an assignment in a condition, in a board" "start.c:3" firmware/boards/a_board/start.c <<C
int el_f(int x)
{
    if (x = 1)
        return 0;
    return x;
}
C
fault javascript "a bracket too few" "Unexpected end of input" tests/a.mjs <<<'f(1, {'
fault python_style "a wrong type in a board's test" "Incompatible types" tests/target/a.py <<<'A: int = "a"'
fault python_style "an unused import" "F401" host/edgeline/a.py <<<'import os'
fault python_style "a line out of form" "1 file would be reformatted" host/edgeline/a.py <<<"A = {  'a':1 }"
fault python_style "a wrong type" "Incompatible types" host/edgeline/a.py <<<'A: int = "a"'
# shellcheck disable=SC2016 # the fault is the text itself
fault shell_style "an unquoted word" "SC2086" tests/run <<<'cat $1'
: >"$sound/README.md"
fault readme_program "no program" "no \`\`\`c block" README.md <<<'Words alone.'
fault readme_program "a program that does not compile" "unused" README.md \
    <<<$'```c\nint main(void) { int x = 0; return 0; }\n```'
fault readme_program "a program that does not link" "el_absent" README.md \
    <<<$'```c\nint el_absent(void);\nint main(void) { return el_absent(); }\n```'
fault reference "a function without a comment" "el_own" firmware/src/base/low.h <<<$'\nuint32_t el_own(void);'
fault reference "a module that cannot be read" "Error importing" host/edgeline/a.py <<<'import no_such_module'
fault own_paths "a folder of one machine" "a path of one machine" a.txt <<<"see /root""/notes"
fault own_paths "an address of a registry" "an address of a package registry" a.txt \
    <<<"https:""//registry.example.org/x.tgz"

# --- the looks of surfaces ----------------------------------------------------------------------------------------------

# Faults in what lights, fog and mixes, one place changed in a copy of a source: its unit test must fail, by an assertion of
# its own. A fault reads no memory that is not the program's: what that would show is the machine's choice. What is inline
# is changed in its header, and compiled into the sources that are named.
unity=${EDGELINE_UNITY_DIR:-$build/unity/src}
[ -f "$unity/unity.c" ] || unity=$build/sim/_deps/unity-src/src
looks=$work/looks
compile=(cc -std=c11 -O1 -DUNITY_SUPPORT_64 -I "$looks/src" -I "$root/tests/unit" -I "$unity")

# look TEST NAME FILE OLD NEW [SOURCE...]: OLD stands in one line of FILE.
look() {
    local test=$1 name=$2 file=$3 sources=("${@:6}") status=0
    if [ ! -f "$looks/sound.a" ]; then
        echo "skipped $test: $name"
        return
    fi
    [ "${file##*.}" = h ] || sources+=("$file")
    python3 - "$looks/src/$file" "$4" "$5" <<'PYTHON' || { echo "missed $test: $name (there is no one such place)"; missed=1; return; }
import sys
from pathlib import Path

path, old, new = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
text = path.read_text(encoding="utf-8")
if text.count(old) != 1:
    sys.exit(1)
path.write_text(text.replace(old, new), encoding="utf-8")
PYTHON
    if "${compile[@]}" "$root/tests/unit/$test.c" "${sources[@]/#/$looks/src/}" "$unity/unity.c" "$looks/sound.a" -lm \
        -o "$looks/test" >"$looks.log" 2>&1; then
        timeout 60 "$looks/test" >>"$looks.log" 2>&1 || status=$?
    fi
    if [ "$status" -ne 0 ] && grep -q ":FAIL" "$looks.log"; then
        echo "found $test: $name"
    else
        echo "missed $test: $name (status $status)"
        missed=1
    fi
    cp "$root/firmware/src/$file" "$looks/src/$file"
}

mkdir -p "$looks/objects"
cp -r "$root/firmware/src" "$looks/src"
if [ -f "$unity/unity.c" ]; then
    (cd "$looks/objects" && printf '%s\0' "$looks"/src/{base,geometry,raster}/*.c |
        xargs -0 -P 2 -n 8 cc -std=c11 -O1 -I "$looks/src" -c && ar rc "$looks/sound.a" ./*.o)
fi
lights=geometry/lights.c fog=raster/fog.c mixed=raster/fill_mixed_line.c
texels=raster/texel_line.c strips=raster/texel_strip.c smooth=raster/texel_smooth.c
look test_lights "spots have a sharp border" $lights "(3U << 15) - t_q16" "(1U << 15)"
look test_lights "a lamp behind the surface lights it" $lights "if (along <= 0)" "if (along == 0)"
look test_lights "a direction behind the surface lights it" $lights "if (cosine_q28 <= 0)" "if (cosine_q28 == 0)"
look test_lights "light does not fade with distance" $lights "v->square >> 1" "v->square >> 31"
look test_lights "highlights of what is not halfway" $lights "(at->to_eye_q30[i] >> 1)" "(at->to_eye_q30[i] >> 2)"
look test_lights "highlights as of half the exponent" $lights "for (; exponent > 0; exponent >>= 1)" "for (exponent >>= 1; exponent > 0; exponent >>= 1)"
look test_lights "both sides are the front" $lights "if (set->lighting->two_sided &&" "if (false && set->lighting->two_sided &&"
look test_lights "nothing glows by itself" $lights "(uint32_t)l->emissive[i] << 8" "(uint32_t)l->emissive[i] << 0"
look test_arrow "a long way is taken for its lower word" geometry/arrow.c "upper ^ (upper >> 31)" "upper & (upper >> 31)"
look test_arrow "lengths after one step of two" base/root.c "* more_q27) >> 11" "* more_q27) >> 31"
look test_fog "fog by the nearest entry" raster/fog.h "(fall * in_step >> step_log2)" "(fall * 0U * in_step)" $fog
look test_fog "e^-x of too few terms" $fog "TERMS = 8" "TERMS = 2"
look test_fog "fog begins at the eye" $fog "begin_q16 > view->near_q16 ? begin_q16" "begin_q16 > view->far_q16 ? begin_q16"
look test_sampler "mirrors repeat" raster/sampler.c ": axis->period - 1U - in_period" ": in_period - axis->size"
look test_sampler "coordinates below 0 are off by one" raster/sampler.c "(FARTHEST + period - 1U) / period * period" "FARTHEST"
look test_sampler "rows of mirrored pictures repeat" $strips "is_turned ? last : 0U, is_turned ? 0U - 1U : 1U" "0U, 1U"
look test_sampler "what is clamped begins a texel late" $strips "strip_from(0, length, 0, 1)" "strip_from(0, length + 1U, 0, 1)"
look test_sampler "the last texel's neighbour is itself" $strips "axis->period == axis->size" "axis->size == 0"
look test_sampler "what is clamped begins a texel early" $strips "has_neighbours ? last :" "has_neighbours ? last - (last > 1U) :"
look test_sampler "only u leaves a strip" raster/texel_row.h "row->v_q16 += count * row->v_step_q16" "row->v_q16 += 0" $texels $smooth
look test_sampler "the right half byte is the left one" $texels "((~i & 1U) << 2)" "((i & 1U) << 2)"
look test_sampler "the lower two texels are the upper" $smooth "(upper + to_lower) & v_mask" "upper & v_mask"
look test_sampler "the lower two in lines are the upper" $texels "(i >> 1) * (line" "(i >> 2) * (line"
look test_sampler "the mean of four is rounded down" base/rgb565.h "down) + 0x00800080U" "down)" base/image.c $smooth
look test_sampler "alpha of a palette is forgotten" $texels "if (line->has_alpha_apart)" "if (false)"
look test_mixed "what is blended hides" $mixed "b->writes_depth && b->way <= EL_MIXED_BLENDED" "b->way <= EL_MIXED_BLENDED"
look test_mixed "half a texel is none" $mixed "is_tested ? 128U : 1U" "is_tested ? 257U : 1U"
look test_mixed "an odd pixel is blended with another" $mixed "colour[count - 1U], alpha" "colour[0], alpha"
look test_mixed "no fog on what is far" $mixed "if (alpha != 0)" "if (alpha < 256)"
look test_mixed "pairs are rounded down" base/rgb565.h \
    "((over & 0x001F001FU) - under_b) * alpha + 0x00800080U" "((over & 0x001F001FU) - under_b) * alpha" $mixed
look test_depth_row "asking writes" raster/depth_row.c "            depth++;
            z += step;
        }
    }
    const uint32_t passed" "            *depth++ = (uint16_t)(z >> 32);
            z += step;
        }
    }
    const uint32_t passed"

exit "$missed"
