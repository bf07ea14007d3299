#include "frame_name.h"

#include <stdio.h>
#include <string.h>

#include "report.h"

bool el_frame_name_is_pattern(const char *text)
{
    return strchr(text, '%') != NULL;
}

/* The pattern is the user's, so printf never sees it. */
bool el_frame_name(const char *pattern, uint32_t frame, char *name)
{
    const char *const percent = strchr(pattern, '%');
    const char *after = percent + 1;
    int digits = 1;
    if (after[0] == '0' && after[1] >= '1' && after[1] <= '9') {
        digits = after[1] - '0';
        after += 2;
    }
    if (*after != 'd' || strchr(after, '%') != NULL) {
        el_report("'%s': the frame's number is one %%d or %%04d", pattern);
        return false;
    }
    const int length =
        snprintf(name, EL_FRAME_NAME_MAX, "%.*s%0*u%s", (int)(percent - pattern), pattern, digits, frame, after + 1);
    if (length < 0 || length >= EL_FRAME_NAME_MAX) {
        el_report("'%s' is too long for a file's name", pattern);
        return false;
    }
    return true;
}
