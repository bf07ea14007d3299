#include "report.h"

#include <stdarg.h>
#include <stdio.h>

int el_report(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("edgeline-sim: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return EL_EXIT_BAD;
}
