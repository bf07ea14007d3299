/* How the simulator says that something is wrong: one line on stderr. */
#ifndef EL_SIM_REPORT_H
#define EL_SIM_REPORT_H

/* Exit statuses of the simulator. */
enum { EL_EXIT_OK = 0, EL_EXIT_BAD = 2 };

/* Prints "edgeline-sim: " and the message as one line on stderr. Returns EL_EXIT_BAD, so that a command can end with
 * `return el_report(...)`. */
int el_report(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
