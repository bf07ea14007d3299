#include "files.h"

#include <errno.h>
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
    const int descriptor = mkstemp(output->temporary);
    if (descriptor >= 0) {
        give_usual_mode(descriptor);
        output->stream = fdopen(descriptor, "wb");
    }
    if (output->stream == NULL) {
        el_report("cannot write %s: %s", path, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
            unlink(output->temporary);
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
    const bool moved = !failed && closed && rename(output->temporary, output->path) == 0;
    if (!moved) {
        el_report("cannot write %s: %s", output->path, strerror(errno));
        unlink(output->temporary);
    }
    free(output->temporary);
    output->temporary = NULL;
    return moved;
}

void el_output_discard(el_output *output)
{
    if (output->stream == NULL) {
        return;
    }
    fclose(output->stream);
    output->stream = NULL;
    unlink(output->temporary);
    free(output->temporary);
    output->temporary = NULL;
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
