/* The display list: names and bins keep the order of submission, runs are shared, a full list says so, and compaction
 * keeps exactly what a plain model keeps. */
#include <string.h>

#include "raster/list.h"
#include "seeded.h"

enum {
    BINS = 12,
    LINES = 4,
    BYTES = 4096,
    GUARD = 32,
    MODEL_MAX = 512,
    RUN_BYTES = (sizeof(el_run) + 7) / 8 * 8,
    DRAW_BYTES = RUN_BYTES + (sizeof(el_draw_state) + 7) / 8 * 8
};

static uint8_t memory[BYTES + GUARD] __attribute__((aligned(8)));
static uint16_t bins[BINS + 1];
static el_list list;
static const el_material material = {.shading = EL_SHADE_FLAT};
static const el_mesh meshes[4];

void setUp(void)
{
    memset(memory, 0x5A, sizeof memory);
    bins[BINS] = 0x5A5A;
    el_list_init(&list, memory, BYTES, bins, BINS, LINES);
}

void tearDown(void)
{
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5A, memory + BYTES, GUARD);
    TEST_ASSERT_EQUAL_HEX16(0x5A5A, bins[BINS]);
}

static el_draw_state draw_of(unsigned mesh)
{
    return (el_draw_state){.mesh = &meshes[mesh], .material = &material};
}

/* A triangle that begins at `row`: its uppermost corner is on that row's centre. */
static el_record *append(unsigned mesh, el_record_kind kind, int32_t row, int32_t from, uint16_t index)
{
    const el_draw_state draw = draw_of(mesh);
    el_record *const record =
        el_list_append(&list, &draw, kind, row > from ? row : from, (row > from ? row : from) + 1);
    if (record != NULL) {
        const el_coordinate y = (el_coordinate)(row * EL_SUBPIXELS + EL_SUBPIXELS / 2);
        record->index = index;
        if (kind == EL_RECORD_THIN) {
            record->at.row = (int16_t)row;
            return record;
        }
        record->at.points[0] = (el_point){.x = 1, .y = (el_coordinate)(y + 99), .z = 1};
        record->at.points[1] = (el_point){.x = 2, .y = y, .z = 2};
        record->at.points[2] = (el_point){.x = 3, .y = (el_coordinate)(y + 50), .z = 3};
    }
    return record;
}

/* The indices in a bin, first to last. */
static unsigned bin_indices(uint16_t band, uint16_t indices[MODEL_MAX])
{
    unsigned count = 0;
    uint16_t before = 0;
    for (uint16_t name = el_list_take_bin(&list, band); name != 0;) {
        const el_record *const record = el_list_at(&list, name);
        TEST_ASSERT_GREATER_THAN_UINT16_MESSAGE(before, name, "names follow the order of submission");
        TEST_ASSERT_LESS_THAN_UINT(MODEL_MAX, count);
        indices[count++] = record->index;
        before = name;
        name = record->next;
    }
    return count;
}

static void expect_bin(uint16_t band, unsigned count, const uint16_t *expected)
{
    uint16_t got[MODEL_MAX];
    TEST_ASSERT_EQUAL_UINT(count, bin_indices(band, got));
    if (count > 0) {
        TEST_ASSERT_EQUAL_UINT16_ARRAY(expected, got, count);
    }
}

static void test_bins_keep_the_order(void)
{
    for (uint16_t i = 0; i < 9; i++) {
        TEST_ASSERT_NOT_NULL(append(0, EL_RECORD_PLAIN, i % 3 * LINES, 0, i));
    }
    expect_bin(0, 3, (const uint16_t[]){0, 3, 6});
    expect_bin(1, 3, (const uint16_t[]){1, 4, 7});
    expect_bin(2, 3, (const uint16_t[]){2, 5, 8});
    expect_bin(3, 0, NULL);
    expect_bin(0, 0, NULL); /* taken */
}

static void test_a_row_belongs_to_its_band(void)
{
    append(0, EL_RECORD_PLAIN, 0, 0, 1);
    append(0, EL_RECORD_PLAIN, LINES - 1, 0, 2);
    append(0, EL_RECORD_PLAIN, LINES, 0, 3);
    append(0, EL_RECORD_PLAIN, BINS * LINES - 1, 0, 4);
    expect_bin(0, 2, (const uint16_t[]){1, 2});
    expect_bin(1, 1, (const uint16_t[]){3});
    expect_bin(BINS - 1, 1, (const uint16_t[]){4});
}

/* Every band's first and last row, for every height that bands may have. */
static void test_a_product_finds_every_band(void)
{
    for (uint16_t lines = 1; lines <= EL_MAX_HEIGHT; lines++) {
        el_list_init(&list, memory, BYTES, bins, 0, lines);
        for (int32_t row = 0, band = 0; row < EL_MAX_HEIGHT; row += lines, band++) {
            TEST_ASSERT_EQUAL_INT32(band, el_list_band_of(&list, row));
            TEST_ASSERT_EQUAL_INT32(band, el_list_band_of(&list, row + lines - 1));
        }
    }
}

