"""raster/fog: what is farther has as much fog before it or more, and never more than all.

A table falls from its first entry, the farthest, to its last. Between two entries it is interpolated: there alpha lies
between theirs and falls, too; so it falls from place to place over the whole table and beyond either end. A place grows
with nearness, and nearness falls with depth.

That tables fall is a matter of their laws: a line is one by its formula, e^-x is computed for every x that there is. Of
cameras and distances at their limits, and many between, tables are made and looked up.
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

import pytest

from c_source import SOURCES, companions_of, faulty_tree
from c_values import Memory
from proof import Fault, Machine, Number, Pointer, Poly, Subject, compile_c
from symbolic import Path

FILE, HEADER, TRANSFORM = "raster/fog.c", "raster/fog.h", "geometry/transform.c"
FULL_Q7, STEPS, ALL = 256 << 7, 256, 256


@dataclass(frozen=True)
class Falling(Memory):
    """Of two entries the later one is not larger."""

    read: list[tuple[Poly, Poly]] = field(default_factory=list)

    def element(self, path: Path, index: Poly) -> Poly:
        for at, value in self.read:
            if path.holds(index - at) and path.holds(at - index):
                return value
        new = path.atom("alpha", 0, FULL_Q7)
        for at, value in self.read:
            path.assume(value - new if path.holds(index - at) else new - value)
        self.read.append((index, new))
        return new


class Places:
    """Two places in the same step of a table whose steps are 2^step_log2 long, or in the first beyond it."""

    def __init__(self, step_log2: int) -> None:
        self.length = 1 << step_log2
        self.step_log2 = step_log2

    def domain(self, machine: Machine) -> list[Any]:
        path = machine.path
        self.end, self.step = path.atom("end", 0, 33 << 16), path.atom("step", 0, STEPS + 1)
        self.near, self.far = path.atom("near", 0, self.length - 1), path.atom("far", 0, self.length - 1)
        path.assume(self.near - self.far)
        self.table = Falling(machine.type_named("uint16_t"), STEPS + 2)
        fog = machine.struct("el_fog", end=self.end, step_log2=self.step_log2, alpha_q7=self.table)
        return [Pointer([fog]), self.place(machine, self.far)]

    def place(self, machine: Machine, in_step: Poly) -> Number:
        return machine.exactly("uint32_t", self.end + self.step * self.length + in_step)

    def in_step(self, machine: Machine, value: Number) -> Number:
        """A part of the fall is not more than all of it; and it grows with the part."""
        path, fall = machine.path, machine.locals["el_fog_at_place.fall"].poly
        for less in (value.poly, self.length - 1 - value.poly, self.near - self.far):
            path.assume_product(fall, less)
        return value

    def check(self, machine: Machine, arguments: list[Any], result: Number) -> None:
        path = machine.path
        if not path.decide(STEPS - self.step, self.step - STEPS - 1):
            path.prove(result.poly, "none beyond the table", zero=True)
            return
        upper = self.table.element(path, self.step)
        lower = self.table.element(path, self.step + 1)
        nearer = machine.call("el_fog_at_place", arguments[0], self.place(machine, self.near))
        path.prove(ALL - result.poly, "no more than all")
        path.prove(path.floor(upper + 64, 128) - result.poly, "no more than at the step's begin")
        path.prove(result.poly - nearer.poly, "no less than nearer in the step")
        path.prove(nearer.poly - path.floor(lower + 64, 128), "no less than where the next step begins")

    def subject(self) -> Subject:
        lemmas = {"el_fog_at_place.in_step": self.in_step}
        return Subject(HEADER, "el_fog_at_place", self.domain, self.check, lemmas=lemmas)


@pytest.mark.parametrize("step_log2", range(17))
def test_fog_falls_along_the_table(step_log2: int) -> None:
    Places(step_log2).subject().prove()


def place_of(leading: int) -> Subject:
    """A power of two's share of places, and within it one that grows."""
    least, most = 1 << 31 - leading, (1 << 32 - leading) - 1

    def domain(machine: Machine) -> list[Any]:
        return [machine.number("uint32_t", "nearness", least, most), machine.exactly("uint32_t", leading)]

    def check(machine: Machine, arguments: list[Any], result: Number) -> None:
        path, begin = machine.path, (32 - leading) << 16
        path.prove(result.poly - begin, "not before its power's first place")
        path.prove(begin + 65535 - result.poly, "nor beyond its last")
        nearer = path.atom("nearer", least, most)
        path.assume(nearer - arguments[0].poly)
        other = machine.call("el_fog_place_of", machine.exactly("uint32_t", nearer), arguments[1])
        path.prove(other.poly - result.poly, "nearer is no earlier")

    return Subject(HEADER, "el_fog_place_of", domain, check)


def test_places_grow_with_nearness() -> None:
    for leading in range(32):
        place_of(leading).prove()


