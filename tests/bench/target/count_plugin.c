/* A QEMU plugin that counts executed guest instructions exactly, and notes the count whenever the guest reaches one of
 * the program's markers:
 *
 *     -plugin libcount.so,next=0x1c0,start=0x1c4,stop=0x1c8,out=FILE
 *
 * next, start and stop are the addresses of the marker functions. FILE gets one line per arrival, "start 12345": the
 * instructions executed until then. The count is an addition that QEMU compiles into each guest instruction; markers
 * alone call back, so counting costs little.
 *
 * With profile=FILE that file gets, at each `next` and at the end, "ADDRESS COUNT" for every instruction that was executed
 * between start and stop since the one before, and then "next". The code begins at code=ADDRESS; of what lies outside
 * PROFILED_BYTES from there, the last halfword has the sum.
 *
 * Debian's QEMU package has no header for plugins, so what is used of the interface, version 1, is declared here as
 * QEMU's documentation has it ("QEMU TCG Plugins", docs/devel/tcg-plugins.rst). */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_info_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { QEMU_PLUGIN_CB_NO_REGS = 0, QEMU_PLUGIN_INLINE_ADD_U64 = 0 };

typedef void translated(qemu_plugin_id_t id, struct qemu_plugin_tb *tb);
typedef void executed(unsigned vcpu, void *data);
typedef void at_exit(qemu_plugin_id_t id, void *data);

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, translated *callback);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *insn, executed *callback, int flags, void *data);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *insn, int operation, void *target,
                                                uint64_t value);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, at_exit *callback, void *data);

/* QEMU looks these two up by name. */
int qemu_plugin_version = 1;
int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc, char **argv);

typedef struct marker {
    const char *name;
    uint64_t address;
} marker;

enum { NEXT, START, STOP, MARKERS };
static marker markers[MARKERS] = {[NEXT] = {"next", 1}, [START] = {"start", 1}, [STOP] = {"stop", 1}};

static uint64_t count;
static FILE *out;

/* How often each halfword of code was executed. */
enum { PROFILED_BYTES = 1 << 20 };
static uint64_t visits[PROFILED_BYTES / 2];
static uint64_t visits_at_start[PROFILED_BYTES / 2];
static uint64_t measured[PROFILED_BYTES / 2];
static size_t profiled; /* halfwords from the first one on, all that were executed among them */
static uint64_t code_begin;
static FILE *profile;

static void write_profile(void)
{
    if (profile == NULL) {
        return;
    }
    for (size_t i = 0; i < profiled; i++) {
        if (measured[i] != 0) {
            fprintf(profile, "%" PRIx64 " %" PRIu64 "\n", code_begin + 2 * i, measured[i]);
            measured[i] = 0;
        }
    }
    fprintf(profile, "next\n");
    fflush(profile);
}

static void add_stretch(void)
{
    for (size_t i = 0; i < profiled; i++) {
        measured[i] += visits[i] - visits_at_start[i];
    }
}

static void ended(qemu_plugin_id_t id, void *data)
{
    (void)id;
    (void)data;
    write_profile();
}

static void arrived(unsigned vcpu, void *data)
{
    const marker *const at = data;
    (void)vcpu;
    fprintf(out, "%s %" PRIu64 "\n", at->name, count);
    if (at == &markers[NEXT]) {
        write_profile();
    } else if (at == &markers[START]) {
        memcpy(visits_at_start, visits, profiled * sizeof visits[0]);
    } else {
        add_stretch();
    }
}

static void instrument(qemu_plugin_id_t id, struct qemu_plugin_tb *tb)
{
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); i++) {
        struct qemu_plugin_insn *const insn = qemu_plugin_tb_get_insn(tb, i);
        qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &count, 1);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        if (profile != NULL) {
            const uint64_t offset = address - code_begin;
            const size_t place = (size_t)(offset < PROFILED_BYTES ? offset : PROFILED_BYTES - 1) / 2;
            qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &visits[place], 1);
            profiled = place < profiled ? profiled : place + 1;
        }
        for (size_t m = 0; m < MARKERS; m++) {
            if (address == markers[m].address) {
                qemu_plugin_register_vcpu_insn_exec_cb(insn, arrived, QEMU_PLUGIN_CB_NO_REGS, &markers[m]);
            }
        }
    }
}

/* False when the text is no NAME=VALUE that the plugin knows. */
static int take_argument(const char *text)
{
    const char *const value = strchr(text, '=');
    if (value == NULL) {
        return 0;
    }
    const size_t length = (size_t)(value - text);
    for (size_t m = 0; m < MARKERS; m++) {
        if (strlen(markers[m].name) == length && strncmp(text, markers[m].name, length) == 0) {
            markers[m].address = strtoull(value + 1, NULL, 16);
            return 1;
        }
    }
    if (length == 3 && strncmp(text, "out", 3) == 0) {
        out = fopen(value + 1, "w");
        return out != NULL;
    }
    if (length == 4 && strncmp(text, "code", 4) == 0) {
        code_begin = strtoull(value + 1, NULL, 16);
        return 1;
    }
    if (length == 7 && strncmp(text, "profile", 7) == 0) {
        profile = fopen(value + 1, "w");
        return profile != NULL;
    }
    return 0;
}

int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc, char **argv)
{
    (void)info;
    for (int i = 0; i < argc; i++) {
        if (!take_argument(argv[i])) {
            fprintf(stderr, "count plugin: cannot use '%s'\n", argv[i]);
            return -1;
        }
    }
    if (out == NULL) {
        fprintf(stderr, "count plugin: no out=FILE\n");
        return -1;
    }
    /* Each line reaches the file even when the guest ends QEMU at once. */
    setvbuf(out, NULL, _IOLBF, 0);
    qemu_plugin_register_vcpu_tb_trans_cb(id, instrument);
    qemu_plugin_register_atexit_cb(id, ended, NULL);
    return 0;
}
