#include "png_file.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"

bool el_png_write(el_output *output, const uint16_t *rgb565, uint16_t width, uint16_t height)
{
    uint8_t *const rgb = malloc((size_t)width * height * 3);
    if (rgb == NULL) {
        el_report("cannot write %s: no memory", output->path);
        return false;
    }
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const unsigned red = rgb565[i] >> 11;
        const unsigned green = (rgb565[i] >> 5) & 63U;
        const unsigned blue = rgb565[i] & 31U;
        rgb[3 * i] = (uint8_t)(red << 3 | red >> 2);
        rgb[3 * i + 1] = (uint8_t)(green << 2 | green >> 4);
        rgb[3 * i + 2] = (uint8_t)(blue << 3 | blue >> 2);
    }
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGB};
    errno = 0; /* libpng has no word of its own for what the file refuses */
    const bool written = png_image_write_to_stdio(&image, output->stream, 0, rgb, 0, NULL) != 0;
    if (!written) {
        el_report("cannot write %s: %s", output->path, errno != 0 ? strerror(errno) : image.message);
    }
    png_image_free(&image);
    free(rgb);
    return written;
}
