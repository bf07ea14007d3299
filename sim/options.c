#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/limits.h"
#include "report.h"

bool el_option_integer(const char *option, const char *text, long least, long most, long *value)
{
    char *end;
    errno = 0;
    const long parsed = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || parsed < least || parsed > most) {
        el_report("%s takes a whole number from %ld to %ld, not '%s'", option, least, most, text);
        return false;
    }
    *value = parsed;
    return true;
}

bool el_option_number(const char *option, const char *text, double least, double most, double *value)
{
    char *end;
    const double parsed = strtod(text, &end);
    /* Written so that NaN fails too. */
    if (end == text || *end != '\0' || !(parsed >= least && parsed <= most)) {
        el_report("%s takes a number from %g to %g, not '%s'", option, least, most, text);
        return false;
    }
    *value = parsed;
    return true;
}

bool el_option_vector(const char *option, const char *text, double limit, double vector[3])
{
    const char *at = text;
    for (int i = 0; i < 3; i++) {
        char *end;
        vector[i] = strtod(at, &end);
        const char expected = i < 2 ? ',' : '\0';
        if (end == at || *end != expected || !(fabs(vector[i]) <= limit)) {
            el_report("%s takes three numbers X,Y,Z within +-%g, not '%s'", option, limit, text);
            return false;
        }
        at = end + 1;
    }
    return true;
}

bool el_option_size(const char *option, const char *text, uint16_t *width, uint16_t *height)
{
    char *end;
    const long w = strtol(text, &end, 10);
    const char *const second = end + 1;
    /* strtol skips blanks, so each number has to begin with a digit. */
    const bool has_both = *text >= '0' && *text <= '9' && *end == 'x' && *second >= '0' && *second <= '9';
    const long h = has_both ? strtol(second, &end, 10) : 0;
    if (!has_both || *end != '\0' || w < 1 || w > EL_MAX_WIDTH || h < 1 || h > EL_MAX_HEIGHT) {
        el_report("%s takes WIDTHxHEIGHT, each 1 to %d pixels, not '%s'", option, (int)EL_MAX_WIDTH, text);
        return false;
    }
    *width = (uint16_t)w;
    *height = (uint16_t)h;
    return true;
}

bool el_option_band(const char *text, uint16_t height, uint16_t *lines)
{
    long value = height < 8 ? height : 8;
    if (text != NULL && !el_option_integer("--band", text, 1, height, &value)) {
        return false;
    }
    *lines = (uint16_t)value;
    return true;
}

bool el_option_rotation(const char *option, const char *text, el_rotation *rotation)
{
    static const struct {
        const char *text;
        el_rotation rotation;
    } angles[] = {{"0", EL_ROTATION_0}, {"90", EL_ROTATION_90}, {"180", EL_ROTATION_180}, {"270", EL_ROTATION_270}};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        if (strcmp(text, angles[i].text) == 0) {
            *rotation = angles[i].rotation;
            return true;
        }
    }
    el_report("%s takes 0, 90, 180 or 270 degrees, not '%s'", option, text);
    return false;
}