static void test_records_of_one_draw_share_a_run(void)
{
    const el_record *const a = append(1, EL_RECORD_PLAIN, 0, 0, 0);
    const el_record *const b = append(1, EL_RECORD_PLAIN, 9, 0, 1);
    TEST_ASSERT_EQUAL_UINT16(a->run, b->run);
    const el_run *const run = el_list_at(&list, a->run);
    TEST_ASSERT_EQUAL_PTR(&meshes[1], el_list_draw(&list, b)->mesh);
    TEST_ASSERT_EQUAL_UINT8(EL_RECORD_PLAIN, run->kind);
    TEST_ASSERT_EQUAL_UINT32(EL_LIST_UNIT + DRAW_BYTES + 2 * ((sizeof(el_record) + 7) / 8 * 8), list.used);
    el_list_end_draw(&list);
    TEST_ASSERT_EQUAL_UINT32(list.used, run->end * EL_LIST_UNIT);
}

static void test_another_kind_or_an_end_opens_a_run(void)
{
    const el_record *const a = append(1, EL_RECORD_PLAIN, 0, 0, 0);
    const el_record *const b = append(1, EL_RECORD_CLIPPED, 0, 0, 1);
    const el_record *const c = append(1, EL_RECORD_PLAIN, 0, 0, 2);
    el_list_end_draw(&list);
    const el_record *const d = append(2, EL_RECORD_PLAIN, 0, 0, 3);
    TEST_ASSERT_TRUE(a->run != b->run && b->run != c->run && c->run != d->run);
    TEST_ASSERT_EQUAL_PTR(&meshes[2], el_list_draw(&list, d)->mesh);
    TEST_ASSERT_EQUAL_PTR_MESSAGE(el_list_draw(&list, a), el_list_draw(&list, c), "one state per draw call");
    TEST_ASSERT_EQUAL_UINT8(EL_RECORD_CLIPPED, ((const el_run *)el_list_at(&list, b->run))->kind);
    expect_bin(0, 4, (const uint16_t[]){0, 1, 2, 3});
}

