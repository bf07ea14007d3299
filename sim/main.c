/* edgeline-sim: the renderer on a PC. */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "report.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *arguments;
} commands[] = {
    {"list", el_command_list, ""},
    {"render", el_command_render,
     "[--scene NAME | --mesh FILE.elm] [--size WxH] [--band N] [--arena BYTES]\n"
     "               [--uv-error 2|4|8|16|32] [--frames N] [--png FILE] [--raw FILE] [--depth FILE]\n"
     "               [--crc] [--stats]\n"
     "               with --mesh: [--eye X,Y,Z] [--look-at X,Y,Z] [--fov DEGREES] [--near N] [--far F]\n"
     "               [--shading flat|gouraud|textured]"},
    {"stream", el_command_stream,
     "[--scene NAME] [--size WxH] [--band N] [--arena BYTES] [--uv-error N]\n"
     "               (--pty | --tcp PORT | --stdout) [--frames N] [--baud RATE]"},
    {"memory", el_command_memory, "[--size WxH] [--band N] [--vertices N] [--triangles N] [--draws N]"},
    {"coverage", el_command_coverage, "IN OUT"},
    {"attributes", el_command_attributes, "IN OUT"},
    {"methods", el_command_methods, "[--seed N] [--count N] [--json FILE] [--csv FILE] [--png FILE]"},
};

enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void usage(FILE *stream)
{
    fputs("usage: edgeline-sim COMMAND ...\n\n", stream);
    for (int i = 0; i < COMMANDS; i++) {
        fprintf(stream, "  %-10s %s\n", commands[i].name, commands[i].arguments);
    }
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        return el_report("no command; `edgeline-sim --help` lists them");
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        usage(stdout);
        return EL_EXIT_OK;
    }
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return commands[i].run(argc - 2, argv + 2);
        }
    }
    return el_report("unknown command '%s'; `edgeline-sim --help` lists them", argv[1]);
}