@pytest.mark.parametrize(
    ("subject", "file", "old", "new"),
    [
        (Places(5).subject(), HEADER, "farther - (fall * in_step >> step_log2)", "farther - (fall * in_step >> 4U)"),
        (Places(5).subject(), HEADER, "alpha_q7[step + 1U];", "alpha_q7[step + 2U];"),
        (Places(5).subject(), HEADER, "if (step > EL_FOG_STEPS) {", "if (step > EL_FOG_STEPS + 1) {"),
        (Places(5).subject(), HEADER, "alpha_q7[0] + 64U) >> 7", "alpha_q7[0] + 64U) >> 6"),
        (Places(5).subject(), HEADER, "along - (step << step_log2)", "along"),
        (place_of(9), HEADER, "(nearness << leading >> 15)", "(nearness << leading >> 14)"),
        (place_of(9), HEADER, "((31U - leading) << 16)", "((31U - leading) << 15)"),
    ],
)
def test_the_proof_can_fail(subject: Subject, file: str, old: str, new: str) -> None:
    subject.fails_with(Fault(file, old, new))


# --- tables -----------------------------------------------------------------------------------------------------------

TABLES = """
#include "raster/fog.c"
#include <stdio.h>

static uint64_t state = 1;

/* Of up to so many bits. */
static uint32_t any(unsigned bits)
{
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (uint32_t)(state >> 33) >> (31U - (uint32_t)(state >> 20 & 0xFFFU) % (bits + 1U));
}

static int falls(const el_fog *fog)
{
    for (unsigned i = 0; i < EL_FOG_STEPS + 1; i++) {
        if (fog->alpha_q7[i] > FULL_Q15 || fog->alpha_q7[i] < fog->alpha_q7[i + 1]) {
            return 0;
        }
    }
    uint32_t alpha = 0;
    for (uint32_t depth = any(6); depth <= EL_DEPTH_MAX; depth += 1U + any(8)) {
        const uint32_t farther = el_fog_at(fog, depth);
        if (farther < alpha || farther > 256) {
            return 0;
        }
        alpha = farther;
    }
    return el_fog_is_made(fog);
}

int main(void)
{
    for (uint32_t x = 0, last = FULL_Q15; x <= MOST_EXPONENT << 16; x++) {
        const uint32_t here = exponential_q15(x);
        if (here > last) {
            return printf("e^-x rises at %u\\n", x);
        }
        last = here;
    }
    uint32_t made = 0;
    for (unsigned round = 0; round < 4000; round++) {
        const uint32_t near = 16U + any(29);
        const uint32_t least = near + near / 8U + 1U;
        const uint32_t more = any(30);
        const uint32_t far = more < (1U << 30) - least ? least + more : 1U << 30;
        const el_camera camera = {.axes_q30 = {{1 << 30, 0, 0}, {0, 1 << 30, 0}, {0, 0, 1 << 30}},
                                  .fov_y = 1U << 29, .near_q16 = near, .far_q16 = far};
        const uint32_t begin = (round & 2U) != 0 ? any(31) : near - 1U + any(2);
        el_fog fog;
        const el_status status = (round & 1U) != 0 ? el_fog_exponential(&fog, &camera, 0, begin + 1U)
                                                   : el_fog_linear(&fog, &camera, 0, begin, begin + 1U + any(30));
        made += status == EL_OK;
        if (status == EL_OK && !falls(&fog)) {
            return printf("fog rises: round %u, near %u, far %u, begin %u\\n", round, near, far, begin);
        }
    }
    return made < 3000 ? printf("only %u are made\\n", made) : 0;
}
"""


def run_tables(folder: FilePath, tree: FilePath = SOURCES) -> subprocess.CompletedProcess[str]:
    program = folder / "tables"
    companions = [str(tree / name) for name in (TRANSFORM, *companions_of(TRANSFORM))]
    compile_c(TABLES, program, "-O1", *companions, tree=tree)
    return subprocess.run([program], capture_output=True, text=True, check=False)


def test_tables_fall(tmp_path: FilePath) -> None:
    done = run_tables(tmp_path)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("sum_q30 >> 15 >> whole", "sum_q30 >> 15 >> (whole & 7U)"),
        ("LN2_Q30 = 744261118", "LN2_Q30 = 764261118"),
        ("place < el_fog_place(fog->scale_q12) ? nearness_of(place)", "place > 0 ? nearness_of(place)"),
        ("fog->step_log2++;", "fog->step_log2 += 20;"),
        ("if (distance_q16 >= l->end_q16) {", "if (distance_q16 >= l->end_q16 + 9U) {"),
    ],
)
def test_a_table_that_rises_is_found(tmp_path: FilePath, old: str, new: str) -> None:
    assert run_tables(tmp_path, faulty_tree(tmp_path / "src", Fault(FILE, old, new))).returncode != 0
