/* A program that is written for a computer, its `main` called as it expects: with a standard output, newlib's by
 * semihosting, and its return value as the exit status. The linker's --wrap puts this between start.c and it. */
#include <stdio.h>

#include "semihost.h"

void initialise_monitor_handles(void); /* newlib's: opens the standard streams */
int __real_main(void);                 /* the program's */
int __wrap_main(void);

int __wrap_main(void)
{
    initialise_monitor_handles();
    const int status = __real_main();
    (void)fflush(stdout);
    semihost_exit(status);
}
