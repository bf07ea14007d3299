/* edgeline-sim: the renderer on a PC. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "lcd/lcd.h"
#include "report.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *arguments;
} commands[] = {
    {"list", el_command_list, "[views | pages]"},
    {"render", el_command_render,
     "[--scene NAME | --mesh FILE.elm [--mesh FILE.elm ...]] [--size WxH] [--band N] [--arena BYTES]\n"
     "               [--panel NAME [--rotation 0|90|180|270]] [--uv-error 2|4|8|16|32] [--frames N] [--threads N]\n"
     "               [--samples 1|4|8] [--stripes none|rgb|bgr]\n"
     "               [--png FILE] [--raw FILE] [--depth FILE] [--wire FILE] [--crc] [--stats] [--depth-prepass]\n"
     "               a FILE of --png with %d or %04d in its name: one for each frame\n"
     "               with --mesh: [--eye X,Y,Z] [--look-at X,Y,Z] [--fov DEGREES] [--near N] [--far F]\n"
     "               [--shading flat|gouraud|textured|lit]: lit has textures in a light, too\n"
     "               a debug view: [--view NAME], as `list views` names them\n"
     "               with a scene: [--yaw N] [--pitch N] [--zoom N] [--pan-x N] [--pan-y N], as INPUT in WIRE.md has\n"
     "               them, and [--shading flat|gouraud|textured]: without textures and vertex colours, or one of them"},
    {"stream", el_command_stream,
     "[--scene NAME] [--size WxH] [--band N] [--arena BYTES] [--uv-error N] [--threads N]\n"
     "               [--samples 1|4|8] [--panel NAME [--rotation DEGREES]]\n"
     "               (--pty | --tcp PORT | --stdout) [--frames N] [--baud RATE [--max-baud RATE]]\n"
     "               --pty, --tcp: prints the port's name, waits for a host, takes its INPUT; hosts may come and go\n"
     "               --stdout: sends all frames to whoever reads, in codecs 0 and 1\n"
     "               --baud: as a UART of this rate, RATE / 10 bytes a second, until the host asks for another one; "
     "without,\n"
     "               as fast as the link goes. --max-baud: the highest that it may ask for, 3000000 unless it is said"},
    {"paint", el_command_paint,
     "[--page NAME] [--band N] [--frames N] [--png FILE] [--raw FILE] [--crc]\n"
     "               a page in two dimensions, as `list pages` names them, some over a scene"},
    {"look", el_command_look, "--panel NAME [--rotation DEGREES] TRACE [--png FILE] [--raw FILE]"},
    {"memory", el_command_memory,
     "[--panel NAME] [--size WxH] [--band N] [--vertices N] [--triangles N] [--draws N]\n"
     "               [--shading flat|gouraud|textured] [--stream]"},
    {"budget", el_command_budget, "as memory; the same as JSON, and the wire's bytes"},
    {"coverage", el_command_coverage, "IN OUT"},
    {"attributes", el_command_attributes, "IN OUT"},
    {"methods", el_command_methods, "[--seed N] [--count N] [--json FILE] [--csv FILE] [--png FILE]"},
};

enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void print_usage(void)
{
    puts("usage: edgeline-sim COMMAND ...\n"
         "       edgeline-sim COMMAND --help\n"
         "       edgeline-sim --version\n");
    for (int i = 0; i < COMMANDS; i++) {
        printf("  %-10s %s\n", commands[i].name, commands[i].arguments);
    }
    fputs("\npanels:", stdout);
    const el_lcd_profile *panel;
    for (size_t i = 0; (panel = el_lcd_profile_at(i)) != NULL; i++) {
        printf(" %s", panel->panel);
    }
    putchar('\n');
}

static bool asks_for_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

static int run(int index, int argc, char **argv)
{
    for (int i = 0; i < argc; i++) {
        if (asks_for_help(argv[i])) {
            printf("usage: edgeline-sim %s %s\n", commands[index].name, commands[index].arguments);
            return EL_EXIT_OK;
        }
    }
    return commands[index].run(argc, argv);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        return el_report("no command; `edgeline-sim --help` lists them");
    }
    if (asks_for_help(argv[1])) {
        print_usage();
        return EL_EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("edgeline-sim " EDGELINE_VERSION);
        return EL_EXIT_OK;
    }
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return run(i, argc - 2, argv + 2);
        }
    }
    return el_report("unknown command '%s'; `edgeline-sim --help` lists them", argv[1]);
}
