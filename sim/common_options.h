/* The options that render and stream share: what is drawn, and on which machine. */
#ifndef EL_SIM_COMMON_OPTIONS_H
#define EL_SIM_COMMON_OPTIONS_H

#include <getopt.h>
#include <stdbool.h>

#include "machine.h"
#include "subject.h"

/* Values of the options below; a command's own begin at EL_OPTION_OWN. */
enum {
    EL_OPTION_SCENE = 1,
    EL_OPTION_SIZE,
    EL_OPTION_BAND,
    EL_OPTION_ARENA,
    EL_OPTION_FRAMES,
    EL_OPTION_UV_ERROR,
    EL_OPTION_PANEL,
    EL_OPTION_ROTATION,
    EL_OPTION_THREADS,
    EL_OPTION_SAMPLES,
    EL_OPTION_STRIPES,
    EL_OPTION_OWN
};

/* Entries for a command's table of long options. */
#define EL_COMMON_OPTIONS                                                                                              \
    {"scene", required_argument, NULL, EL_OPTION_SCENE}, {"size", required_argument, NULL, EL_OPTION_SIZE},            \
        {"band", required_argument, NULL, EL_OPTION_BAND}, {"arena", required_argument, NULL, EL_OPTION_ARENA},        \
        {"frames", required_argument, NULL, EL_OPTION_FRAMES}, {"panel", required_argument, NULL, EL_OPTION_PANEL},    \
        {"rotation", required_argument, NULL, EL_OPTION_ROTATION},                                                     \
        {"threads", required_argument, NULL, EL_OPTION_THREADS},                                                       \
        {"samples", required_argument, NULL, EL_OPTION_SAMPLES},                                                       \
        {"stripes", required_argument, NULL, EL_OPTION_STRIPES},                                                       \
    {                                                                                                                  \
        "uv-error", required_argument, NULL, EL_OPTION_UV_ERROR                                                        \
    }

typedef struct el_common_options {
    el_subject_options subject;
    el_machine_config machine;
    long frames;
    const char *band;     /* as given; NULL: not */
    const char *size;     /* the same */
    const char *rotation; /* the same */
} el_common_options;

/* 320x240 or all of the panel, bands of 8 lines, `frames` frames. */
el_common_options el_common_options_default(long frames);

/* Takes the option `which`, below EL_OPTION_OWN. False after one line on stderr. */
bool el_common_options_take(el_common_options *options, int which, const char *text);

/* Checks what only fits or fails together; call it after the last option. False after one line on stderr. */
bool el_common_options_check(el_common_options *options);
/* Width of the picture over its height. */
double el_common_options_aspect(const el_common_options *options);

#endif
