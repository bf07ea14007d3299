#include "files.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/crc32.h"
#include "report.h"

uint8_t *el_file_read(const char *path, size_t *size)
{
    FILE *const stream = fopen(path, "rb");
    if (stream == NULL) {
        el_report("cannot read %s: %s", path, strerror(errno));
        return NULL;
    }
    uint8_t *bytes = NULL;
    size_t used = 0;
    size_t room = 0;
    for (;;) {
        if (used == room) {
            room = room == 0 ? 65536 : room * 2;
            uint8_t *const larger = realloc(bytes, room);
            if (larger == NULL) {
                el_report("cannot read %s: it does not fit the memory", path);
                break;
            }
            bytes = larger;
        }
        const size_t got = fread(bytes + used, 1, room - used, stream);
        used += got;
        if (got == 0) {
            if (ferror(stream) != 0) {
                el_report("cannot read %s: %s", path, strerror(errno));
                break;
            }
            fclose(stream);
            *size = used;
            return bytes;
        }
    }
    fclose(stream);
    free(bytes);
    return NULL;
}

/* New files get the mode that open() would give them; mkstemp's is 0600. */
static void give_usual_mode(int descriptor)
{
    const mode_t mask = umask(0);
    umask(mask);
    (void)fchmod(descriptor, 0666 & ~mask);
}

enum { MOST_UNDER_WAY = 8 };

/* What a signal that ends the program has to remove. Only the main thread takes signals (threads.c), and blocks them while
 * it changes this. */
static char *volatile under_way[MOST_UNDER_WAY];

static const int ending[] = {SIGHUP, SIGINT, SIGPIPE, SIGTERM};

/* The handler is there for one signal: the one that it raises, which is blocked until it returns, ends the program. */
static void remove_and_end(int signal_number)
{
    for (unsigned i = 0; i < MOST_UNDER_WAY; i++) {
        if (under_way[i] != NULL) {
            (void)unlink(under_way[i]);
        }
    }
    (void)raise(signal_number);
}

/* Blocks the signals that end a program, and has those be taken that nobody else takes or ignores. */
static void hold_signals(sigset_t *before)
{
    struct sigaction action = {.sa_handler = remove_and_end, .sa_flags = (int)SA_RESETHAND};
    (void)sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof ending / sizeof ending[0]; i++) {
        (void)sigaddset(&action.sa_mask, ending[i]);
    }
    (void)sigprocmask(SIG_BLOCK, &action.sa_mask, before);
    for (size_t i = 0; i < sizeof ending / sizeof ending[0]; i++) {
        struct sigaction old;
        if (sigaction(ending[i], NULL, &old) == 0 && old.sa_handler == SIG_DFL) {
            (void)sigaction(ending[i], &action, NULL);
        }
    }
}

/* Puts `to` where `from` is; more files than there is room for are only not removed by a signal. */
static void replace_under_way(const char *from, char *to)
{
    for (unsigned i = 0; i < MOST_UNDER_WAY; i++) {
        if (under_way[i] == from) {
            under_way[i] = to;
            return;
        }
    }
}

static int make_temporary(char *name)
{
    sigset_t before;
    hold_signals(&before);
    const int descriptor = mkstemp(name);
    const int problem = errno;
    if (descriptor >= 0) {
        replace_under_way(NULL, name);
    }
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    errno = problem;
    return descriptor;
}

/* Moves the file to its place, or removes it where `path` is NULL, and frees its name. */
static bool end_temporary(el_output *output, const char *path)
{
    sigset_t before;
    hold_signals(&before);
    const bool moved = path != NULL && rename(output->temporary, path) == 0;
    const int problem = errno;
    if (!moved) {
        (void)unlink(output->temporary);
    }
    replace_under_way(output->temporary, NULL);
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    free(output->temporary);
    output->temporary = NULL;
    errno = problem;
    return moved;
}

bool el_output_open(el_output *output, const char *path)
{
    static const char suffix[] = ".XXXXXX";
    *output = (el_output){.path = path};
    const size_t length = strlen(path);
    output->temporary = malloc(length + sizeof suffix);
    if (output->temporary == NULL) {
        el_report("cannot write %s: no memory", path);
        return false;
    }
    memcpy(output->temporary, path, length);
    memcpy(output->temporary + length, suffix, sizeof suffix);
    const int descriptor = make_temporary(output->temporary);
    if (descriptor >= 0) {
        give_usual_mode(descriptor);
        output->stream = fdopen(descriptor, "wb");
    }
    if (output->stream == NULL) {
        el_report("cannot write %s: %s", path, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
            (void)end_temporary(output, NULL);
        }
        free(output->temporary);
        output->temporary = NULL;
        return false;
    }
    return true;
}

void el_output_pixels(el_output *output, const uint16_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t bytes[2] = {(uint8_t)values[i], (uint8_t)(values[i] >> 8)};
        fwrite(bytes, 1, sizeof bytes, output->stream);
    }
}

bool el_output_commit(el_output *output)
{
    const bool failed = ferror(output->stream) != 0;
    const bool closed = fclose(output->stream) == 0;
    output->stream = NULL;
    const bool moved = end_temporary(output, failed || !closed ? NULL : output->path);
    if (!moved) {
        el_report("cannot write %s: %s", output->path, strerror(errno));
    }
    return moved;
}

void el_output_discard(el_output *output)
{
    if (output->stream == NULL) {
        return;
    }
    fclose(output->stream);
    output->stream = NULL;
    (void)end_temporary(output, NULL);
}

uint32_t el_pixels_crc(const uint16_t *values, size_t count)
{
    uint32_t crc = 0;
    for (size_t i = 0; i < count; i++) {
        const uint8_t bytes[2] = {(uint8_t)values[i], (uint8_t)(values[i] >> 8)};
        crc = el_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}