/* It takes what fits to the byte, says no afterwards, and leaves what it has. */
static void test_a_full_list(void)
{
    const uint32_t record_bytes = (sizeof(el_record) + 7) / 8 * 8;
    for (uint32_t room = 0; room < 64; room += 8) {
        el_list_init(&list, memory, EL_LIST_UNIT + DRAW_BYTES + 3 * record_bytes + room, bins, BINS, LINES);
        const unsigned fits = 3 + room / record_bytes;
        for (uint16_t i = 0; i < fits; i++) {
            TEST_ASSERT_NOT_NULL(append(0, EL_RECORD_PLAIN, 0, 0, i));
        }
        TEST_ASSERT_NULL(append(0, EL_RECORD_PLAIN, 0, 0, 99));
        TEST_ASSERT_NULL(append(0, EL_RECORD_PLAIN, 5, 0, 99));
        expect_bin(0, fits, (const uint16_t[]){0, 1, 2, 3, 4});
        expect_bin(1, 0, NULL);
    }
    el_list_init(&list, memory, EL_LIST_UNIT + DRAW_BYTES + 16, bins, BINS, LINES);
    TEST_ASSERT_NULL(append(0, EL_RECORD_PLAIN, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT32(EL_LIST_UNIT, list.used);
}

static void test_clear_empties_all_bins(void)
{
    append(0, EL_RECORD_PLAIN, 0, 0, 0);
    append(0, EL_RECORD_PLAIN, BINS * LINES - 1, 0, 1);
    el_list_clear(&list);
    for (uint16_t band = 0; band < BINS; band++) {
        expect_bin(band, 0, NULL);
    }
    TEST_ASSERT_EQUAL_UINT32(EL_LIST_UNIT, list.used);
}

/* --- Compaction against a model ----------------------------------------------------------------------------------- */

typedef struct model_record {
    unsigned draw; /* number of the draw call */
    unsigned mesh;
    el_record_kind kind;
    int32_t row;
    uint16_t index;
} model_record;

static uint32_t model_bytes(const model_record *records, unsigned count)
{
    static const uint32_t sizes[EL_RECORD_KINDS] = {
        [EL_RECORD_THIN] = EL_THIN_BYTES,
        [EL_RECORD_PLAIN] = (sizeof(el_record) + 7) / 8 * 8,
        [EL_RECORD_CUT] = (sizeof(el_record) + 7) / 8 * 8,
        [EL_RECORD_PERSPECTIVE] = (sizeof(el_record_perspective) + 7) / 8 * 8,
        [EL_RECORD_CLIPPED] = (sizeof(el_record_clipped) + 7) / 8 * 8,
    };
    uint32_t bytes = EL_LIST_UNIT;
    for (unsigned i = 0; i < count; i++) {
        const bool opens_draw = i == 0 || records[i].draw != records[i - 1].draw;
        const bool opens = opens_draw || records[i].kind != records[i - 1].kind;
        bytes += sizes[records[i].kind] + (opens_draw ? DRAW_BYTES : (opens ? RUN_BYTES : 0U));
    }
    return bytes;
}

static void expect_model(const seeded *s, const model_record *records, unsigned count, int32_t row_begin)
{
    unsigned left = count;
    for (uint16_t band = 0; band < BINS; band++) {
        unsigned at = 0;
        for (uint16_t name = el_list_take_bin(&list, band); name != 0; left--) {
            const el_record *const record = el_list_at(&list, name);
            const el_run *const run = el_list_run(&list, record);
            while (at < count && (records[at].row > row_begin ? records[at].row : row_begin) / LINES != band) {
                at++;
            }
            if (at == count || record->index != records[at].index ||
                el_list_draw(&list, record)->mesh != &meshes[records[at].mesh] ||
                run->kind != (uint8_t)records[at].kind ||
                (run->kind == EL_RECORD_THIN ? record->at.row != records[at].row : record->at.points[2].x != 3)) {
                fail_at(s, "band %u, record %u", band, at);
            }
            at++;
            name = record->next;
        }
    }
    if (left != 0) {
        fail_at(s, "%u records are missing", left);
    }
}

/* A record's kind in a thin list: parts of triangles stay as they are. */
static el_record_kind thinned(el_record_kind kind)
{
    return kind == EL_RECORD_CUT || kind == EL_RECORD_CLIPPED ? kind : EL_RECORD_THIN;
}

/* Appends, makes the list thin or keeps fewer and fewer rows as a pass does, appends more; at the end the bins hold what
 * the model holds. Runs and draw calls of which nothing is left take no memory, but for those that still take records. */
static void test_kept_rows_seeded(void)
{
    unsigned full = 0;
    unsigned made_thin = 0;
    for (seeded s = seeded_from(90); s.round < 3000; s.round++) {
        static model_record records[MODEL_MAX];
        unsigned count = 0;
        const int32_t row_begin = LINES * (int32_t)any_below(&s, 4);
        int32_t row_end = BINS * LINES;
        unsigned mesh = 0;
        unsigned draw = 0;
        el_list_init(&list, memory, 512 + any_below(&s, 400) * 8, bins, BINS, LINES);
        for (uint16_t step = 0; step < 400; step++) {
            if (any_below(&s, 12) == 0) {
                mesh = (mesh + 1) % 4;
                draw++;
                el_list_end_draw(&list);
            }
            const el_record_kind own =
                (el_record_kind)(EL_RECORD_PLAIN + (any_below(&s, 8) == 0 ? any_below(&s, 4) : mesh % 4));
            const el_record_kind kind = list.is_thin ? thinned(own) : own;
            const int32_t row = (int32_t)any_between(&s, row_begin - 9, row_end - 1);
            if (append(mesh, kind, row, row_begin, step) != NULL) {
                records[count++] = (model_record){.draw = draw, .mesh = mesh, .kind = kind, .row = row, .index = step};
                continue;
            }
            full++;
            if (!list.is_thin && any_below(&s, 2) == 0) {
                made_thin++;
                el_list_make_thin(&list, row_begin);
                for (unsigned i = 0; i < count; i++) {
                    records[i].kind = thinned(records[i].kind);
                }
            } else if (row_end - row_begin <= LINES) {
                break;
            } else {
                row_end = row_begin + (row_end - row_begin) / LINES * 3 / 4 * LINES;
                unsigned kept = 0;
                for (unsigned i = 0; i < count; i++) {
                    if (records[i].row < row_end) {
                        records[kept++] = records[i];
                    }
                }
                count = kept;
                el_list_keep_rows(&list, row_begin, row_end);
            }
            /* Neighbouring runs of one kind are not joined: up to a run each. */
            TEST_ASSERT_GREATER_OR_EQUAL_UINT32(model_bytes(records, count), list.used);
        }
        expect_model(&s, records, count, row_begin);
    }
    TEST_ASSERT_GREATER_THAN_UINT(1000, full);
    TEST_ASSERT_GREATER_THAN_UINT(1000, made_thin);
}

static void test_nothing_kept_is_an_empty_list(void)
{
    for (uint16_t i = 0; i < 20; i++) {
        append(i / 5, EL_RECORD_PLAIN, 20, 0, i);
    }
    el_list_end_draw(&list);
    el_list_keep_rows(&list, 0, 20);
    TEST_ASSERT_EQUAL_UINT32(EL_LIST_UNIT, list.used);
    for (uint16_t band = 0; band < BINS; band++) {
        expect_bin(band, 0, NULL);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bins_keep_the_order);
    RUN_TEST(test_a_row_belongs_to_its_band);
    RUN_TEST(test_a_product_finds_every_band);
    RUN_TEST(test_records_of_one_draw_share_a_run);
    RUN_TEST(test_another_kind_or_an_end_opens_a_run);
    RUN_TEST(test_a_full_list);
    RUN_TEST(test_clear_empties_all_bins);
    RUN_TEST(test_kept_rows_seeded);
    RUN_TEST(test_nothing_kept_is_an_empty_list);
    return UNITY_END();
}
